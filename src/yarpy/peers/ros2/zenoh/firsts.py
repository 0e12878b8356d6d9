"""Firsts: the number of the first message of each publisher that came to a ring, read or not.

What a ring pushes out before anything of its publisher has been read would be lost without a
trace: numbers count from the publisher's beginning, and it may have published before there was a
subscription.

Rules: numbers are heard by a callback in a thread of Zenoh for as long as a publisher is there of
whom nothing has come; then the ring is alone again, and as quick. What comes while that callback
is being set up for a publisher that has just appeared is missing: never too much is counted.
"""

from __future__ import annotations

import threading
from collections.abc import Iterable
from typing import Any, Final

from yarpy.errors import DecodeError
from yarpy.peers.ros2.zenoh.attachment import parse_attachment
from yarpy.peers.ros2.zenoh.coalesced import Coalesced

MOST: Final = 1000  # publishers


class Firsts:
    """Listens to `key`; `publishers` are those who are there by now, by their GID."""

    def __init__(self, session: Any, key: str, publishers: Iterable[bytes]) -> None:
        self._session, self._key = session, key
        self._numbers: dict[bytes, int] = {}
        self._silent = set(publishers)  # nothing of them has come
        self._lock = threading.Lock()  # of these two
        self._handle: Any = None
        self._closed = False
        self._turning = threading.RLock()  # of the handle: a signal handler may close meanwhile
        self._turn = Coalesced(self._adapt, f"yarpy firsts of {key}")
        self._adapt()

    def come(self, publisher: bytes) -> None:
        """A publisher has come. Any thread may call."""
        with self._lock:
            if publisher in self._numbers or len(self._silent) >= MOST:
                return
            self._silent.add(publisher)
        self._turn()

    def leave(self, publisher: bytes) -> None:
        """A publisher has gone. Any thread may call."""
        with self._lock:
            known = publisher in self._silent
            self._silent.discard(publisher)
        if known:
            self._turn()

    def first(self, publisher: bytes, number: int) -> int:
        """Return the number of the first message of a publisher; `number` is one that has come. Any
        thread may call."""
        with self._lock:
            found = self._numbers.get(publisher)
            if found is not None:
                return min(found, number)
            if len(self._numbers) >= MOST:
                del self._numbers[next(iter(self._numbers))]
            self._numbers[publisher] = number
            if publisher in self._silent:
                self._silent.discard(publisher)
            elif self._silent:
                self._silent.pop()  # one whose messages and token have not the same GID
            over = not self._silent
        if over and self._handle is not None:
            self._turn()
        return number

    def undeclare(self) -> None:
        """Listen no more. Idempotent."""
        with self._turning:
            self._closed = True
            self._leave()

    def _adapt(self) -> None:
        """Listen, or do not."""
        from zenoh.handlers import Callback

        with self._turning:
            with self._lock:
                wanted = not self._closed and bool(self._silent or not self._numbers)
            if not wanted:
                self._leave()
            elif self._handle is None:
                hear = Callback(self._heard, indirect=False)
                self._handle = self._session.declare_subscriber(self._key, hear)

    def _leave(self) -> None:
        handle, self._handle = self._handle, None
        if handle is not None and not self._session.is_closed():
            handle.undeclare()

    def _heard(self, sample: Any) -> None:
        """In a thread of Zenoh."""
        if sample.attachment is None:
            return
        try:
            number, _, publisher = parse_attachment(bytes(sample.attachment))
        except DecodeError:
            return  # a WAKE, or what the reader will say
        self.first(publisher, number)
