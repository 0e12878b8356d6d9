"""Sending from other threads than the writer's."""

from __future__ import annotations

import threading
import time

import pytest
from support.wait import wait_until

from yarpy.errors import LinkClosed
from yarpy.link.background import GATHER_SECONDS, Background, Sweeper
from yarpy.link.counter import Counter
from yarpy.wire.message import Packet


class Slow:
    """A queue whose sending takes as long as a test wants."""

    def __init__(self) -> None:
        self.go = threading.Event()
        self.begun = threading.Event()
        self.sent: list[object] = []
        self.fails = False
        self.counter = Counter()
        self.queue = Background(self.send, self.counter)
        self.thread = threading.Thread(target=self.queue.run, daemon=True)
        self.thread.start()

    def send(self, packet: Packet) -> None:
        self.begun.set()
        assert self.go.wait(5)
        if self.fails:
            raise LinkClosed("gone")
        self.sent.append(packet.value)


def test_one_message_is_on_its_way_and_others_are_dropped() -> None:
    slow = Slow()
    assert slow.queue.put(Packet(1))
    assert slow.begun.wait(5)
    assert not slow.queue.put(Packet(2))
    assert not slow.queue.put(Packet(3))
    assert slow.counter.drops == 2
    slow.go.set()
    assert slow.queue.wait_empty(5)
    assert slow.sent == [1]
    assert slow.queue.put(Packet(4))
    assert slow.queue.wait_empty(5)
    assert slow.sent == [1, 4]
    slow.queue.stop()
    slow.thread.join(5)
    assert not slow.thread.is_alive()


def test_patient_writer_waits_for_its_turn() -> None:
    slow = Slow()
    slow.queue.wait_put(Packet(1))
    assert slow.begun.wait(5)
    slow.queue.wait_put(Packet(2))  # one may wait
    third = threading.Thread(target=slow.queue.wait_put, args=(Packet(3),), daemon=True)
    third.start()
    time.sleep(0.03)
    assert third.is_alive()
    assert not slow.queue.wait_empty(0.01)
    slow.go.set()
    third.join(5)
    assert slow.queue.wait_empty(5)
    assert slow.sent == [1, 2, 3]
    assert slow.counter.drops == 0
    slow.queue.stop()


def test_stopping_counts_what_still_waited() -> None:
    slow = Slow()
    slow.queue.wait_put(Packet(1))
    assert slow.begun.wait(5)
    slow.queue.wait_put(Packet(2))
    slow.queue.stop()
    assert slow.counter.drops == 1
    assert not slow.queue.put(Packet(3))
    assert not slow.queue.wait_put(Packet(4))
    assert slow.counter.drops == 3
    assert slow.queue.wait_empty(5)
    slow.go.set()
    slow.thread.join(5)
    assert slow.sent == [1]


def test_failing_send_stops_the_queue() -> None:
    slow = Slow()
    slow.fails = True
    slow.go.set()
    slow.queue.wait_put(Packet(1))
    slow.thread.join(5)
    assert not slow.thread.is_alive()
    assert not slow.queue.wait_put(Packet(2))


@pytest.mark.filterwarnings("ignore::pytest.PytestUnhandledThreadExceptionWarning")
def test_a_defect_in_sending_leaves_nobody_waiting() -> None:
    def send(packet: Packet) -> None:
        raise ZeroDivisionError

    queue = Background(send, Counter())
    assert queue.put(Packet([1]))
    thread = threading.Thread(target=queue.run)
    thread.start()
    assert queue.wait_empty(5)
    thread.join(5)
    assert queue.stopped


def test_sweeper_comes_soon_and_sleeps_when_nothing_is_left() -> None:
    sweeps: list[float] = []

    def sweep() -> bool:
        sweeps.append(time.perf_counter())
        return len(sweeps) < 3

    sweeper = Sweeper("sweeper", sweep)
    time.sleep(0.02)
    assert sweeps == []
    sweeper.watch()
    wait_until(lambda: len(sweeps) == 4)  # once more when it says that it sleeps
    assert sweeps[1] - sweeps[0] >= GATHER_SECONDS / 2
    time.sleep(0.02)
    assert len(sweeps) == 4
    sweeper.watch()
    wait_until(lambda: len(sweeps) == 6)
    sweeper.stop()
    sweeper.thread.join(5)
    assert not sweeper.thread.is_alive()
