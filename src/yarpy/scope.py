"""Scope: until when the call that a thread is in may take, and what ends it before.

    with calls.scope(timeout):
        ...                         # whatever blocks here is over when the time is, or the port

Rules: a public method that may block opens one scope, and computes there, once, the moment
(of time.monotonic()) until which it may take; None never comes. Whatever blocks below asks `left`
for its time limit, and blocks inside `waking(wake)`, where `wake` makes it return at once. A scope
inside another one ends with it. Ending takes no lock: a signal handler may do it, in any frame.
Callbacks of a program are called `outside` of every scope. A signal handler may raise where a
scope begins or ends, so that it is never left: a public function that opens one runs `apart`, in a
context which is gone with the call, however that ends.
"""

from __future__ import annotations

import math
import time
from _thread import LockType, allocate_lock
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar, Token, copy_context
from functools import wraps
from types import TracebackType
from typing import Final, ParamSpec, Self, TypeVar
from weakref import ReferenceType, ref

from yarpy.errors import PortClosed, Timeout, YarpError
from yarpy.platform.waiting import acquire

A = TypeVar("A")
P = ParamSpec("P")
T = TypeVar("T")
Wake = Callable[[], object]

AGAIN: Final = 0.05  # seconds until who waits for a Flag looks by itself
_MANY: Final = 64  # calls of one port; some of them may be none

# Seconds that a call takes at most, where the program does not say.
OPENING: Final = 5.0  # a port
CONNECTING: Final = 5.0  # two ports, or ending that
ASKING: Final = 3.0  # a port, or a name server, for what it answers by itself

_CURRENT: Final[ContextVar[Scope | None]] = ContextVar("yarpy scope", default=None)


def moment(timeout: float | None) -> float | None:
    """Return when `timeout` seconds from now are over; None for no limit. Raises TypeError for what
    is no number, and ValueError for `nan`, which is never over."""
    if timeout is None:
        return None
    try:
        if timeout != timeout:
            raise ValueError("a time limit is a number of seconds or None, not nan")
        return time.monotonic() + timeout
    except TypeError:
        raise TypeError(f"a time limit is a number of seconds or None, not {timeout!r}") from None


def apart(function: Callable[P, T]) -> Callable[P, T]:
    """Let every call of `function` leave the scope of its caller as it was, also where a signal
    handler raises in it. Only code of the interpreter, which no handler cuts, begins and ends its
    context; so what it sets in context variables is not seen by the caller."""

    @wraps(function)
    def call(*args: P.args, **kwargs: P.kwargs) -> T:
        return copy_context().run(function, *args, **kwargs)

    return call


class Scope:
    """One call under way. `until`: when its time is over, or sooner if that of the scope around it
    is. `ended`: the reason why it, or one around it, was ended; "" as long as it was not. `calls`:
    those of the port that it belongs to. Raises PortClosed on entry if it has ended.

    `wakers`: what makes a thread return that blocks in it; of `waking`, and of scopes within.
    `wake`: the same of the function that the call is, at no cost. Who puts one there looks at
    `ended` afterwards: whoever ends it looks the other way round.
    """

    __slots__ = ("__weakref__", "_calls", "_outer", "_token", "ended", "until", "wake", "wakers")

    def __init__(self, until: float | None = None, calls: Calls | None = None) -> None:
        self.until = until
        self.ended = ""
        self.wake: Wake | None = None
        self.wakers: dict[int, Wake] = {}
        self._calls = calls
        self._outer: Scope | None = None
        self._token: Token[Scope | None] | None = None

    def end(self, reason: str = "the call was ended") -> None:
        """Wake the call, which raises PortClosed with this reason. From any thread, and from signal
        handlers."""
        self.ended = self.ended or reason
        wake = self.wake
        if wake is not None:
            wake()
        for wake in tuple(self.wakers.values()):
            wake()

    def check(self) -> None:
        """Raise PortClosed once it was ended."""
        if self.ended:
            raise PortClosed(self.ended)

    def __enter__(self) -> Self:
        calls, outer, key = self._calls, _CURRENT.get(), id(self)
        if calls is not None:
            calls.running[key] = ref(self)
            if len(calls.running) > _MANY:
                calls.forget_cut()
            # Behind that, for the port may end at any moment: it sees the scope, or we see its end.
            if calls.over:
                self.ended = calls.over
        try:
            if outer is not None:
                self.lie_in(outer)
            if self.ended:
                raise PortClosed(self.ended)
            self._token = _CURRENT.set(self)
        except BaseException:
            self._leave()
            raise
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        token, self._token = self._token, None
        assert token is not None
        _CURRENT.reset(token)
        if self._calls is not None or self._outer is not None:
            self._leave()
        # What a call met that was woken is not what has happened.
        if error is not None and self.ended and is_of_waking(error):
            raise PortClosed(self.ended) from None

    def lie_in(self, outer: Scope) -> None:
        """End with the scope around it, and no later."""
        self._outer = outer
        if outer.until is not None:
            self.until = outer.until if self.until is None else min(self.until, outer.until)
        outer.wakers[id(self)] = self._end_too
        if outer.ended:
            self._end_too()

    def _end_too(self) -> None:
        if self._outer is not None:
            self.end(self._outer.ended)

    def _leave(self) -> None:
        """Be forgotten by the port and by the scope around it."""
        key = id(self)
        if self._calls is not None:
            self._calls.running.pop(key, None)
        if self._outer is not None:
            self._outer.wakers.pop(key, None)


