"""A thread that waits in Zenoh: for messages, for a time, until it is woken, until the end."""

from __future__ import annotations

import os
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from typing import Any

import pytest
from support.wait import HANG, runs, wait_until

from yarpy.peers.ros2.zenoh import ring as module
from yarpy.peers.ros2.zenoh.ring import SPARE, Ring
from yarpy.peers.zenoh.library import WAKE
from yarpy.peers.zenoh.transport import SharedSession, share

zenoh = pytest.importorskip("zenoh", reason='Zenoh: pip install "yarpy[zenoh]"')

KEY = "yarpy/ring"


@pytest.fixture
def shared(router: int) -> Iterator[SharedSession]:
    with share() as found:
        yield found


@pytest.fixture
def ring(shared: SharedSession) -> Iterator[Ring]:
    made = Ring(shared.session, KEY, 2, lambda: None)
    yield made
    if id(made) in module._OPEN:
        made.undeclare()


def waiting(call: Callable[[], Any]) -> Future[Any]:
    """What a thread finds that waits in a ring by now."""
    found: Future[Any] = Future()

    def run() -> None:
        try:
            found.set_result(call())
        except Exception as error:
            found.set_exception(error)

    thread = threading.Thread(target=run)
    thread.start()
    wait_until(lambda: found.done() or runs("Ring.wait", thread.ident or 0))
    return found


def test_a_message_ends_the_wait(shared: SharedSession, ring: Ring) -> None:
    found = waiting(lambda: ring.wait(None))
    shared.session.put(KEY, b"x", attachment=b"y")
    sample = found.result(HANG)
    assert (bytes(sample.payload), bytes(sample.attachment)) == (b"x", b"y")
    assert ring.look() is None


def test_the_newest_are_there(shared: SharedSession, ring: Ring) -> None:
    for number in range(20):
        shared.session.put(KEY, bytes([number]))
    found = [bytes(ring.wait(None).payload)[0] for _ in range(ring.most)]
    assert found == [*range(20 - 2 - SPARE, 20)]
    assert ring.look() is None


def test_who_waits_is_woken(ring: Ring) -> None:
    found = waiting(lambda: ring.wait(None))
    wait_until(lambda: ring._waiting)
    ring.wake()
    sample = found.result(HANG)  # None, if it had not quite begun
    assert sample is None or bytes(sample.attachment) == WAKE
    assert ring.woken


def test_who_does_not_wait_gets_nothing(ring: Ring) -> None:
    ring.wake()
    assert ring.look() is None
    assert ring.wait(None) is None  # it says so all the same
    assert ring.look() is None


def test_the_clock_wakes(ring: Ring) -> None:
    begun = time.monotonic()
    sample = ring.wait(begun + 0.05)
    assert time.monotonic() >= begun + 0.05
    assert bytes(sample.attachment) == WAKE


def test_an_alarm_of_an_earlier_wait_wakes_nobody(shared: SharedSession, ring: Ring) -> None:
    first = time.monotonic() + 0.05
    shared.session.put(KEY, b"x")
    assert bytes(ring.wait(first).payload) == b"x"
    later = first + 0.1
    sample = ring.wait(later)  # for which the clock is set anew when the alarm rings
    assert time.monotonic() >= later
    assert bytes(sample.attachment) == WAKE


def test_no_other_session_is_woken(router: int, ring: Ring) -> None:
    config = zenoh.Config()
    config.insert_json5("mode", '"client"')
    config.insert_json5("connect/endpoints", f'["tcp/{os.environ["YARPY_ZENOH"]}"]')
    with zenoh.open(config) as other:
        heard = other.declare_subscriber(KEY)
        publisher = ring._session.declare_publisher(KEY)
        wait_until(lambda: publisher.matching_status.matching)
        sample = ring.wait(time.monotonic() + 0.05)
        assert bytes(sample.attachment) == WAKE
        publisher.put(b"behind it")
        assert bytes(heard.recv().payload) == b"behind it"
        publisher.undeclare()


@pytest.mark.parametrize("end", ["taken back", "session closed"])
def test_the_end_of_it_ends_the_wait(router: int, end: str) -> None:
    config = zenoh.Config()
    config.insert_json5("mode", '"client"')
    config.insert_json5("connect/endpoints", f'["tcp/{os.environ["YARPY_ZENOH"]}"]')
    left = []
    session = zenoh.open(config)
    ring = Ring(session, KEY, 1, lambda: left.append(1))
    found = waiting(lambda: ring.wait(None))
    ring.undeclare() if end == "taken back" else session.close()  # type: ignore[no-untyped-call]
    with pytest.raises(zenoh.ZError):
        found.result(HANG)
    ring.wake()  # nobody, and does no harm
    if end != "taken back":
        ring.undeclare()
    assert left == [1]
    session.close()  # type: ignore[no-untyped-call]


ENDS = """
import threading, sys
import yarpy
from yarpy.peers.ros2.zenoh.ring import Ring
from yarpy.peers.zenoh.library import CALLS
from yarpy.peers.zenoh.transport import share
shared = share()
ring = Ring(shared.session, "yarpy/ring", 1, lambda: None)
inside = threading.Event()
def wait():
    with ring.lock:
        while not CALLS.over:
            inside.set()
            try:
                ring.wait(None)
            except ring.error:
                pass
threading.Thread(target=wait, daemon=True).start()
inside.wait()
print("ends", flush=True)
"""


def test_a_program_may_end_while_a_thread_waits(router: int) -> None:
    done = subprocess.run(
        [sys.executable, "-c", ENDS], capture_output=True, text=True, timeout=4 * HANG
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "ends\n", "")
