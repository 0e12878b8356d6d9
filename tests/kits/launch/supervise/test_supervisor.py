"""Whole applications, of programs that really run."""

import os
import signal
import sys
import threading
import time
from pathlib import Path

import pytest
from support.lasted import lasted
from support.wait import HANG, wait_until

import yarpy
from yarpy.errors import UnknownName
from yarpy.kits.launch.application.application import Application, Module, Need
from yarpy.kits.launch.supervise import process
from yarpy.kits.launch.supervise.supervisor import Supervisor

#: for what has words of a shell, signals, or is looked at in /proc
PROC = pytest.mark.skipif(not process.known(), reason="this system has no /proc to look at")
POSIX = os.name == "posix"
SLEEP = ("sleep", "600") if POSIX else (sys.executable, "-c", "import time; time.sleep(600)")
TRUE = ("true",) if POSIX else (sys.executable, "-c", "")


def module(label: str, *words: str, **more: object) -> Module:
    return Module(label, words[0] if words else SLEEP[0], words=words or SLEEP, **more)  # type: ignore[arg-type]


def supervisor(*modules: Module, **more: object) -> Supervisor:
    found = Application("app", modules=[*modules])
    return Supervisor(found, **{"grace": 1.0, **more})  # type: ignore[arg-type]


def all_in(running: Supervisor, state: str) -> bool:
    return all(one.state == state for one in running.units.values())


def left(running: Supervisor) -> dict[int, str]:
    return process.members({}, {running.local.mark(label) for label in running.units})


def test_stops_in_reverse(network: yarpy.LocalNames, tmp_path: Path) -> None:
    ends: list[str] = []

    def news(label: str, text: str) -> None:
        if text in ("stopping", "stopped"):
            ends.append(f"{label} {text}")

    running = supervisor(
        module("a"),
        module("b", after=("a",)),
        module("c", after=("b",), needs=[Need("/p")]),
        news=news,
        names=network,
    )
    assert running.start() == ""
    wait_until(lambda: running.units["b"].state == "running")
    assert running.units["c"].state == "waiting"
    with yarpy.Port("/p", names=network):
        wait_until(lambda: all_in(running, "running"))
    assert running.stop() == [] and running.failed == []
    words = ("stopping", "stopped")
    assert ends == [f"{label} {word}" for label in "cba" for word in words]
    assert left(running) == {}


@PROC
def test_a_killed_program_is_back_at_once(network: yarpy.LocalNames) -> None:
    back = threading.Event()
    seen: list[str] = []

    def news(label: str, text: str) -> None:
        seen.append(text)
        if len([one for one in seen if one.startswith("running")]) == 2:
            back.set()

    running = supervisor(module("a"), news=news, names=network)
    running.start()
    wait_until(lambda: all_in(running, "running"))
    handle = running.units["a"].handle
    assert handle is not None
    os.kill(handle.pid, signal.SIGKILL)
    assert back.wait(HANG)
    assert seen[1] == "pausing: killed by SIGKILL; again in 0.1 s"
    assert running.status()["programs"][0]["restarts"] == 1
    running.stop()


def test_it_is_over_when_nothing_runs_any_more(network: yarpy.LocalNames) -> None:
    running = supervisor(
        module("good", *TRUE),
        module("bad", sys.executable, "-c", "exit(3)", restart="no"),
        module("gone", "/no/such/program"),  # never seen running, as a quick one may be
        module("late", after=("gone",)),
        names=network,
    )
    running.start()
    assert running.over.wait(HANG)
    assert running.stop() == []
    bad, gone, late = sorted(running.failed)
    assert bad == "bad: ended with 3" and gone.startswith("gone: it cannot be started")
    assert late == 'late: "gone", after which it starts, has failed'


@PROC
def test_status_and_lines(network: yarpy.LocalNames) -> None:
    busy = "echo one; echo two; while :; do :; done"
    running = supervisor(
        module("busy", "sh", "-c", busy), module("quiet"), names=network, usual="no"
    )
    running.start()
    wait_until(lambda: all_in(running, "running") and len(running.units["busy"].lines) == 2)

    def measured() -> bool:
        programs = running.status()["programs"]
        return bool(programs[0]["cpu"] and programs[1]["cpu"] == 0.0)

    wait_until(measured)
    first, second = running.status()["programs"]
    assert (first["name"], first["state"], first["line"]) == ("busy", "running", "two")
    assert first["memory"] > 10_000 and second["host"] == "here" and second["restarts"] == 0
    assert [line for _, _, line in running.lines("busy")] == ["one", "two"]
    (last,) = running.lines(most=1)
    assert last[1:] == ("busy", "two") and running.lines(since=last[0]) == []
    with pytest.raises(UnknownName, match='no program is called "bsy": did you mean "busy"'):
        running.restart("bsy")
    running.stop()
    assert all_in(running, "stopped")


