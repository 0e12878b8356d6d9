"""Scopes: calls end when their time is over, or when somebody ends them."""

import math
import signal
import socket
import sys
import threading
import time
from contextlib import suppress

import pytest
from support.moments import Cut, cut, elsewhere, moments
from support.wait import HANG

from yarpy import scope
from yarpy.errors import LinkClosed, PortClosed, Timeout
from yarpy.scope import Calls, Scope, Waiter


def test_a_time_limit_that_is_never_over_is_none():
    with pytest.raises(ValueError, match="not nan"):
        scope.moment(float("nan"))
    with pytest.raises(TypeError, match="number of seconds"):
        scope.moment("1")


def test_without_a_scope_nothing_is_limited():
    assert scope.until() is None
    assert scope.until(5.0) == 5.0
    assert scope.left() == math.inf
    assert scope.left(3.0) == 3.0
    with scope.waking(lambda: pytest.fail("nobody ended anything")):
        pass
    scope.sleep(0.0)


def test_what_is_inside_has_the_time_that_is_left():
    with Scope(scope.moment(60.0)):
        assert 59.0 < scope.left() <= 60.0
        assert scope.left(1.0) == 1.0
        near = time.monotonic() + 1.0
        assert scope.until(near) == near
    assert scope.until() is None


def test_an_inner_scope_ends_no_later():
    with Scope(10.0) as outer:
        with Scope(20.0) as inner:
            assert inner.until == 10.0
        with Scope(5.0) as inner:
            assert inner.until == 5.0
        with Scope() as inner:
            assert inner.until == 10.0
        assert outer.until == 10.0


def test_time_that_is_over_is_a_timeout():
    with Scope(time.monotonic()), pytest.raises(Timeout):
        scope.left(1.0)


def test_code_of_the_program_is_outside():
    with Scope(time.monotonic()):
        with scope.outside():
            assert scope.left(1.0) == 1.0
        with pytest.raises(Timeout):
            scope.left(1.0)


def test_ending_wakes_what_blocks():
    one, other = socket.socketpair()
    with one, other:
        call = Scope()
        waiting = threading.Event()

        def end():
            waiting.wait()
            call.end("it was enough")

        threading.Thread(target=end).start()
        with (
            pytest.raises(PortClosed, match="it was enough"),
            call,
            scope.waking(lambda: one.shutdown(socket.SHUT_RDWR)),
        ):
            waiting.set()
            if not one.recv(1):
                raise LinkClosed("the other side went away")


def test_a_scope_that_ended_does_not_begin():
    call = Scope()
    call.end("too late")
    with pytest.raises(PortClosed, match="too late"), call:
        pytest.fail("it began")
    assert scope.until() is None


def test_what_ended_before_it_blocks_is_not_waited_for():
    woken = []
    with pytest.raises(PortClosed), Scope() as call:
        call.end()
        with scope.waking(lambda: woken.append(1)):
            pytest.fail("nobody wakes this any more")
    assert not woken


def test_what_is_over_is_not_woken():
    woken = []
    with Scope() as call:
        with scope.waking(lambda: woken.append(1)):
            pass
        call.end()
    assert not woken


def test_an_outer_scope_ends_what_is_inside():
    woken = []
    outer = Scope()
    with pytest.raises(PortClosed), outer, Scope():
        with scope.waking(lambda: woken.append(1)):
            outer.end("all of it")
        scope.left()
    assert woken == [1]


def test_other_errors_are_left_alone():
    with pytest.raises(ZeroDivisionError), Scope() as call:
        call.end()
        raise ZeroDivisionError
    with pytest.raises(LinkClosed), Scope():
        raise LinkClosed("nobody ended this")


def test_the_calls_of_a_port_end_together():
    calls, waiter = Calls(), Waiter()
    begun, ended = threading.Barrier(3), []

    def wait(call, waiter):
        begun.wait()
        waiter.wait()

    def call():
        with calls.scope(60.0) as scope:
            wait(scope, Waiter())

    def run():
        calls.run(60.0, wait, Waiter())

    def end(call):
        try:
            call()
        except PortClosed as error:
            ended.append(str(error))
            waiter.wake()

    threads = [threading.Thread(target=end, args=(begin,)) for begin in (call, run)]
    for thread in threads:
        thread.start()
    begun.wait()
    calls.end("interrupted")
    for thread in threads:
        thread.join(HANG)
    assert ended == ["interrupted"] * 2
    with calls.scope(1.0):
        assert scope.left() <= 1.0  # a port that was interrupted may go on
    calls.end("closed", last=True)
    with pytest.raises(PortClosed, match="closed"), calls.scope():
        pytest.fail("it began")
    with pytest.raises(PortClosed, match="closed"):
        calls.run(None, lambda call, _: pytest.fail("it began"), None)
    assert not calls.running


