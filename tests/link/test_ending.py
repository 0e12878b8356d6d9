"""Waits that end because their port does, or their time."""

from __future__ import annotations

import threading
import time

import pytest
from support.wait import HANG

from yarpy.errors import PortClosed
from yarpy.link.ending import NEVER, SLICE, Ending, left, moment
from yarpy.scope import Scope


def in_thread(act: object) -> threading.Thread:
    assert callable(act)
    thread = threading.Thread(target=act, daemon=True)
    thread.start()
    return thread


def test_an_ended_port_has_no_time_left() -> None:
    ending = Ending()
    ending.check()
    assert 0 < ending.slice(None) <= SLICE
    assert ending.slice(time.monotonic() - 1) == 0.0
    ending.begin('"/a" is closed')
    assert ending.slice(None) == 0.0
    with pytest.raises(PortClosed, match='"/a" is closed'):
        ending.check()
    ending.resume()
    ending.check()
    assert ending.slice(None)


def test_waiting_for_a_lock_ends() -> None:
    ending, lock = Ending(), threading.Lock()
    assert ending.acquire(lock)
    assert not ending.acquire(lock, moment(0.0))
    assert not ending.acquire(lock, moment(0.05))
    took: list[bool] = []
    thread = in_thread(lambda: took.append(ending.acquire(lock)))
    ending.begin("it is over")
    thread.join(HANG)
    assert took == [False]
    ending.resume()
    thread = in_thread(lambda: took.append(ending.acquire(lock)))
    lock.release()
    thread.join(HANG)
    assert took == [False, True]


def test_waiting_for_a_condition_ends() -> None:
    ending, condition = Ending(), threading.Condition()
    found: list[bool] = []

    def wait() -> None:
        with condition:
            found.append(ending.wait_for(condition, lambda: False))

    thread = in_thread(wait)
    ending.begin("it is over")
    thread.join(HANG)
    assert found == [False]
    with condition:
        assert not NEVER.wait_for(condition, lambda: False, moment(0.01))
        assert NEVER.wait_for(condition, lambda: True, moment(0.0))


def test_a_call_that_is_ended_or_late_has_no_time_left() -> None:
    ending = Ending()
    with Scope() as scope:
        assert ending.slice(None)
        with Scope(moment(-1.0)):
            assert ending.slice(None) == 0.0
        scope.end("this call alone")
        assert ending.slice(None) == 0.0
        with pytest.raises(PortClosed, match="this call alone"):
            ending.check()
    assert ending.slice(None)
    ending.check()


def test_moments() -> None:
    assert moment(None) is None and left(None) is None
    until = moment(10.0)
    assert until is not None and 9.0 < until - time.monotonic() <= 10.0
    assert left(time.monotonic() - 1) == 0.0
