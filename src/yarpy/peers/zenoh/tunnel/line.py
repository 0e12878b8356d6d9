"""The operations of Zenoh that one end of a pipe uses: `pipe.Line`, over a real session.

Rules: nothing waits for more to come. No call may be under way in Zenoh when the interpreter ends
(`CALLS`), except one of the main thread.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from yarpy.log import logger
from yarpy.peers.zenoh.library import CALLS, ENDING, load
from yarpy.peers.zenoh.tunnel.pipe import MESSAGES, WAKE

if TYPE_CHECKING:
    import zenoh

log = logger("yarpy.zenoh")


class ZenohLine:
    """The operations of a session that a pipe uses; `own` and `other` are its two ends, as ends of
    keys.

    Nothing is dropped on the way, and nothing waits for more to come. `left` is called when the
    pipe is closed.
    """

    def __init__(self, session: zenoh.Session, own: str, other: str) -> None:
        library = self._library = load()
        self._session = session
        self._own = f"@yarp/pipe/{own}"
        self._other = other
        self.left: Callable[[], object] = lambda: None
        # What would be too much is dropped, which is noticed: a thread of Zenoh must not wait.
        self._subscriber = session.declare_subscriber(
            self._own, library.handlers.RingChannel(MESSAGES + 16)
        )
        self._recv, self._try_recv = self._subscriber.recv, self._subscriber.try_recv
        self._publisher: Any = None
        self._reading, self._writing = CALLS.new_lock(), CALLS.new_lock()
        self.prefer("DATA")

    def prefer(self, priority: str) -> None:
        before = self._publisher
        self._publisher = self._session.declare_publisher(
            f"@yarp/pipe/{self._other}",
            congestion_control=self._library.CongestionControl.BLOCK,
            priority=getattr(self._library.Priority, priority),
            express=True,
        )
        self._put = self._publisher.put
        if before is not None:
            undeclare(before)

    def put(self, data: bytes | bytearray) -> None:
        with self._writing:
            if CALLS.over:
                raise ConnectionAbortedError(ENDING)
            self._put(data)

    def tell(self, data: bytes) -> None:
        with CALLS:
            self._session.put(
                f"@yarp/ctl/{self._other}",
                data,
                congestion_control=self._library.CongestionControl.BLOCK,
                express=True,
            )

    def wake(self) -> None:
        local = self._library.Locality.SESSION_LOCAL
        if threading.current_thread() is threading.main_thread():  # also when the program ends
            self._session.put(self._own, bytes([WAKE]), allowed_destination=local)
        else:
            with CALLS:
                self._session.put(self._own, bytes([WAKE]), allowed_destination=local)

    def recv(self) -> bytes:
        with self._reading:
            if CALLS.over:
                raise ConnectionAbortedError(ENDING)
            data: bytes = self._recv().payload.to_bytes()
        return data

    def try_recv(self) -> bytes | None:
        sample = self._try_recv()  # which holds Python's lock all the time
        return None if sample is None else sample.payload.to_bytes()

    def close(self) -> None:
        undeclare(self._subscriber)
        undeclare(self._publisher)
        self.left()


def undeclare(thing: Any) -> None:
    """Take back what was declared; nothing, if the session is closed."""
    try:
        with CALLS:
            thing.undeclare()
    except Exception as error:
        log.debug("not undeclared: %s", error)
