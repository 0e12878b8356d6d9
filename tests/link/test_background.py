"""Sending from other threads than the writer's."""

from __future__ import annotations

import threading
import time

import pytest
from support.transport import scripted
from support.wait import wait_until

from yarpy.carriers.tcp import FastTcp
from yarpy.errors import LinkClosed
from yarpy.link.background import GATHER_SECONDS, Background, Sweeper
from yarpy.link.outbound import Outbound
from yarpy.route import Route
from yarpy.wire.message import Packet


class Slow:
    """A link whose sending takes as long as a test wants."""

    def __init__(self) -> None:
        self.link = Outbound(scripted(open_ended=True)[0], FastTcp(Route("/a", "/b", "fast_tcp")))
        self.go = threading.Event()
        self.begun = threading.Event()
        self.sent: list[object] = []
        self.fails = False
        self.link.send_now = self.send  # type: ignore[method-assign]
        self.queue = Background(self.link)
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
    assert slow.link.counter.drops == 2
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
    assert slow.link.counter.drops == 0
    slow.queue.stop()


def test_stopping_counts_what_still_waited() -> None:
    slow = Slow()
    slow.queue.wait_put(Packet(1))
    assert slow.begun.wait(5)
    slow.queue.wait_put(Packet(2))
    slow.queue.stop()
    assert slow.link.counter.drops == 1
    assert not slow.queue.put(Packet(3))
    with pytest.raises(LinkClosed):
        slow.queue.wait_put(Packet(4))
    assert slow.link.counter.drops == 3
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
    with pytest.raises(LinkClosed):
        slow.queue.wait_put(Packet(2))


def test_sweeper_comes_soon_and_sleeps_when_nothing_is_left() -> None:
    driver, _ = scripted(open_ended=True)
    link = Outbound(driver, FastTcp(Route("/a", "/b", "fast_tcp")))
    sweeps: list[float] = []
    link.sweep = lambda timeout=None: bool(  # type: ignore[method-assign]
        sweeps.append(time.perf_counter()) or True
    )
    sweeper = Sweeper(link)
    time.sleep(0.02)
    assert sweeps == []
    link.left = time.perf_counter()
    started = time.perf_counter()
    sweeper.watch()
    wait_until(lambda: sweeps)
    assert sweeps[0] - started < 100 * GATHER_SECONDS
    wait_until(lambda: sweeper._asleep)
    time.sleep(0.005)
    count = len(sweeps)
    time.sleep(0.02)
    assert len(sweeps) == count
    link.broken = True
