"""Programs on this computer: what they print, how they end, and that nothing is left of them."""

import itertools
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator

import pytest
from support.wait import HANG, wait_until

from yarpy.kits.launch.supervise import local, process
from yarpy.kits.launch.supervise.line import Lines
from yarpy.kits.launch.supervise.local import LocalHandle, LocalRunner
from yarpy.kits.launch.supervise.runner import Program, Runner
from yarpy.limit import OUTPUT_LINE
from yarpy.platform.process import lives

#: for what has words of a shell, or is looked at in /proc
PROC = pytest.mark.skipif(not process.known(), reason="this system has no /proc to look at")
NUMBERS = itertools.count()


class Started:
    """A program that is running, and what came from it."""

    def __init__(self, runner: LocalRunner, *command: str, **more: object) -> None:
        self.lines: list[str] = []
        self.ends: list[int] = []
        self.after: list[str] = []
        self.over = threading.Event()
        name = f"it {next(NUMBERS)}"  # what one leaves behind is told from the others by it
        self.mark = runner.mark(name)
        program = Program(name, command, **more)  # type: ignore[arg-type]
        self.handle: LocalHandle = runner.start(program, self.take, self.end)

    def take(self, line: str) -> None:
        (self.after if self.ends else self.lines).append(line)

    def end(self, code: int) -> None:
        self.ends.append(code)
        self.over.set()

    def wait(self) -> int:
        assert self.over.wait(HANG)
        assert self.after == [] and len(self.ends) == 1
        assert self.handle.returncode == self.ends[0] and self.handle.state == "ended"
        return self.ends[0]

    def left(self) -> dict[int, str]:
        return process.members({self.handle.pid: self.mark}, {self.mark})


def runs(pid: int) -> bool:
    """Return whether a process is there; a zombie, whose new parent does not ask for it, is not."""
    found = process.look(pid) if process.known() else None
    return lives(pid) if found is None else found.alive


@pytest.fixture
def runner() -> Iterator[LocalRunner]:
    yield LocalRunner(grace=0.3)


def python(runner: LocalRunner, code: str, **more: object) -> Started:
    return Started(runner, sys.executable, "-c", code, **more)


def shell(runner: LocalRunner, code: str, **more: object) -> Started:
    return Started(runner, "/bin/sh", "-c", code, **more)


def test_it_is_a_runner(runner: LocalRunner) -> None:
    checked: Runner = runner
    assert checked is runner


@PROC
def test_output_and_code(runner: LocalRunner, tmp_path) -> None:
    started = shell(
        runner,
        'pwd; echo "$A" >&2; cat; printf end; exit 3',
        workdir=str(tmp_path),
        environment={"A": "b c"},
    )
    assert started.wait() == 3
    assert started.lines == [str(tmp_path), "b c", "end"]


@PROC
def test_one_that_dies_in_its_first_millisecond(runner: LocalRunner) -> None:
    started = [Started(runner, "/bin/false") for _ in range(20)]
    assert [one.wait() for one in started] == [1] * 20


@PROC
@pytest.mark.parametrize(
    ("command", "workdir"), [("/no/such/program", ""), ("/etc/hostname", ""), ("true", "/no/such")]
)
def test_what_cannot_be_started(runner: LocalRunner, command: str, workdir: str) -> None:
    with pytest.raises(OSError):
        Started(runner, command, workdir=workdir)


def test_whatever_cannot_be_started_is_named(
    runner: LocalRunner, monkeypatch: pytest.MonkeyPatch
) -> None:
    def start(*words: object, **more: object) -> None:
        raise OSError(2, "there is none")  # as on Windows

    monkeypatch.setattr(subprocess, "Popen", start)
    with pytest.raises(OSError, match="there is none: 'slep'"):
        Started(runner, "slep", "600")


def test_one_that_becomes_no_group_is_not_left(
    runner: LocalRunner, monkeypatch: pytest.MonkeyPatch
) -> None:
    pids: list[int] = []

    def refuse(pid: int) -> None:
        pids.append(pid)
        raise OSError(5, "access denied")

    monkeypatch.setattr(local, "Group", refuse)
    with pytest.raises(OSError, match="access denied"):
        python(runner, "import time; time.sleep(600)")
    assert len(pids) == 1 and not runs(pids[0])


