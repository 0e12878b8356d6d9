"""LogCollector: takes the lines of all programs that log, and counts what it loses.

Rules: every second it looks for ports that log and asks them to send here; a program that came back
is asked again. Lines wait in memory, a limited number of them, for whoever reads them; what comes
beyond that replaces the oldest, and is counted. What a program tells again, since it was asked
again, is left out. What the threads of connections do with a line is to put it down and no more:
under a flood they take turns, and what they take of the processor is missing to whoever reads.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any, Final, TypeAlias

import yarpy
from yarpy.kits.launch.log.filter import matches
from yarpy.limit import LOG_ORIGINS, LOG_WAITING, LOG_WAITING_BYTES
from yarpy.names.base import NameClient
from yarpy.port.keep.log_line import LogLine, read_message
from yarpy.scope import Waiter
from yarpy.wire.message import Message

PARTS: Final = ("/log/", "/yarprunlog/")  # of the names of ports that log
PERIOD: Final = 1.0  # seconds between looks for more of them
AGAIN: Final = 1024  # lines of a program that are known when they come again
_BATCH: Final = 2000  # lines read at a time
_BYTES: Final = (memoryview, bytes, bytearray, str)

Open: TypeAlias = Callable[[Callable[[Message[Any]], None]], yarpy.Port[Any]]


@dataclass(slots=True)
class _Origin:
    """The last entries of a program: when the newest was, and marks of the last AGAIN at least."""

    time: float = 0.0
    known: set[int] = field(default_factory=set)
    older: set[int] = field(default_factory=set)


class LogCollector:
    """Takes lines of the ports that match `pattern`, at the port that `open_` opens with the
    callback that it is handed."""

    def __init__(self, open_: Open, pattern: str = "", names: NameClient | None = None) -> None:
        self._pattern, self._names = pattern, names
        self.taken = 0  # messages
        self.lost = 0  # messages that nobody read in time
        self._waiting: deque[Message] = deque()
        self._bytes = 0
        self._lock = threading.Lock()  # of these four
        # Whoever reads is often a main thread, and an Event has a lock that an exception out of a
        # signal handler may leave locked.
        self._news = Waiter()
        self._done = threading.Event()
        self._origins: dict[str, _Origin] = {}
        self.joined = 0  # looks for ports that were finished
        self.port = open_(self._hear)
        self._thread = threading.Thread(
            target=self._join, name=f"{self.port.name} looks for logs", daemon=True
        )
        self._thread.start()

    def read(self, timeout: float | None = None) -> list[tuple[LogLine, Message]]:
        """Return the lines that wait, some thousands at most, each with its message; wait for one,
        for so many seconds. Empty: none came, or the port is closed."""
        until = None if timeout is None else time.monotonic() + timeout
        while True:
            messages = self._some()
            found = [pair for message in messages if (pair := self._read(message)) is not None]
            left = None if until is None else max(0.0, until - time.monotonic())
            if found or self.over or not (messages or self.wait(left)):
                return found

    def wait(self, timeout: float | None = None) -> bool:
        """Wait for a line, for so many seconds, and return whether one may be there."""
        until = None if timeout is None else time.monotonic() + timeout
        while not (self._waiting or self._done.is_set()):
            left = None if until is None else until - time.monotonic()
            if left is not None and left <= 0:
                return False
            self._news.wait(left)
        return True

    @property
    def over(self) -> bool:
        """Return whether nothing comes any more, and nothing waits."""
        return self._done.is_set() and not self._waiting

    @property
    def waiting(self) -> int:
        """Return how many lines nobody has read yet."""
        return len(self._waiting)

    def close(self) -> None:
        """Take no more."""
        self._done.set()
        self._news.wake()
        self.port.close()
        self._thread.join()

    def _some(self) -> list[Message]:
        with self._lock:
            waiting = self._waiting
            found = [waiting.popleft() for _ in range(min(len(waiting), _BATCH))]
            self._bytes -= sum(map(_size, found))
        return found

    def _read(self, message: Message) -> tuple[LogLine, Message] | None:
        try:
            line = read_message(message)
        except yarpy.DecodeError:
            return None
        if line is None or (self._pattern and not matches(self._pattern, line.origin)):
            return None
        if self._is_known(line):
            return None
        return line, message

    def _is_known(self, line: LogLine) -> bool:
        origin = self._origins.get(line.origin)
        if origin is None:
            if len(self._origins) >= LOG_ORIGINS:  # strangers may make up any number
                del self._origins[next(iter(self._origins))]
            origin = self._origins[line.origin] = _Origin()
        if not line.time:
            return False
        mark = hash((line.time, line.text))
        if line.time > origin.time:
            origin.time = line.time
        elif mark in origin.known or mark in origin.older:
            return True
        if len(origin.known) >= AGAIN:
            origin.known, origin.older = set(), origin.known
        origin.known.add(mark)
        return False

    # -- threads ----------------------------------------------------------------------------------

    def _hear(self, message: Message[Any]) -> None:
        """Take a message, in the thread of its connection."""
        size = _size(message)
        with self._lock:
            self.taken += 1
            self._bytes += size
            waiting = self._waiting
            waiting.append(message)
            while len(waiting) > LOG_WAITING or self._bytes > LOG_WAITING_BYTES:
                self._bytes -= _size(waiting.popleft())
                self.lost += 1
            first = len(waiting) == 1
        if first:  # else nobody waits for it
            self._news.wake()

    def _join(self) -> None:
        """Ask all that log to send here."""
        from yarpy.names.default import DEFAULT

        while not self._done.is_set():
            known = {link.source for link in self.port.inputs}
            try:
                names = DEFAULT.current() if self._names is None else self._names
                found = [one.name for one in names.list()]
            except yarpy.YarpError:
                found = []
            for name in found:
                logs = any(part in name for part in PARTS) and matches(self._pattern, name)
                if logs and name not in known and not self._done.is_set():
                    with suppress(yarpy.YarpError):  # its program is gone, or not ours to ask
                        yarpy.connect(name, self.port.name, "fast_tcp", names=self._names)
            self.joined += 1
            self._news.wake()
            self._done.wait(PERIOD)


def _size(message: Message) -> int:
    payload = message.payload
    return len(payload) if isinstance(payload, _BYTES) else 100
