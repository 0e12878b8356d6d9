"""One program: its states, restarts, and its end; with a runner that starts nothing."""

import signal
import threading
from collections.abc import Callable
from itertools import pairwise

import pytest
from support.wait import HANG, wait_until

from yarpy.errors import LinkClosed, Timeout
from yarpy.kits.launch.application.application import Module
from yarpy.kits.launch.supervise import unit as unit_file
from yarpy.kits.launch.supervise.runner import Program
from yarpy.kits.launch.supervise.unit import Unit, ending


class Handle:
    """A program that ends when it is told to."""

    def __init__(self, end: Callable[[int], None], deaf: bool = False) -> None:
        self.pid, self.state = 7, "running"
        self.returncode: int | None = None
        self.signals: list[int] = []
        self._end, self._deaf = end, deaf

    def finish(self, code: int) -> None:
        self.state, self.returncode = "ended", code
        self._end(code)

    def terminate(self, number: int = signal.SIGTERM) -> None:
        self.signals.append(number)
        if self.returncode is None and not self._deaf:
            self.finish(-number)

    def wait(self, timeout: float | None = None) -> int | None:
        return self.returncode


class Fake:
    """A runner; programs end at once with the codes that it is given, the others run on."""

    def __init__(self, *codes: int) -> None:
        self.codes = [*codes]
        self.handles: list[Handle] = []
        self.programs: list[Program] = []

    def start(
        self, program: Program, on_line: Callable[[str], None], on_end: Callable[[int], None]
    ) -> Handle:
        self.programs.append(program)
        if program.command[0] == "/missing":
            raise FileNotFoundError(2, "No such file or directory", "/missing")
        handle = Handle(on_end)
        self.handles.append(handle)
        on_line(f"start {len(self.handles)}")
        if self.codes:
            handle.finish(self.codes.pop(0))
        return handle


class Ready:
    def wait(self, unit: Unit, stop: threading.Event) -> str:
        return ""


class Never:
    """Waits until it is stopped, or says why it gives up."""

    def __init__(self, why: str = "") -> None:
        self.why = why

    def wait(self, unit: Unit, stop: threading.Event) -> str:
        if not self.why:
            unit.detail = "for /x"
            assert stop.wait(HANG)
        return self.why


