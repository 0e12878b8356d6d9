"""Reader: the subscription of a port, whose messages wait in Zenoh until the port takes them.

Rules: the thread that reads waits in Zenoh itself, so a message wakes that thread alone, and none
of Zenoh's has to wait for Python. What is too much is left out there, the oldest first, and counted
by its numbers. Many messages, of which nobody knows how large they are, wait in the inbox instead,
as do those that a publisher has kept. Zenoh knows no wait with a limit: a message to ourselves ends
it, on a key below that of the topic.
"""

from __future__ import annotations

import time
from itertools import starmap
from typing import Any, Final

from yarpy.peers.ros2.carrier import Incoming
from yarpy.peers.ros2.key import Key
from yarpy.peers.ros2.zenoh.endpoint import Subscriber
from yarpy.peers.zenoh.alarm import CLOCK
from yarpy.peers.zenoh.library import CALLS

MOST: Final = 32  # messages that may wait in Zenoh
LOOK: Final = Incoming(b"")  # in the inbox: look where messages wait now
WAKE: Final = "/_wake_"  # in the keys of what ends a wait
_ONCE: Final = ((),)


class Reader(Subscriber):
    """Takes messages from its key, for one port."""

    def __init__(self, *arguments: Any) -> None:
        super().__init__(*arguments)
        self._ring: Any = None  # where messages wait in Zenoh
        self._gone: type[Exception] = Exception  # raised there once it was undeclared
        self._own = ""  # the key of what wakes us
        self._came: list[Any] = []  # the one that is being read
        self._alarm = 0.0  # when we are woken, 0: we are not
        self._reading = CALLS.new_lock()

    def subscribe(self, key: Key, kind: Any, hear: Any) -> None:
        if self._kept > MOST:
            super().subscribe(key, kind, hear)
            return
        import zenoh

        self._own = f"{key}{WAKE}{id(self)}"
        session = self.participant.session
        handle = session.declare_subscriber(f"{key}/**", zenoh.handlers.RingChannel(self._kept))
        self._handles.append(handle)
        self._gone, self._ring = zenoh.ZError, handle.handler
        self._inbox.put(LOOK)

    def receive(self, wait: bool = True) -> tuple[object] | None:
        while self._ring is None or not self._greeted:
            found = super().receive(wait)
            if found is None or found[0] is not LOOK:
                return found
        limit = self._timeout if wait else 0.0
        until = None if limit is None else time.monotonic() + limit
        while not self._over:
            try:
                sample = self._next(wait, until)
            except self._gone:  # it was undeclared, and what had come is read
                self._ring = None
                return self.receive(wait)
            item = None if sample is None else self._read(sample)
            self._came.clear()
            if item is not None:
                return (item,)
            if until is not None and time.monotonic() >= until:
                raise BlockingIOError("nothing has come")
        return None

    def _next(self, wait: bool, until: float | None) -> Any:
        """The next message, None if there is none yet. An exception out of a signal handler finds
        it in `_came`."""
        came, ring = self._came, self._ring
        if not came:
            if not wait:
                came.extend(starmap(ring.try_recv, _ONCE))
            else:
                if until is not None and not 0 < self._alarm <= until:
                    self._alarm = until
                    CLOCK.set(until, self._wake)
                with self._reading:
                    if CALLS.over:
                        self._over = True
                        return None
                    came.extend(starmap(ring.recv, _ONCE))
        return came[0]

    def _read(self, sample: Any) -> Incoming | None:
        if sample.attachment is None and WAKE in str(sample.key_expr):
            return None
        return super()._read(sample)

    def _wake(self) -> None:
        from zenoh import Locality

        self._alarm = 0.0
        try:
            with CALLS:
                session = self.participant.session
                session.put(self._own, b"", allowed_destination=Locality.SESSION_LOCAL)
        except Exception:
            pass  # the session is closed, which wakes everybody

    def interrupt(self) -> None:
        super().interrupt()
        if self._ring is not None:
            self._wake()
