"""A connection with a thread of its own."""

from __future__ import annotations

import threading
import time
from contextlib import suppress

import pytest
from support.build import replaces_a_method
from support.moments import Cut, cut, elsewhere, moments
from support.wait import HANG

from yarpy.errors import LinkClosed
from yarpy.link.counter import Counter
from yarpy.link.ending import NEVER, moment
from yarpy.link.send.queued import Queue
from yarpy.wire.message import Packet


class Slow:
    """A queue whose sending takes as long as a test wants."""

    def __init__(self) -> None:
        self.go = threading.Event()
        self.begun = threading.Event()
        self.sent: list[object] = []
        self.fails = False
        self.counter = Counter()
        self.queue = Queue(self.send, self.counter, "slow")
        self.queue.start()
        assert self.queue.thread is not None
        self.thread = self.queue.thread

    def offer(self, value: object) -> bool:
        return self.queue.put(Packet(value), None, 0)

    def wait(self, value: object) -> bool:
        return self.queue.wait_put(Packet(value), None, None, NEVER)

    def send(self, packet: Packet, due: float | None) -> None:
        self.begun.set()
        assert self.go.wait(HANG)
        if self.fails:
            raise LinkClosed("gone")
        self.sent.append(packet.value)


def test_one_message_is_on_its_way_and_others_are_dropped() -> None:
    slow = Slow()
    assert slow.offer(1)
    assert slow.begun.wait(HANG)
    assert not slow.offer(2)
    assert not slow.offer(3)
    slow.go.set()
    assert slow.queue.wait_empty(moment(5))
    assert slow.sent == [1]
    assert slow.offer(4)
    assert slow.queue.wait_empty(moment(5))
    assert slow.sent == [1, 4]
    slow.queue.stop()
    slow.thread.join(HANG)
    assert not slow.thread.is_alive()


def test_patient_writer_waits_for_its_turn() -> None:
    slow = Slow()
    slow.wait(1)
    assert slow.begun.wait(HANG)
    slow.wait(2)  # one may wait
    third = threading.Thread(target=slow.wait, args=(3,), daemon=True)
    third.start()
    time.sleep(0.03)
    assert third.is_alive()
    assert not slow.queue.wait_empty(moment(0.01))
    slow.go.set()
    third.join(HANG)
    assert slow.queue.wait_empty(moment(5))
    assert slow.sent == [1, 2, 3]
    assert slow.counter.drops == 0
    slow.queue.stop()


def test_stopping_counts_what_still_waited() -> None:
    slow = Slow()
    slow.wait(1)
    assert slow.begun.wait(HANG)
    slow.wait(2)
    slow.queue.stop()
    assert slow.counter.drops == 1
    assert not slow.offer(3)
    assert not slow.wait(4)
    assert slow.queue.wait_empty(moment(5))
    slow.go.set()
    slow.thread.join(HANG)
    assert slow.sent == [1]


def test_failing_send_stops_the_queue() -> None:
    slow = Slow()
    slow.fails = True
    slow.go.set()
    slow.wait(1)
    slow.thread.join(HANG)
    assert not slow.thread.is_alive()
    assert not slow.wait(2)


@pytest.mark.filterwarnings("ignore::pytest.PytestUnhandledThreadExceptionWarning")
def test_a_defect_in_sending_leaves_nobody_waiting() -> None:
    def send(packet: Packet, due: float | None) -> None:
        raise ZeroDivisionError

    queue = Queue(send, Counter(), "broken")
    assert queue.put(Packet([1]), None, 0)
    assert queue.wait_empty(moment(5))
    assert queue.thread is not None
    queue.thread.join(HANG)
    assert queue.stopped


@replaces_a_method
@pytest.mark.parametrize("verb", ["put", "push", "stop"])
def test_no_signal_handler_leaves_the_queue_locked(verb: str) -> None:
    """Its thread would wait for ever, and with it whoever closes the port."""
    tried = 0
    for one in moments():
        tried += 1
        slow = Slow()
        slow.go.set()
        with suppress(Cut), one.interrupts(cut):
            if verb == "stop":
                slow.queue.stop()
            elif verb == "put":
                slow.queue.put(Packet(1), None, 1)
            else:
                slow.queue.push(Packet(1), None, 1)

        def others(slow: Slow = slow) -> bool:
            slow.queue.stop()
            return slow.queue.stopped

        assert elsewhere(others)
        slow.thread.join(HANG)
        assert not slow.thread.is_alive()
    assert tried > 5