@pytest.fixture(autouse=True)
def _quick(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(unit_file, "FIRST_PAUSE", 0.001)
    monkeypatch.setattr(unit_file, "LONGEST_PAUSE", 0.004)


def started(runner: Fake, waiter: Ready | Never | None = None, **more: str) -> tuple[Unit, list]:
    states: list[str] = []
    found = Unit(
        Module("a", more.pop("name", "a"), **more),
        runner,
        waiter or Ready(),
        changed=lambda one: states.append(one.state),
    )
    found.start()
    return found, states


@pytest.mark.parametrize(
    ("restart", "codes", "states", "detail"),
    [
        ("no", [0], ["waiting", "running", "ended"], "ended with 0"),
        ("no", [3], ["waiting", "running", "failed"], "ended with 3"),
        ("on-failure", [0], ["waiting", "running", "ended"], "ended with 0"),
        (
            "on-failure",
            [1, -9, 0],
            [*["waiting", "running", "pausing"] * 2, "waiting", "running", "ended"],
            "ended with 0",
        ),
        (
            "always",
            [0] * unit_file.TRIES,
            [*["waiting", "running", "pausing"] * 9, "waiting", "running", "failed"],
            "given up after 10 starts: ended with 0",
        ),
    ],
)
def test_policies(restart: str, codes: list[int], states: list[str], detail: str) -> None:
    unit, found = started(Fake(*codes), restart=restart)
    assert unit.join(HANG)
    assert (found, unit.detail) == (states, detail)
    assert unit.restarts == states.count("running") - 1


def test_one_that_cannot_be_started_is_not_tried_again() -> None:
    runner = Fake()
    unit, states = started(runner, name="/missing")
    assert unit.join(HANG) and states == ["waiting", "failed"]
    assert unit.detail.startswith("it cannot be started: ") and len(runner.programs) == 1
    assert "Errno" not in unit.detail


class Silent(Fake):
    """A server that does not answer the first times that it is to start something."""

    def __init__(self, times: int, *codes: int) -> None:
        super().__init__(*codes)
        self.times = times

    def start(self, program, on_line, on_end):
        self.times -= 1
        if self.times >= 0:
            raise (Timeout, LinkClosed)[self.times % 2]("/node does not answer")
        return super().start(program, on_line, on_end)


@pytest.mark.parametrize(
    ("restart", "times", "states", "detail"),
    [
        ("no", 1, ["waiting", "failed"], "it cannot be started: /node does not answer"),
        (
            "on-failure",
            2,
            [*["waiting", "pausing"] * 2, "waiting", "running", "ended"],
            "ended with 0",
        ),
        (
            "always",
            unit_file.TRIES,
            [*["waiting", "pausing"] * 9, "waiting", "failed"],
            "given up after 10 starts: it cannot be started: /node does not answer",
        ),
    ],
)
def test_a_silent_server_is_asked_again_as_the_policy_says(
    restart: str, times: int, states: list[str], detail: str
) -> None:
    unit, found = started(Silent(times, 0), restart=restart)
    assert unit.join(HANG)
    assert (found, unit.detail) == (states, detail)


def test_stopping_what_asks_a_silent_server() -> None:
    class Stopped(Silent):
        def start(self, program, on_line, on_end):
            unit.stop()
            return super().start(program, on_line, on_end)

    unit = Unit(Module("a", "a"), Stopped(100), Ready())
    unit.start()
    assert unit.join(HANG) and unit.state == "stopped"


def test_stopping() -> None:
    runner = Fake()
    unit, states = started(runner)
    wait_until(lambda: unit.running)
    unit.stop()
    assert unit.join(HANG)
    assert states == ["waiting", "running", "stopping", "stopped"]
    assert runner.handles[0].signals == [signal.SIGTERM] and unit.restarts == 0


def test_stopping_what_is_just_being_started() -> None:
    class Stopped(Fake):
        def start(self, program, on_line, on_end):
            unit.stop()
            return super().start(program, on_line, on_end)

    states: list[str] = []
    runner = Stopped()
    unit = Unit(Module("a", "a"), runner, Ready(), changed=lambda one: states.append(one.state))
    unit.start()
    assert unit.join(HANG)
    assert states == ["waiting", "running", "stopping", "stopped"]
    assert runner.handles[0].signals == [signal.SIGTERM]


@pytest.mark.parametrize("waiter", [Never(), Ready()])
def test_stopping_what_waits_or_pauses(waiter, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(unit_file, "FIRST_PAUSE", 600.0)
    unit, _ = started(Fake(1), waiter)
    wait_until(lambda: unit.detail)
    unit.stop()
    assert unit.join(HANG) and unit.state == "stopped"


def test_what_is_missing_is_told() -> None:
    unit, states = started(Fake(), Never("no /x"))
    assert unit.join(HANG)
    assert states == ["waiting", "failed"] and unit.detail == "no /x"


def test_restarting_while_it_runs_waits_or_is_over() -> None:
    runner = Fake()
    unit, _ = started(runner, restart="no")
    for count in (1, 2, 3):
        wait_until(lambda count=count: len(runner.handles) == count and unit.state == "running")
        unit.restart()
    wait_until(lambda: len(runner.handles) == 4 and unit.state == "running")
    runner.handles[-1].finish(0)
    wait_until(lambda: unit.state == "ended")
    unit.restart()
    wait_until(lambda: len(runner.handles) == 5 and unit.state == "running")
    unit.stop()
    assert unit.join(HANG) and len(runner.handles) == 5


def test_one_that_is_wanted_again_while_it_rests_starts_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    resting, rested = threading.Event(), threading.Event()

    def rest(unit: Unit) -> None:
        resting.set()
        assert rested.wait(HANG)

    monkeypatch.setattr(Unit, "_rest", rest)
    runner = Fake()
    unit, _ = started(runner)
    wait_until(lambda: unit.running)
    unit.stop()
    assert resting.wait(HANG) and not unit.over
    unit.restart()
    rested.set()
    wait_until(lambda: len(runner.handles) == 2 and unit.state == "running")
    unit.stop()
    assert unit.join(HANG) and unit.over


def test_one_that_is_wanted_again_in_its_last_moment_starts_again() -> None:
    runner = Fake()
    wanted = threading.Event()

    def changed(unit: Unit) -> None:
        if unit.state == "stopped" and not wanted.is_set():
            wanted.set()
            again = threading.Thread(target=unit.restart)
            again.start()
            again.join(HANG)
            assert not unit.over

    unit = Unit(Module("a", "a"), runner, Ready(), changed=changed)
    unit.start()
    wait_until(lambda: unit.state == "running")
    unit.stop()
    wait_until(lambda: len(runner.handles) == 2 and unit.state == "running")
    unit.stop()
    assert unit.join(HANG)


def test_lines_are_numbered_and_the_oldest_are_forgotten() -> None:
    unit, _ = started(Fake(*[1] * 4, 0))
    assert unit.join(HANG)
    assert [line for _, line in unit.lines] == [f"start {n}" for n in range(1, 6)]
    assert all(a < b for (a, _), (b, _) in pairwise(unit.lines))
    assert unit.lines.maxlen == 1000


@pytest.mark.parametrize(
    ("code", "words"),
    [(0, "ended with 0"), (-15, "killed by SIGTERM"), (-200, "killed by signal 200")],
)
def test_endings(code: int, words: str) -> None:
    assert ending(code) == words
