"""The time line: bins, silences, where the last message is."""

from yarpy.kits.record.view.overview import BINS, SECOND, SILENCES, Overview


def test_bins_and_silences() -> None:
    overview = Overview(0, 60 * SECOND)
    for n in range(600):
        if not 200 <= n < 300:
            overview.add("/a", n * SECOND // 10)
    told = overview.told("/a")
    assert sum(told["bins"]) == 500 and len(told["bins"]) == BINS
    assert told["bins"][200:300] == [0] * 100 and told["gaps"] == [[19.9, 30.0]]
    assert overview.told("/b")["gaps"] == [] and not any(overview.told("/b")["bins"])
    assert overview.filled("/a", 25 * SECOND) == [199, 198]
    assert overview.filled("/a", -5) == [0] and overview.filled("/b", SECOND) == []
    assert overview.start(199) < 199 * SECOND // 10


def test_the_longest_silences_are_kept() -> None:
    overview = Overview(0, 10**6 * SECOND)
    time = 0
    for n in range(3 * SILENCES):
        for _ in range(100):  # 1 ms apart
            time += SECOND // 1000
            overview.add("/a", time)
        time += (n % SILENCES + 2) * 100 * SECOND
    assert len(overview.rows["/a"].silences) == SILENCES
    assert len(overview.told("/a")["gaps"]) == SILENCES


def test_a_single_moment() -> None:
    overview = Overview(5, 5)
    overview.add("/a", 5)
    assert overview.told("/a")["bins"][0] == 1
