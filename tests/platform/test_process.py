"""Whether another process lives, and signals to it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator

import pytest
from support.wait import HANG

from yarpy.platform import process

WAITS = "import sys; print('there', flush=True); sys.stdin.read()"


@pytest.fixture
def other() -> Iterator[subprocess.Popen[str]]:
    with subprocess.Popen(
        [sys.executable, "-c", WAITS],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        start_new_session=True,
    ) as child:
        assert child.stdout is not None and child.stdout.readline() == "there\n"
        yield child
        child.kill()


@pytest.mark.skipif(sys.platform == "darwin", reason="macOS says it by ps alone")
def test_the_program_of_a_process(other: subprocess.Popen[str]) -> None:
    assert "python" in process.program(other.pid)
    assert process.program(0) == ""


def test_one_lives_until_it_ends_and_asking_does_nothing_to_it(
    other: subprocess.Popen[str],
) -> None:
    assert process.lives(os.getpid())
    assert process.lives(other.pid)
    assert process.lives(other.pid)
    other.communicate("", HANG)
    assert other.returncode == 0
    assert not process.lives(other.pid)


@pytest.mark.parametrize("send", [process.signal_group, process.signal_one])
def test_what_nobody_refuses(other: subprocess.Popen[str], send) -> None:
    assert send(other.pid, process.KILL)
    assert other.wait(HANG) != 0
    assert not send(other.pid, process.KILL)


def test_asking_for_a_group(other: subprocess.Popen[str]) -> None:
    assert process.signal_group(other.pid, 0)
    other.communicate("", HANG)
    assert not process.signal_group(other.pid, 0)


def test_who_belongs_to_a_group(other: subprocess.Popen[str]) -> None:
    assert process.in_group(other.pid, other.pid)
    assert not process.in_group(os.getpid(), other.pid)


@pytest.mark.skipif(sys.platform == "win32", reason="Windows stops no processes")
def test_who_was_stopped_goes_on(other: subprocess.Popen[str]) -> None:
    assert process.signal_one(other.pid, signal.SIGSTOP)
    _, status = os.waitpid(other.pid, os.WUNTRACED)
    assert os.WIFSTOPPED(status)
    process.go_on(other.pid)
    other.communicate("", HANG)
    assert other.returncode == 0