def test_a_port_that_the_whole_needs(network: yarpy.LocalNames) -> None:
    running = supervisor(module("a"), names=network)
    running.application.needs = [Need("/clock", 0.1)]
    assert running.start().endswith('"/clock" is not there after 0.1 s')
    assert running.stop() == [] and all_in(running, "stopped") is False
    assert left(running) == {}


@PROC
def test_killing_takes_the_deaf(network: yarpy.LocalNames) -> None:
    deaf = "trap '' TERM; echo ready; while :; do sleep 0.05; done"
    running = Supervisor(
        Application("app", modules=[module("deaf", "sh", "-c", deaf)]), grace=600.0, names=network
    )
    running.start()
    wait_until(lambda: running.units["deaf"].lines)
    stopping = threading.Thread(target=running.stop)
    stopping.start()
    wait_until(lambda: running.units["deaf"].state == "stopping")
    running.kill()
    stopping.join(HANG)
    assert not stopping.is_alive() and left(running) == {}


def test_no_runner_for_another_computer() -> None:
    with pytest.raises(UnknownName, match="nothing that starts programs"):
        supervisor(module("a", node="/nodeB"))


@PROC
def test_a_hundred_programs(network: yarpy.LocalNames) -> None:
    running = supervisor(*(module(f"s{n}") for n in range(100)), names=network, grace=HANG)
    running.start()
    wait_until(lambda: all_in(running, "running"))
    began = time.monotonic()
    assert running.stop() == [] and left(running) == {}
    assert lasted(began) < HANG


def test_what_does_not_end_is_waited_for_once(network: yarpy.LocalNames) -> None:
    """Such as a program on a computer that does not answer any more."""
    running = supervisor(module("a"), names=network)
    running.start()
    wait_until(lambda: all_in(running, "running"))
    waits: list[float] = []

    def join(seconds: float) -> bool:
        waits.append(seconds)
        return False

    unit = running.units["a"]
    end, unit.join = unit.join, join  # type: ignore[method-assign, assignment]
    assert running.stop() == ["a"]
    assert len(waits) == 1
    assert end(HANG)


def test_what_is_ended_by_hand_can_be_started_again(network: yarpy.LocalNames) -> None:
    running = supervisor(module("a"), names=network)
    running.start()
    unit = running.units["a"]
    for stop in (False, True):
        wait_until(lambda: unit.state == "running")
        running.take_off("a", at_once=stop)
        wait_until(lambda: unit.state == "stopped")
        assert not running.over.is_set()
        running.begin("a")
    wait_until(lambda: unit.state == "running")
    running.begin("a")  # it runs already
    assert unit.state == "running"
    running.stop()
    assert left(running) == {}


@pytest.mark.parametrize("moment", ["stopping", "stopped"])
def test_what_is_started_again_while_its_end_is_told_is_not_over(
    network: yarpy.LocalNames, moment: str
) -> None:
    begun = threading.Event()

    def news(label: str, text: str) -> None:
        if text == moment and not begun.is_set():
            begun.set()
            again = threading.Thread(target=running.begin, args=("a",))
            again.start()
            again.join(HANG)

    running = supervisor(module("a"), names=network, news=news)
    running.start()
    unit = running.units["a"]
    wait_until(lambda: unit.state == "running")
    first = unit.handle
    running.take_off("a")
    wait_until(lambda: unit.state == "running" and unit.handle is not first)
    assert begun.is_set() and not running.over.is_set()
    running.stop()


def test_at_rest_nothing_runs_and_nothing_is_over(network: yarpy.LocalNames) -> None:
    running = supervisor(module("a"), module("b", *TRUE), names=network)
    running.rest()
    assert all_in(running, "stopped") and left(running) == {}
    running.begin("b")
    wait_until(lambda: running.units["b"].state == "ended")
    assert not running.over.is_set()
    running.restart("a")
    wait_until(lambda: running.units["a"].state == "running")
    assert running.sessions() == {running.units["a"].handle.pid: "a"}  # type: ignore[union-attr]
    running.stop()


def test_another_description(network: yarpy.LocalNames) -> None:
    running = supervisor(module("stays"), module("goes"), module("other"), names=network)
    running.start()
    wait_until(lambda: all_in(running, "running"))
    before = {**running.units}
    found = Application("app", modules=[
        module("stays"), module("other", *SLEEP, "1"), module("new")
    ])  # fmt: skip
    assert running.change(found) == [
        "new is new",
        "goes is no longer in the file",
        "other is described otherwise, and was started again",
    ]
    wait_until(lambda: all_in(running, "running"))
    assert [*running.units] == ["stays", "other", "new"]
    assert running.units["stays"] is before["stays"]
    assert running.units["other"].handle is not before["other"].handle
    assert before["goes"].state == "stopped" and not running.over.is_set()
    running.stop()
    assert left(running) == {}