def is_of_waking(error: BaseException) -> bool:
    """Return whether a call may meet this error because it was woken."""
    return isinstance(error, YarpError | OSError) and not isinstance(error, PortClosed)


class Calls:
    """The calls of one port that are under way, and whether more may begin."""

    __slots__ = ("over", "running")

    def __init__(self) -> None:
        # Not kept alive, but by `run`: of one that a signal handler has cut nobody takes it out.
        self.running: dict[int, Scope | ReferenceType[Scope]] = {}
        self.over = ""  # why no more may begin

    def scope(self, timeout: float | None = None) -> Scope:
        """A scope for a call of the port, of so many seconds at most."""
        return Scope(None if timeout is None else moment(timeout), self)

    def run(self, timeout: float | None, function: Callable[[Scope, A], T], argument: A) -> T:
        """Return function(scope, argument), which runs `apart`, in a scope of so many seconds at
        most: as a `scope` around it, in a third of the steps, for calls that are made often."""
        call = Scope(None if timeout is None else moment(timeout), self)
        outer, context, key = _CURRENT.get(), copy_context(), id(call)
        context.run(_CURRENT.set, call)
        try:
            self.running[key] = call
            if len(self.running) > _MANY:
                self.forget_cut()
            if self.over:  # behind that, see Scope
                call.ended = self.over
            if outer is not None:
                call.lie_in(outer)
            if call.ended:
                raise PortClosed(call.ended)
            return context.run(function, call, argument)
        except BaseException as error:
            if call.ended and is_of_waking(error):
                raise PortClosed(call.ended) from None
            raise
        finally:
            self.running.pop(key, None)  # the first call: a signal handler may raise behind it
            if outer is not None:
                outer.wakers.pop(key, None)

    def end(self, reason: str, last: bool = False) -> None:
        """End every call that is under way; with `last` also those that begin later."""
        if last:
            self.over = self.over or reason
        for found in tuple(self.running.values()):
            scope = found if isinstance(found, Scope) else found()
            if scope is not None:
                scope.end(reason)

    def forget_cut(self) -> None:
        """Forget the calls that have ended without leaving their scope."""
        for key, found in tuple(self.running.items()):
            if not isinstance(found, Scope) and found() is None:
                self.running.pop(key, None)


@contextmanager
def outside() -> Iterator[None]:
    """Let the block be in no scope: it is code of the program, with calls of its own."""
    token = _CURRENT.set(None)
    try:
        yield
    finally:
        _CURRENT.reset(token)


def until(own: float | None = None) -> float | None:
    """Return when the call under way has to be over: the sooner of its end and `own`."""
    scope = _CURRENT.get()
    if scope is None or scope.until is None:
        return own
    return scope.until if own is None else min(own, scope.until)


