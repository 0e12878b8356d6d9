"""Driver: pumps a protocol's generators against a transport.

Rules: the only place where bytes go from one to the other, and where foreign errors become ours.
One thread at a time uses a driver; the link decides which. No protocol is known here. What differs
between bytes and whole objects is in `byte_driver.py` and `object_driver.py`; where a connection
that is only beginning moves to, in `begin/greeting.py`.
"""

from __future__ import annotations

import errno
import time
from typing import Any, ClassVar, Final, TypeVar

from yarpy.errors import LinkClosed, LocalProtocolError, RemoteProtocolError, Timeout, YarpError
from yarpy.link.begin.admission import Admission, Rival, Room, any_number, no_rival
from yarpy.link.ending import NEVER
from yarpy.link.receive.incoming import Incoming
from yarpy.transports.base import Transport
from yarpy.wire.effects import BE_CALLED, HEAR, SEND_DATAGRAMS, Claim, May, Within
from yarpy.wire.framing import REFUSED
from yarpy.wire.steps import Effect, Steps
from yarpy.wire.stream import ByteStream

T = TypeVar("T")

SHORT: Final = 0.25  # seconds of a wait that ends when it should


class Driver:
    """A transport and the stream in front of it. `pushes`: something may leave by `push`."""

    pushes: ClassVar[bool] = True

    def __init__(self, transport: Transport, stream: ByteStream) -> None:
        self.transport = transport
        self.stream = stream
        self.admission = Admission()  # what the peer may do with our port
        self.silence = ""  # why nobody can hear what our port writes: it never writes
        self.room: Room = any_number  # why another sender of datagrams finds no place
        self.rival: Rival = no_rival  # why another sender of that name is not taken
        # Whether a wait that an exception out of a signal handler has ended has lost nothing.
        self.whole = transport.whole
        self.ending = NEVER  # whom those obey who wait here to send
        self.bytes_in = 0
        self.bytes_out = 0
        # Of these, what did not go through the transport; the window resets it.
        self.aside = 0
        self._part = False  # the wait ends before its deadline: there is a second one
        # Deadlines limit the transport's own waits, instead of being waited for beside it.
        self._arms = True

    def run(
        self, steps: Steps[T], deadline: float | None = None, incoming: Incoming | None = None
    ) -> T:
        """Run `steps` to its end, waiting for bytes as needed; what it wrote is sent.

        `deadline` is a time of `time.monotonic`. `incoming`: they read a message, which must come
        along once it has begun. Raises Timeout, LinkClosed, or what the steps raise.
        """
        answer: Any = None
        before = self.bytes_in - self.stream.waiting
        try:
            while True:
                effect = steps.send(answer)
                if effect is None:
                    self.flush()
                    try:
                        if incoming is not None and self.bytes_in > before:
                            incoming.advance(self.bytes_in - before)
                            if deadline is None:
                                self.transport.limit_waiting(incoming.silence, sends=False)
                        self.fill(deadline)
                    except Timeout as error:
                        if incoming is not None and deadline is None:
                            incoming.wait()
                        told = self.tell_late(steps, error)
                        if told is error:
                            raise
                        raise told from error
                    answer = None
                elif isinstance(effect, Within):
                    deadline = sooner(deadline, effect.seconds)
                    answer = None
                elif isinstance(effect, May | Claim):
                    answer = self.judge(effect)
                else:
                    raise not_here(steps, effect)
        except StopIteration as stop:
            self.flush()
            value: T = stop.value
            return value
        except LinkClosed as error:
            if incoming is not None and incoming.reason:
                raise RemoteProtocolError(incoming.reason) from error
            raise
        finally:
            if deadline is not None:
                self.disarm()
            if incoming is not None:
                if incoming.since and deadline is None:
                    self.transport.limit_waiting(None, sends=False)
                incoming.since = 0.0

    def tell_late(self, steps: Steps[Any], error: Timeout) -> YarpError:
        """Let a protocol that waits say goodbye to a peer that was too slow; the error that it ends
        with, nearly always `error` itself."""
        told: YarpError = error
        try:
            steps.throw(error)
        except StopIteration:
            pass
        except YarpError as other:
            told = other
        try:
            self.flush()
        except YarpError:
            pass  # nobody listens
        return told

    def judge(self, effect: May | Claim) -> str | bool | None:
        """Answer what a protocol asks about its peer's rights."""
        if isinstance(effect, May):
            if effect.right == SEND_DATAGRAMS:
                return self.room(self.admission.peer)
            if effect.right == BE_CALLED:
                return self.rival(effect.name)
            if effect.right == HEAR:
                return self.judge(May("read", effect.asking)) or self.silence
            if effect.asking:
                return "" if self.admission.allows(effect.right) else REFUSED
            return self.admission.refusal(effect.right)
        if not self.admission.takes_tokens:
            return None
        admission = self.admission.showing(effect.token, effect.public_key)
        if admission is None:
            return False
        self.admission = admission
        return True

    # -- sending ----------------------------------------------------------------------------------

    def push(self) -> bool:
        """Send what waits if that takes one call and no waiting; return whether all has left.

        An exception out of a signal handler, at any time, leaves it sent or not sent. Raises
        LinkClosed.
        """
        raise NotImplementedError

    def send(self, until: float | None = None) -> bool:
        """Send what the protocol wrote; return False if `until` (of time.monotonic; 0.0: no
        waiting) comes first, or the port's end. What is left then stays in the stream, and leaves
        before anything else. Raises LinkClosed."""
        raise NotImplementedError

    def flush(self, deadline: float | None = None) -> None:
        """Send what the protocol wrote. Raises Timeout where `send` returns False."""
        if not self.send(deadline):
            raise Timeout("the peer does not read what is sent")

    # -- receiving --------------------------------------------------------------------------------

    def fill(self, deadline: float | None = None) -> None:
        """Wait for more, or the end, and put it into the stream.

        An exception out of a signal handler, at any time, loses nothing where the transport is
        `whole`: what has come by then is put into the stream next time. Raises Timeout, LinkClosed.
        """
        raise NotImplementedError

    def try_fill(self) -> bool:
        """Take what is there already; return False if there is nothing."""
        raise NotImplementedError

    def fill_by(self, until: float | None) -> bool:
        """As `fill`; return False if `until` comes first, or the port's end."""
        try:
            while wait := self.ending.slice(until):
                if self._arms:
                    self.transport.limit_waiting(wait, sends=False)
                try:
                    self.fill(None if self._arms else time.monotonic() + wait)
                except Timeout:
                    continue
                return True
            return False
        finally:
            if self._arms:
                self.transport.limit_waiting(None, sends=False)

    def disarm(self) -> None:
        """Take back the limit that deadlines have put on the transport's waits."""
        if self._arms:
            self.transport.limit_waiting(None)

    def close(self) -> list[object]:
        """Close the transport; return the objects that had come, and that nobody has read."""
        self.transport.close()
        return []

    def _limit(self, deadline: float) -> bool:
        """Limit the next wait; return False if no time is left."""
        left = deadline - time.monotonic()
        if left > 0:
            # Linux is late by an eighth of a long wait, so the last of it is a wait of its own.
            self._part = left >= SHORT
            self.transport.limit_waiting(0.875 * left if self._part else left)
        return left > 0

    def _waits_on(self, error: OSError, deadline: float | None) -> bool:
        """Raise what the error that ended a wait means; return whether the rest of a wait follows.
        False: a reset, which is an end as any other."""
        if isinstance(error, YarpError) or is_foreign(error):
            raise error
        if isinstance(error, BlockingIOError | TimeoutError) or is_dead(error):
            late = isinstance(error, BlockingIOError) and deadline is not None
            if late and self._part and time.monotonic() < (deadline or 0.0):
                return True
            raise link_error(error, "the peer is silent") from error
        self.transport.failed(error)
        return False


