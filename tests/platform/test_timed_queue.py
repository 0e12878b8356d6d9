"""A queue between threads: order, limits, and signals in every moment."""

from __future__ import annotations

import itertools
import signal
import threading
import time
from queue import Empty

import pytest
from support.wait import HANG

from yarpy.platform.timed_queue import TimedQueue

alarms = pytest.mark.skipif(
    not hasattr(signal, "setitimer"), reason="this system has no timer that sends a signal"
)


def take(queue: TimedQueue[int], timeout: float | None = None) -> list[int]:
    into: list[int] = []
    queue.take(into, timeout)
    return into


def test_first_in_first_out() -> None:
    queue: TimedQueue[int] = TimedQueue()
    assert queue.empty()
    for number in range(3):
        queue.put(number)
    assert queue.qsize() == 3
    assert take(queue, 0.0) + take(queue) + take(queue, HANG) == [0, 1, 2]
    assert queue.empty()


@pytest.mark.parametrize("timeout", [-1.0, 0.0, 0.01])
def test_nothing_came(timeout: float) -> None:
    into = [7]
    with pytest.raises(Empty):
        TimedQueue[int]().take(into, timeout)
    assert into == [7]


@pytest.mark.parametrize("timeout", [None, HANG])
def test_who_waits_is_woken(timeout: float | None) -> None:
    queue: TimedQueue[int] = TimedQueue()
    found: list[int] = []
    readers = [threading.Thread(target=queue.take, args=(found, timeout)) for _ in range(4)]
    for reader in readers:
        reader.start()
    for number in range(4):
        queue.put(number)
    for reader in readers:
        reader.join(HANG)
    assert sorted(found) == [0, 1, 2, 3]


def test_many_writers_and_readers() -> None:
    queue: TimedQueue[int] = TimedQueue()
    found: list[int] = []

    def write(first: int) -> None:
        for number in range(first, first + 200):
            queue.put(number)

    def read() -> None:
        for _ in range(200):
            queue.take(found, HANG)

    threads = [threading.Thread(target=write, args=(200 * each,)) for each in range(3)]
    threads += [threading.Thread(target=read) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(HANG)
    assert sorted(found) == list(range(600))


@alarms
def test_a_handler_that_is_busy_when_the_time_is_over() -> None:
    """`SimpleQueue.get` of Python 3.11 and 3.12 does not come back then."""
    before = signal.signal(signal.SIGALRM, lambda *_: time.sleep(0.05))
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.01)
        with pytest.raises(Empty):
            take(TimedQueue(), 0.03)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


class Alarm(Exception):
    """What the signal raises."""


@alarms
def test_an_exception_out_of_a_handler_loses_nothing() -> None:
    queue: TimedQueue[int] = TimedQueue()
    found: list[int] = []
    over = threading.Event()

    inside = [False]

    def ring(*_: object) -> None:
        if inside[0]:
            raise Alarm

    def write() -> None:
        for number in itertools.count():
            if over.is_set():
                break
            queue.put(number)
            time.sleep(0.0005)

    before = signal.signal(signal.SIGALRM, ring)
    writer = threading.Thread(target=write)
    rang = 0
    try:
        writer.start()
        while rang < 20:
            signal.setitimer(signal.ITIMER_REAL, 0.0003 + rang % 7 * 0.0002)
            try:
                inside[0] = True
                queue.take(found, HANG)
                inside[0] = False
            except Alarm:
                inside[0] = False
                rang += 1
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
        over.set()
        writer.join(HANG)
    while not queue.empty():
        queue.take(found)
    assert found == list(range(len(found)))
    assert len(queue._waiting) < 2
