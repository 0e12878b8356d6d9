"""Waits of the main thread, and the signals that end them."""

from __future__ import annotations

import signal
import sys
import threading
import time
from _thread import allocate_lock

import pytest
from support.cut import cut_at
from support.main_signal import signalled
from support.wait import HANG, inside

from yarpy.platform import waiting


class Asked(Exception):
    """What a signal handler raises."""


def test_a_lock_is_taken_or_the_time_is_over() -> None:
    lock = allocate_lock()
    assert waiting.acquire(lock)
    assert not waiting.acquire(lock, time.monotonic() - 1)
    began = time.monotonic()
    assert not waiting.acquire(lock, began + 3 * waiting.SLICE)
    assert time.monotonic() >= began + 2.9 * waiting.SLICE
    thread = inside("acquire", lock.release)
    assert waiting.acquire(lock, time.monotonic() + HANG)
    thread.join()


def test_the_time_is_over() -> None:
    began = time.monotonic()
    waiting.wait(0.0)
    waiting.wait(3 * waiting.SLICE)
    assert time.monotonic() >= began + 2.9 * waiting.SLICE


@pytest.mark.parametrize("number", ["SIGINT", "SIGTERM", "SIGBREAK"])
@pytest.mark.parametrize("what", ["acquire", "wait"])
def test_a_signal_ends_it(number: str, what: str) -> None:
    if not hasattr(signal, number):
        pytest.skip(f"{sys.platform} has no {number}")

    def asked() -> None:
        raise Asked

    lock = allocate_lock()
    lock.acquire()
    with signalled(what, getattr(signal, number), asked), pytest.raises(Asked):
        waiting.acquire(lock) if what == "acquire" else waiting.wait()


def test_an_exception_at_any_place_of_it_comes_out_as_it_is() -> None:
    """It came out as "release unlocked lock" where an Event had just let go of its own."""
    number, there = 0, True
    while there:
        number += 1
        act = lambda: waiting.wait(0.01)  # noqa: E731
        there = cut_at(number, act, "threading.py", "platform/waiting.py")
    assert number > 3


def test_an_event_happens_or_the_time_is_over() -> None:
    event = threading.Event()
    assert not waiting.happens(event, -1.0)
    began = time.monotonic()
    assert not waiting.happens(event, 3 * waiting.SLICE)
    assert time.monotonic() >= began + 2.9 * waiting.SLICE
    thread = inside("happens", event.set)
    assert waiting.happens(event, HANG)
    assert waiting.happens(event, -1.0)
    thread.join()


@pytest.mark.parametrize("number", ["SIGINT", "SIGTERM", "SIGBREAK"])
def test_the_handler_of_a_signal_may_set_an_event(number: str) -> None:
    """As that of a module does, in a thread."""
    if not hasattr(signal, number):
        pytest.skip(f"{sys.platform} has no {number}")
    event = threading.Event()
    asked = threading.Thread(target=event.set).start
    with signalled("happens", getattr(signal, number), asked):
        assert waiting.happens(event, HANG)
