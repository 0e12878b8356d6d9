"""`yarpy filter`: some of the ports are left."""

from support.recordings import recorded

from yarpy import record


def values(path) -> list:
    with record.open(path) as found:
        return [one.value for one in found]


def test_some_of_the_ports(here, tmp_path) -> None:
    path = str(recorded(tmp_path / "x.mcap"))
    rows = [
        (["--ports", "/a"], [0, 2, 4, 6, 8]),
        (["-e", "b$"], [1, 3, 5, 7, 9]),
        (["--exclude", "a"], [1, 3, 5, 7, 9]),
        (["--kind", "bottle"], [*range(10)]),
        (["--ports", "/a", "--max-rate", "*=25"], [0, 4, 8]),
    ]
    for number, (words, left) in enumerate(rows):
        out = tmp_path / f"out{number}"
        assert here("filter", path, "-o", str(out), *words).code == 0
        assert values(f"{out}.mcap") == [[n] for n in left]
    said = here("filter", path, "-o", str(tmp_path / "none"), "--kind", "image")
    assert said.code == 1 and "no port is left of /a /b" in said.err
    assert here("filter", path, "-o", str(tmp_path / "none"), "--ports", "/c").code == 1