def test_a_call_that_is_run_is_a_scope():
    calls = Calls()

    def look(call, word):
        assert scope._CURRENT.get() is call and call.until == scope.until()
        return word

    assert calls.run(None, look, "answer") == "answer"
    assert scope.until() is None
    with Scope(10.0) as outer:
        assert calls.run(60.0, lambda call, _: call.until, None) == 10.0
        assert not outer.wakers
        with pytest.raises(PortClosed, match="all of it"):
            calls.run(60.0, lambda call, _: (outer.end("all of it"), call.check()), None)
    with pytest.raises(ZeroDivisionError):
        calls.run(None, lambda call, _: 1 / 0, None)
    with pytest.raises(LinkClosed):
        calls.run(None, _fail, None)
    with pytest.raises(PortClosed, match="in between"):
        calls.run(None, lambda call, _: (call.end("in between"), _fail()), None)
    assert not calls.running


def _fail(*_):
    raise LinkClosed("the other side went away")


def test_a_waiter_is_woken_also_by_what_happened_before():
    waiter = Waiter()
    waiter.wake()
    waiter.wake()
    waiter.wait(60.0)
    begun = time.monotonic()
    waiter.wait(0.01)
    assert time.monotonic() - begun >= 0.01


def test_a_waiter_waits_no_longer_than_its_call():
    with Scope(scope.moment(0.02)):
        Waiter().wait()
        with pytest.raises(Timeout):
            scope.left()


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="this system has no interval timers")
def test_a_signal_handler_ends_the_call_beneath_it():
    call = Scope()
    before = signal.signal(signal.SIGALRM, lambda *_: call.end("by a signal"))
    try:
        with pytest.raises(PortClosed, match="by a signal"), call:
            signal.setitimer(signal.ITIMER_REAL, 0.02)
            scope.sleep(60.0)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


class Interrupted(Exception):
    """What a signal handler raises."""


def test_a_signal_handler_that_raises_leaves_no_scope_behind():
    calls = Calls()

    @scope.apart
    def call():
        with calls.scope(60.0), Scope(scope.moment(5.0)) as inner:
            inner.end("long ago")
            with scope.outside(), scope.waking(lambda: None):
                scope.until()

    def run():
        calls.run(60.0, lambda call, _: call.check(), None)

    for function in (call, run):
        _interrupt_everywhere(function, calls)


def _interrupt_everywhere(call, calls):
    steps = 0
    while _interrupted(call, steps):
        steps += 1
        assert scope._CURRENT.get() is None, f"step {steps}"
        with calls.scope(60.0) as next_one:
            assert next_one.until is not None
            scope.check()
    assert steps > 100
    assert len(calls.running) < 100


def _interrupted(call, step):
    """Call it, and raise Interrupted before that step of scope.py; return whether there is one."""
    count = -1

    def trace(frame, event, argument):
        nonlocal count
        if frame.f_code.co_filename != scope.__file__:
            return None
        frame.f_trace_opcodes = True
        if event in ("call", "opcode"):
            count += 1
            if count == step:
                raise Interrupted
        return trace

    before = sys.gettrace()
    sys.settrace(trace)
    try:
        call()
    except Interrupted:
        return True
    finally:
        sys.settrace(before)
    return False


def test_a_flag_is_seen_by_all_who_wait() -> None:
    flag, seen = scope.Flag(), []
    assert not flag.wait(0.01)
    threads = [threading.Thread(target=lambda: seen.append(flag.wait(HANG))) for _ in range(3)]
    for thread in threads:
        thread.start()
    flag.set()
    flag.set()
    for thread in threads:
        thread.join()
    assert seen == [True] * 3 and flag.is_set and flag.wait(0.0)


@pytest.mark.parametrize("verb", ["set", "wait"])
def test_no_signal_handler_leaves_a_flag_locked(verb: str) -> None:
    tried = 0
    for moment in moments():
        tried += 1
        flag = scope.Flag()
        if verb == "wait":
            flag.set()
        with suppress(Cut), moment.interrupts(cut):
            getattr(flag, verb)()

        def others(flag: scope.Flag = flag) -> bool:
            flag.set()
            return flag.wait(HANG)

        assert elsewhere(others)
    assert tried > 1