def test_the_last_lines_come_however_slowly_they_are_taken(
    runner: LocalRunner, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Slow(Lines):
        def feed(self, data: bytes) -> Iterator[str]:
            for line in super().feed(data):
                threading.Event().wait(0.2)
                yield line

    monkeypatch.setattr(local, "_HELD_OPEN", 0.05)
    monkeypatch.setattr(local, "Lines", Slow)
    started = python(runner, "print('one'); print('two')")
    assert started.wait() == 0 and started.lines == ["one", "two"]


@PROC
def test_the_number_of_a_signal_is_the_code(runner: LocalRunner) -> None:
    started = Started(runner, "sleep", "600")
    assert started.handle.returncode is None and started.handle.state == "running"
    assert started.handle.wait(0.01) is None
    os.kill(started.handle.pid, signal.SIGKILL)
    assert started.wait() == -signal.SIGKILL
    started.handle.terminate()  # it is over: nobody gets a signal


@PROC
def test_one_that_ignores_sigterm_is_killed(runner: LocalRunner) -> None:
    started = shell(runner, "trap '' TERM INT; echo ready; while :; do sleep 0.05; done")
    wait_until(lambda: started.lines == ["ready"])
    started.handle.terminate()
    assert started.wait() == -signal.SIGKILL
    assert started.left() == {}


@PROC
def test_one_that_is_stopped_is_killed(runner: LocalRunner) -> None:
    started = Started(runner, "sleep", "600")
    started.handle.terminate(signal.SIGSTOP)
    started.handle.terminate()
    assert started.wait() in (-signal.SIGKILL, -signal.SIGTERM)


@PROC
def test_children_end_with_it(runner: LocalRunner) -> None:
    started = shell(runner, "sleep 600 & sleep 600 & echo ready; wait")
    wait_until(lambda: started.lines == ["ready"])
    wait_until(lambda: len(started.left()) == 3)
    started.handle.terminate()
    assert started.wait() == -signal.SIGTERM
    assert started.left() == {}


DAEMON = """
import os, signal, time
signal.signal(signal.SIGTERM, signal.SIG_IGN)
signal.signal(signal.SIGHUP, signal.SIG_IGN)
if os.fork() == 0:
    os.setsid()
    if os.fork() == 0:
        print("ready", flush=True)
        time.sleep(600)
os._exit(0)
"""


@PROC
def test_what_it_leaves_behind_ends_too(runner: LocalRunner) -> None:
    """A daemon: two forks, a session of its own, deaf to SIGTERM, and it holds the output open."""
    started = python(runner, DAEMON)
    assert started.wait() == 0
    assert started.handle.left_behind > 0 and started.handle.remaining == []
    assert started.left() == {}


@PROC
def test_another_name_and_no_environment_hide_nobody(runner: LocalRunner) -> None:
    code = "exec env -i /bin/sh -c 'exec sleep 600' & exec sleep 600"
    started = shell(runner, code)
    wait_until(lambda: len(started.left()) == 2)
    started.handle.terminate()
    started.wait()
    assert started.left() == {}


@PROC
def test_a_flood_without_a_newline(runner: LocalRunner) -> None:
    """As many bytes as one likes: what is kept is a line of the longest that is allowed."""
    size = 64 << 20
    started = shell(runner, f"head -c {size} /dev/zero; echo; echo last")
    assert started.wait() == 0
    flood, last = started.lines
    assert last == "last" and len(flood) < OUTPUT_LINE + 100
    assert flood.endswith(f" ... and {size - OUTPUT_LINE} bytes more")


PARENT = """
import subprocess, sys, time
child = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"])
print(child.pid, flush=True)
time.sleep(600 * int(sys.argv[1]))
"""


@pytest.mark.parametrize("waits", [True, False])
def test_nobody_whom_it_started_is_left(runner: LocalRunner, waits: bool) -> None:
    """On each system: asked to end, and ending by itself."""
    started = Started(runner, sys.executable, "-c", PARENT, str(int(waits)))
    wait_until(lambda: started.lines)
    if waits:
        started.handle.terminate()
    assert (started.wait() == 0) == (not waits)
    assert waits or started.handle.left_behind == 1
    assert started.handle.remaining == [] and not runs(int(started.lines[0]))
