"""Descriptors end with their objects."""

from __future__ import annotations

import _thread
import operator
import os
import signal
import socket
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import pytest

import yarpy
from yarpy.transports.descriptor import has_input, opened, opened_pair, owned

pytestmark = pytest.mark.skipif(not hasattr(os, "pipe2"), reason="this system has no pipe2")


class Alarm(Exception):
    """What the signal raises."""


@pytest.fixture(autouse=True)
def alarm() -> Iterator[None]:
    def ring(*_: object) -> None:
        raise Alarm

    before = signal.signal(signal.SIGUSR1, ring)
    yield
    signal.signal(signal.SIGUSR1, before)


def is_open(number: int) -> bool:
    try:
        os.fstat(number)
    except OSError:
        return False
    return True


def test_it_ends_with_its_object() -> None:
    one, other = opened_pair(os.pipe2, os.O_CLOEXEC)
    numbers = one.fileno(), other.fileno()
    assert all(map(is_open, numbers))
    assert not any(map(os.get_inheritable, numbers))
    one.close()
    one.close()
    del other
    assert not any(map(is_open, numbers))


def test_so_it_does_where_a_signal_comes_at_that_moment() -> None:
    """`__del__` of Python would be cut at its first step, and the descriptor be left."""
    held = [opened(os.dup, 0)]
    number = held[0].fileno()
    with pytest.raises(Alarm):
        # All in C, so that the interpreter sees the signal once the object is about to end.
        list(map(operator.call, (partial(_thread.interrupt_main, signal.SIGUSR1), held.clear)))
    assert not is_open(number)


@pytest.mark.parametrize("place", [0, 1])
def test_where_one_is_none_all_are_closed(place: int, tmp_path: Path) -> None:
    numbers = [os.dup(0), os.dup(0)]
    os.close(numbers[place])
    numbers[place] = os.open(tmp_path, os.O_RDONLY)
    with pytest.raises(OSError):
        owned(numbers)
    assert not any(map(is_open, numbers))


def test_input_is_waited_for_at_any_number() -> None:
    """Also where a program has more than a thousand: `select` would refuse those."""
    import fcntl
    import resource

    number, before = 1500, resource.getrlimit(resource.RLIMIT_NOFILE)
    if before[1] != resource.RLIM_INFINITY and before[1] <= number:
        pytest.skip(f"this system gives a program {before[1]} descriptors at most (ulimit -Hn)")
    resource.setrlimit(resource.RLIMIT_NOFILE, (max(before[0], number + 100), before[1]))
    try:
        here, there = socket.socketpair()
        with here, there:
            high = fcntl.fcntl(here, fcntl.F_DUPFD_CLOEXEC, number)
            try:
                assert not has_input(high, 0.001)
                there.send(b"x")
                assert has_input(high, 60.0)
                there.shutdown(socket.SHUT_WR)
                assert has_input(here.fileno(), 60.0)
            finally:
                os.close(high)
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, before)


def test_nobody_else_selects() -> None:
    """Those that do have another way where there is `poll`, or are for Windows."""
    source = Path(yarpy.__file__).parent
    found = {
        path.relative_to(source).as_posix()
        for path in source.rglob("*.py")
        if "select.select(" in path.read_text("utf-8")
    }
    room = ("descriptor", "polling", "socket_transport")
    others = {"link/send/readiness.py", "platform/connecting.py"}
    assert found == others | {f"transports/{name}.py" for name in room}
