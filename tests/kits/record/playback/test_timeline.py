"""The time of a player."""

from yarpy.kits.record.playback.timeline import SECOND, Timeline


def test_it_runs_at_its_rate() -> None:
    line = Timeline(100 * SECOND, rate=2.0)
    assert not line.running and line.moment(5.0) == 100 * SECOND
    line.start(10.0)
    line.start(11.0)  # it runs already
    assert line.running and line.moment(13.0) == 106 * SECOND
    assert line.due(106 * SECOND) == 13.0


def test_a_pause_leaves_nothing_out() -> None:
    """Not at other rates either."""
    for rate in (0.5, 1.0, 2.0):
        line = Timeline(0, rate)
        line.start(0.0)
        line.stop(4.0)
        assert line.moment(100.0) == round(4 * rate * SECOND)
        line.start(100.0)
        assert line.moment(101.0) == round(5 * rate * SECOND)
        assert line.due(round(6 * rate * SECOND)) == 102.0


def test_another_rate_and_another_place() -> None:
    line = Timeline(0)
    line.start(0.0)
    line.pace(4.0, 2.0)
    assert line.moment(3.0) == 6 * SECOND and line.rate == 4.0
    line.jump(100 * SECOND, 3.0)
    assert line.moment(3.5) == 102 * SECOND
    line.stop(3.5)
    line.jump(0, 50.0)
    assert line.moment(60.0) == 0 and not line.running


def test_nothing_adds_up() -> None:
    line = Timeline(1_795_000_000 * SECOND)
    line.start(0.0)
    for n in range(1, 1001):
        line.stop(n * 0.25)
        line.start(n * 0.25)
    assert line.moment(250.0) == 1_795_000_250 * SECOND