def ended() -> str:
    """Return the reason why the call under way was ended; "" as long as it was not."""
    scope = _CURRENT.get()
    return "" if scope is None else scope.ended


def check() -> None:
    """Raise PortClosed once the call under way was ended."""
    scope = _CURRENT.get()
    if scope is not None and scope.ended:
        raise PortClosed(scope.ended)


def left(most: float = math.inf) -> float:
    """Return the seconds that the call under way has left, `most` at most. Raises Timeout if none
    are, PortClosed if the call was ended."""
    scope = _CURRENT.get()
    if scope is None:
        return most
    if scope.ended:
        raise PortClosed(scope.ended)
    if scope.until is None:
        return most
    seconds = scope.until - time.monotonic()
    if seconds <= 0.0:
        raise Timeout("the time for this call is over: whoever was asked is silent")
    return min(most, seconds)


def remaining() -> float:
    """Return the seconds that the call under way has left, 0.0 if none are; math.inf for no limit.
    For what is done in any case, and may then only not wait."""
    limit = until()
    return math.inf if limit is None else max(0.0, limit - time.monotonic())


class waking:  # noqa: N801  (it is used as a function; a generator would take twice as long)
    """Call `wake` if the call under way is ended while the block runs: it makes what blocks there
    return. Raises PortClosed before the block if it was ended already."""

    __slots__ = ("_scope", "_wake")

    def __init__(self, wake: Wake) -> None:
        self._wake = wake
        self._scope = _CURRENT.get()

    def __enter__(self) -> None:
        scope = self._scope
        if scope is not None:
            if scope.ended:
                raise PortClosed(scope.ended)
            scope.wakers[id(self)] = self._wake
            if scope.ended:
                self._wake()

    def __exit__(self, *error: object) -> None:
        if self._scope is not None:
            self._scope.wakers.pop(id(self), None)


class Waiter:
    """A thread that waits until something changes, or its call is over. `wake` takes no lock, so a
    signal handler may call it."""

    __slots__ = ("_lock",)

    def __init__(self) -> None:
        self._lock: LockType = allocate_lock()
        self._lock.acquire()

    def wake(self) -> None:
        """Let the thread look again."""
        try:
            self._lock.release()
        except RuntimeError:
            pass  # it is awake

    def wait(self, seconds: float | None = None) -> None:
        """Wait until `wake` was called since the last time, or `seconds` are over, or the call that
        this thread is in. Raises PortClosed if that was ended."""
        scope = _CURRENT.get()
        limit = until(moment(seconds))
        if scope is not None:
            scope.wakers[id(self)] = self.wake
            if scope.ended:
                self.wake()
        try:
            acquire(self._lock, limit)
        finally:
            if scope is not None:
                scope.wakers.pop(id(self), None)
        if scope is not None and scope.ended:
            raise PortClosed(scope.ended)


class Flag:
    """Something that happens once, which any number of threads may wait for. `is_set`: it has.

    An Event of Python has a lock that a signal handler's exception may leave locked, for ever.
    """

    __slots__ = ("_lock", "is_set")

    def __init__(self) -> None:
        self.is_set = False
        self._lock: LockType = allocate_lock()
        self._lock.acquire()

    def set(self) -> None:
        """Let it happen."""
        self.is_set = True
        try:
            self._lock.release()
        except RuntimeError:
            pass  # it had happened

    def wait(self, seconds: float | None = None) -> bool:
        """Wait until it has happened, or `seconds` are over; return whether it has."""
        limit = moment(seconds)
        while not self.is_set:
            left = AGAIN if limit is None else min(limit - time.monotonic(), AGAIN)
            if left <= 0.0:
                break
            if self._lock.acquire(timeout=left):
                self._lock.release()  # for whoever else waits; if this is cut, they look AGAIN
        return self.is_set


def sleep(seconds: float) -> None:
    """As time.sleep, but no longer than the call under way may take. Raises PortClosed if that is
    ended meanwhile."""
    if _CURRENT.get() is None:
        time.sleep(seconds)
    else:
        Waiter().wait(seconds)