def sooner(deadline: float | None, seconds: float | None) -> float | None:
    """Return the earlier of a deadline and one in so many seconds; None: there is no such."""
    own = None if seconds is None else time.monotonic() + seconds
    return own if deadline is None else deadline if own is None else min(deadline, own)


def not_here(steps: Steps[Any], effect: Effect) -> LocalProtocolError:
    """Tell a protocol that nobody does here what it asks for; return the error to raise."""
    error = LocalProtocolError(f"{effect} is not something a connection can do")
    steps.throw(error)  # it may tell its peer before it fails itself
    return error


def is_foreign(error: OSError) -> bool:
    """Return whether an error comes from the program, out of a signal handler (`TimeoutError` is
    usual), and not from the system or a transport."""
    known = isinstance(error, BlockingIOError | ConnectionError) or type(error) is OSError
    return error.errno is None and not known


def is_dead(error: OSError) -> bool:
    """Return whether the peer's host gives no answer any more (`transports/peer_timeout.py`)."""
    return error.errno in (errno.ETIMEDOUT, errno.EHOSTUNREACH, errno.ENETUNREACH)


def link_error(error: OSError, late: str = "the peer does not read what is sent") -> YarpError:
    """Return our error for what the operating system says about a connection; `late`: when it says
    that the time is over."""
    if isinstance(error, YarpError):
        return error
    if is_dead(error):
        return LinkClosed(f"the peer's host does not answer any more ({error.strerror})")
    if isinstance(error, BlockingIOError | TimeoutError):
        return Timeout(late)
    return LinkClosed(f"the peer is gone ({error.strerror or error})")
