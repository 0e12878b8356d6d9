"""Reading, and what ends it: signal handlers, other threads, a port that is closed."""

from __future__ import annotations

import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType

import pytest
from support.lasted import lasted
from support.system import NO_POLICIES, NO_TIMER
from support.wait import HANG

from yarpy.errors import LocalProtocolError, PortClosed
from yarpy.nameserver.local import LocalNames
from yarpy.port.port import BufferedPort, Port

CLOSED: dict[str, Callable[[Port], object]] = {
    "read": lambda port: port.read(),
    "poll": lambda port: port.poll(),
    "waiting": lambda port: port.waiting,
    "write": lambda port: port.write(1),
    "flush": lambda port: port.flush(),
    "prepare": lambda port: port.prepare(3),
    "ask": lambda port: port.ask(1),
    "attach": lambda port: port.attach("in", {"monitor": "throttle_down"}),
    "detach": lambda port: port.detach("in"),
    "resume": lambda port: port.resume(),
}


@pytest.fixture
def names() -> LocalNames:
    return LocalNames()


@contextmanager
def signalled(port: Port, source: Port, act: Callable[[], object]) -> Iterator[None]:
    """Call `act` once in a signal handler of the main thread, above a read straight from the
    socket. A reader that does not get that far by itself is sent more, each time after a longer
    while: it has to get through what was sent before."""
    pause = 0.01  # seconds

    def handle(number: int, frame: FrameType | None) -> None:
        nonlocal pause
        lease = port.inputs[0]._link.turn.lease
        if lease is not None and lease.busy and not lease.over:
            act()
            return
        for number in range(50):
            source.write(["more", number], timeout=0.0)  # who reads is the frame beneath
        pause *= 1.5
        signal.setitimer(signal.ITIMER_REAL, pause)

    before = signal.signal(signal.SIGALRM, handle)
    signal.setitimer(signal.ITIMER_REAL, pause)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def read_until(port: Port | BufferedPort, last: object) -> None:
    """Read on until that comes, past what `signalled` has sent."""
    while port.read(timeout=HANG).value != last:
        pass


def flow(port: Port | BufferedPort, source: Port) -> None:
    """Let messages flow until the reader has the lease."""
    source.connect(port.name, "tcp")
    for number in range(1000):
        source.write([number])
        port.read(timeout=HANG)
        if port.inputs[0]._link.turn.leased:
            return
    raise AssertionError("no lease")


@pytest.mark.parametrize("name", CLOSED)
def test_closed_port_says_so(name: str, names: LocalNames) -> None:
    port = Port("/port", names=names)
    port.close()
    with pytest.raises(PortClosed):
        CLOSED[name](port)


def test_closed_port_says_what_it_was(names: LocalNames) -> None:
    port = Port("/port", names=names)
    port.close()
    port.interrupt()
    port.close()
    assert (port.name, port.closed, port.inputs, port.outputs) == ("/port", True, [], [])
    assert port.stats.name == "/port"
    assert port.address


@pytest.mark.skipif(bool(NO_TIMER), reason=NO_TIMER)
@pytest.mark.parametrize("act", [TimeoutError, KeyboardInterrupt, ValueError])
def test_what_a_signal_handler_raises_comes_out_of_read(
    act: type[BaseException], names: LocalNames
) -> None:
    def fail() -> None:
        raise act

    with Port("/in", names=names) as in_, Port("/out", names=names) as out:
        flow(in_, out)
        with signalled(in_, out, fail), pytest.raises(act) as caught:
            read_until(in_, "the end")
        assert type(caught.value) is act
        out.write(["after"])
        read_until(in_, ["after"])
        assert len(in_.inputs) == 1


@pytest.mark.skipif(bool(NO_TIMER), reason=NO_TIMER)
@pytest.mark.parametrize("end", [Port.close, Port.interrupt])
def test_signal_handler_may_end_the_port_that_is_read(
    end: Callable[[Port], object], names: LocalNames
) -> None:
    with Port("/in", names=names) as in_, Port("/out", names=names) as out:
        flow(in_, out)
        took: list[float] = []

        def end_it() -> None:
            started = time.monotonic()
            end(in_)
            took.append(lasted(started))

        with signalled(in_, out, end_it), pytest.raises(PortClosed):
            read_until(in_, "the end")
        assert len(took) == 1 and took[0] < 10  # nobody waits for the frame beneath


@pytest.mark.skipif(bool(NO_TIMER), reason=NO_TIMER)
def test_signal_handler_that_reads_what_is_read_beneath_is_told(names: LocalNames) -> None:
    found: list[BaseException] = []

    def read_as_well() -> None:
        try:
            in_.read()
        except LocalProtocolError as error:
            found.append(error)
            out.write(["go on"])

    with Port("/in", names=names) as in_, Port("/out", names=names) as out:
        flow(in_, out)
        with signalled(in_, out, read_as_well):
            read_until(in_, ["go on"])
        assert "signal handler" in str(found[0])


def test_two_threads_that_read_share_what_comes(names: LocalNames) -> None:
    """A lease is of one thread: the other is not left out."""
    with BufferedPort("/in", names=names, strict=True) as in_, Port("/out", names=names) as out:
        flow(in_, out)
        while in_.poll() is not None:
            pass
        found: dict[str, list[int]] = {"one": [], "two": []}

        def read(name: str) -> None:
            for message in in_:
                found[name].append(message.value[0])

        threads = [threading.Thread(target=read, args=(name,)) for name in found]
        for thread in threads:
            thread.start()
        for number in range(2000):
            out.write([number], wait=number % 100 == 99)
        out.flush(HANG)
        while sum(map(len, found.values())) < 2000:
            time.sleep(0.01)
        in_.interrupt()
        for thread in threads:
            thread.join(HANG)
        assert sorted(found["one"] + found["two"]) == list(range(2000))
        for numbers in found.values():
            assert numbers == sorted(numbers)


SPINNING = """
import os, sys, threading
try:
    os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(10))
except PermissionError:
    print("no right")
    sys.exit()
os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
from yarpy.nameserver.local import LocalNames
from yarpy.port.port import Port

names = LocalNames()
with Port("/in", names=names, spin=True) as in_, Port("/out", names=names) as out:
    out.connect("/in", "tcp")

    def write():
        for number in range(300):
            out.write([number])

    threading.Thread(target=write, daemon=True).start()
    for number in range(300):
        assert in_.read(timeout=20).value == [number]
print("all came")
"""


@pytest.mark.skipif(bool(NO_POLICIES), reason=NO_POLICIES)
def test_spinning_with_a_real_time_priority_leaves_room_for_its_program() -> None:
    """On one core, where a thread that never gives way keeps all others from it."""
    words = [sys.executable, "-c", SPINNING]
    done = subprocess.run(words, capture_output=True, text=True, timeout=2 * HANG)
    if done.stdout == "no right\n":
        pytest.skip("needs the right to real-time priorities: run as root, or with CAP_SYS_NICE")
    assert done.stdout == "all came\n", done.stderr
