"""Taking the lines of all programs: whenever they come, each once, and what is lost is counted."""

import threading
from collections.abc import Iterator

import pytest
from support.cut import cut_at
from support.wait import HANG, wait_until

import yarpy
from yarpy.kits.launch.log import collector as module
from yarpy.kits.launch.log.collector import LogCollector
from yarpy.nameserver.local import LocalNames

ONE = "/log/vm/one/1"


def line(text: str, time: float = 1795219554.5, port: str = ONE) -> yarpy.Bottle:
    told = yarpy.Bottle([["level", "INFO"], ["systemtime", time], ["message", text]])
    return yarpy.Bottle([f"[{port}]", told.to_text()])


@pytest.fixture
def names(monkeypatch: pytest.MonkeyPatch) -> LocalNames:
    monkeypatch.setattr(module, "PERIOD", 0.01)
    return LocalNames()


@pytest.fixture
def collector(names: LocalNames) -> Iterator[LogCollector]:
    found = open_collector(names)
    yield found
    found.close()


def open_collector(names: LocalNames) -> LogCollector:
    return LogCollector(lambda hear: yarpy.Port("/logger", callback=hear, names=names), names=names)


def texts(collector: LogCollector, count: int) -> list[str]:
    found: list[str] = []
    while len(found) < count:
        pairs = collector.read(HANG)
        assert pairs, found
        found += [one.text for one, _ in pairs]
    return found


def test_programs_that_were_there_and_that_come(names: LocalNames) -> None:
    with (
        yarpy.Port(ONE, names=names) as one,
        yarpy.Port("/not/logging", names=names) as other,
    ):
        collector = open_collector(names)
        assert one.wait_for_outputs(timeout=HANG)
        one.write(line("here"))
        assert texts(collector, 1) == ["here"]
        with yarpy.Port("/yarprunlog/two", names=names) as two:
            assert two.wait_for_outputs(timeout=HANG)
            two.write(["[/yarprunlog/two]", "plain"])
            assert texts(collector, 1) == ["plain"]
        assert not other.outputs
        collector.close()
        assert collector.read() == []


def test_what_comes_again_is_known_and_what_is_late_is_not(
    names: LocalNames, collector: LogCollector
) -> None:
    with yarpy.Port(ONE, names=names) as one:
        assert one.wait_for_outputs(timeout=HANG)
        one.write(line("b", 2.0))
        one.write(line("a", 1.0))  # of another thread of the program, a little later
        one.write(line("b", 2.0))
        one.write(line("a", 1.0))
        one.write([1, 2])
        one.write(["x", 3])
        one.write(line("c", 3.0))
        assert texts(collector, 3) == ["b", "a", "c"]


def test_what_nobody_reads_is_counted(
    names: LocalNames, collector: LogCollector, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "LOG_WAITING", 10)
    with yarpy.Port(ONE, names=names) as one:
        assert one.wait_for_outputs(timeout=HANG)
        for number in range(25):
            one.write(line(str(number), float(number + 1)))
        wait_until(lambda: collector.taken == 25)
    assert collector.lost == 15
    assert texts(collector, 10) == [str(number) for number in range(15, 25)]
    assert collector.read(0.0) == []


def test_bytes_are_limited_as_well(
    names: LocalNames, collector: LogCollector, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "LOG_WAITING_BYTES", 1000)
    with yarpy.Port(ONE, names=names) as one:
        assert one.wait_for_outputs(timeout=HANG)
        for number in range(10):
            one.write(line("x" * 300, float(number + 1)))
        wait_until(lambda: collector.taken == 10)
    assert collector.lost == 8 and len(texts(collector, 2)) == 2


def test_strangers_that_make_up_names(
    names: LocalNames, collector: LogCollector, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "LOG_ORIGINS", 5)
    with yarpy.Port(ONE, names=names) as one:
        assert one.wait_for_outputs(timeout=HANG)
        for number in range(20):
            one.write(line("x", port=f"/log/vm/x/{number}"))
        assert len(texts(collector, 20)) == 20
    assert len(collector._origins) == 5


def test_who_waits_hears_of_the_end(collector: LogCollector) -> None:
    done: list[object] = []
    thread = threading.Thread(target=lambda: done.append(collector.read()))
    thread.start()
    collector.close()
    thread.join(HANG)
    assert done == [[]]


def test_a_signal_while_it_waits_does_no_harm(names: LocalNames) -> None:
    """The lock of an Event stayed locked for ever, or was released twice."""
    collector = open_collector(names)
    number, there = 0, True
    while there:
        number += 1
        files = ("log/collector.py", "threading.py", "yarpy/scope.py")
        there = cut_at(number, lambda: collector.wait(0.01), *files)
    assert number > 3
    with yarpy.Port(ONE, names=names) as one:
        assert one.wait_for_outputs(timeout=HANG)
        one.write(line("here"))
        assert texts(collector, 1) == ["here"]
    collector.close()
