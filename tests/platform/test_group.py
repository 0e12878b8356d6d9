"""A program and all that it starts: asked to end together, or ended."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator

import pytest
from support.wait import HANG, wait_until

from yarpy.platform import group
from yarpy.platform.group import START, Group
from yarpy.platform.process import KILL, lives, signal_one

#: Starts another one, says its number, and waits; with a word it ends at once.
PARENT = """
import subprocess, sys, time
with subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"]) as child:
    print(child.pid, flush=True)
    if len(sys.argv) > 1:
        import os
        os._exit(3)
    time.sleep(600)
"""
# To be asked needs a console on Windows, which tests have not. wine 8 sends no Ctrl-Break
# (GenerateConsoleCtrlEvent: an invalid handle) but Ctrl-C, which a new process group ignores until
# it does so no more: what is asked gives way for that.
ASKS = """
import signal, subprocess, sys
from yarpy.platform import group

ASKED = '''
import signal, sys, time
if sys.platform == "win32":
    import ctypes
    ctypes.WinDLL("kernel32").SetConsoleCtrlHandler(None, False)
def end(number, frame):
    print("asked", flush=True)
    sys.exit(7)
for name in ("SIGTERM", "SIGINT", "SIGBREAK"):
    if hasattr(signal, name):
        signal.signal(getattr(signal, name), end)
print("there", flush=True)
while True:
    time.sleep(0.05)
'''
if sys.platform == "win32":
    import ctypes
    kernel = ctypes.WinDLL("kernel32")
    kernel.SetConsoleCtrlHandler(None, True)
    signal.signal(signal.SIGBREAK, signal.SIG_IGN)
    if not kernel.GenerateConsoleCtrlEvent(signal.CTRL_BREAK_EVENT, 0):
        group._BREAK = signal.CTRL_C_EVENT
child = subprocess.Popen([sys.executable, "-c", ASKED], stdout=subprocess.PIPE, text=True,
                         stdin=subprocess.DEVNULL, **group.START)
family = group.Group(child.pid)
print(child.stdout.readline().strip(), len(family.members()), flush=True)
print(family.signal(signal.SIGTERM), child.stdout.read().strip(), child.wait(), flush=True)
print(family.members(), family.signal(signal.SIGTERM))
"""
HOLDS = f"""
import subprocess, sys, time
from yarpy.platform import group
child = subprocess.Popen([sys.executable, "-c", {PARENT!r}], stdin=subprocess.DEVNULL,
                         stdout=subprocess.PIPE, text=True, **group.START)
family = group.Group(child.pid)
print(child.pid, child.stdout.readline().strip(), flush=True)
time.sleep(600)
"""

Starts = Callable[..., tuple["subprocess.Popen[str]", Group, int]]


@pytest.fixture
def start() -> Iterator[Starts]:
    """Start `PARENT` with words; give it, its group, and the number of whom it has started."""
    started: list[subprocess.Popen[str]] = []

    def begin(*words: str) -> tuple[subprocess.Popen[str], Group, int]:
        child = subprocess.Popen(
            [sys.executable, "-c", PARENT, *words],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            text=True,
            **START,
        )
        started.append(child)
        family = Group(child.pid)
        assert child.stdout is not None
        return child, family, int(child.stdout.readline())

    yield begin
    for child in started:
        with child:
            child.kill()


def test_all_are_asked_to_end() -> None:
    done = subprocess.run(
        [sys.executable, "-c", ASKS],
        input="",
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=HANG,
        creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
    )
    assert done.stdout.splitlines() == ["there 1", "True asked 7", "[] False"]


def test_all_are_ended(start: Starts) -> None:
    child, family, other = start()
    assert family.signal(0) if os.name == "posix" else len(family.members()) == 2
    assert family.signal(KILL)
    assert child.wait(HANG) != 0
    wait_until(lambda: not lives(other))
    wait_until(lambda: not family.members())
    assert not family.signal(KILL)


def test_who_is_left_behind_is_of_the_group(start: Starts) -> None:
    child, family, other = start("ends")
    assert child.wait(HANG) == 3
    assert lives(other) and family.members() == ([-child.pid] if os.name == "posix" else [other])
    assert family.signal(KILL)
    wait_until(lambda: not lives(other))


@pytest.mark.skipif(sys.platform != "win32", reason="only Windows ends a group with its holder")
def test_nothing_is_left_of_a_holder_that_is_killed() -> None:
    with subprocess.Popen(
        [sys.executable, "-c", HOLDS], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True
    ) as holder:
        assert holder.stdout is not None
        pids = [int(word) for word in holder.stdout.readline().split()]
        assert len(pids) == 2 and all(map(lives, pids))
        assert signal_one(holder.pid, KILL)
        assert holder.wait(HANG) == KILL
        for pid in pids:
            wait_until(lambda: not lives(pid))  # noqa: B023 - it is waited for here


@pytest.mark.skipif(sys.platform != "win32", reason="only Windows lets go of a group")
def test_a_group_that_nobody_holds_ends() -> None:
    with subprocess.Popen(
        [sys.executable, "-c", "import time; time.sleep(600)"], stdin=subprocess.DEVNULL, **START
    ) as child:
        family = Group(child.pid)
        assert family.members() == [child.pid]
        del family
        assert child.wait(HANG) is not None


@pytest.mark.skipif(sys.platform != "win32", reason="a signal needs no console")
def test_without_a_console_it_is_ended(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(group, "_BREAK", 99)  # which is refused as any would be without a console
    with subprocess.Popen(
        [sys.executable, "-c", "import time; time.sleep(600)"], stdin=subprocess.DEVNULL, **START
    ) as child:
        assert Group(child.pid).signal(15)
        assert child.wait(HANG) == 15


@pytest.mark.skipif(sys.platform != "win32", reason="only there a group is made of a process")
def test_a_program_that_has_gone_is_an_error() -> None:
    with pytest.raises(OSError):
        Group(0)
