"""Intake: takes the lines of all programs that log, whenever they come, and counts what it loses.

Rules: every second it looks for ports that log and asks them to send here; a program that came back
is asked again. Lines wait in memory, a limited number of them, for whoever reads them; what comes
beyond that replaces the oldest, and is counted. What a program tells again, since it was asked
again, is left out.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Any, Final

import yarpy
from yarpy.kits.launch.log.filter import matches
from yarpy.limit import LOG_ORIGINS, LOG_WAITING, LOG_WAITING_BYTES
from yarpy.names.base import NameClient
from yarpy.port.keep.log_line import LogLine, read_message
from yarpy.wire.message import Message

PARTS: Final = ("/log/", "/yarprunlog/")  # of the names of ports that log
PERIOD: Final = 1.0  # seconds between looks for more of them
AGAIN: Final = 1024  # lines of a program that are known when they come again
_BATCH: Final = 2000  # lines read at a time
_BYTES: Final = (memoryview, bytes, bytearray, str)


@dataclass(slots=True)
class _Origin:
    """The last entry of a program."""

    time: float = 0.0
    known: deque[int] = field(default_factory=lambda: deque(maxlen=AGAIN))


class Intake:
    """Takes lines at `port`, which reads strictly, of the ports that match `pattern`."""

    def __init__(
        self, port: yarpy.BufferedPort[Any], pattern: str = "", names: NameClient | None = None
    ) -> None:
        self._port, self._pattern, self._names = port, pattern, names
        self.taken = 0  # messages
        self.lost = 0  # messages that nobody read in time
        self._waiting: deque[Message] = deque()
        self._bytes = 0
        self._lock = threading.Lock()  # of these four
        self._news = threading.Event()
        self._done = threading.Event()
        self._origins: dict[str, _Origin] = {}
        self.joined = 0  # looks for ports that were finished
        self._threads = [
            threading.Thread(target=target, name=f"{port.name} {target.__name__}", daemon=True)
            for target in (self._take, self._join)
        ]
        for thread in self._threads:
            thread.start()

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
            left = 3600.0 if until is None else until - time.monotonic()
            if left <= 0:
                return False
            self._news.wait(left)
            self._news.clear()
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
        self._news.set()
        self._port.interrupt()
        for thread in self._threads:
            thread.join()

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
        elif mark in origin.known:
            return True
        origin.known.append(mark)
        return False

    # -- threads ----------------------------------------------------------------------------------

    def _take(self) -> None:
        try:
            lock, waiting, news = self._lock, self._waiting, self._news
            for message in self._port:
                size = _size(message)
                with lock:
                    self.taken += 1
                    self._bytes += size
                    waiting.append(message)
                    while len(waiting) > LOG_WAITING or self._bytes > LOG_WAITING_BYTES:
                        self._bytes -= _size(waiting.popleft())
                        self.lost += 1
                if not news.is_set():  # which costs less than to set it again
                    news.set()
        except yarpy.YarpError:
            pass  # it was interrupted or closed
        self._done.set()
        self._news.set()

    def _join(self) -> None:
        """Ask all that log to send here."""
        from yarpy.names.default import DEFAULT

        while not self._done.is_set():
            known = {link.source for link in self._port.inputs}
            try:
                names = DEFAULT.current() if self._names is None else self._names
                found = [one.name for one in names.list()]
            except yarpy.YarpError:
                found = []
            for name in found:
                logs = any(part in name for part in PARTS) and matches(self._pattern, name)
                if logs and name not in known and not self._done.is_set():
                    with suppress(yarpy.YarpError):  # its program is gone, or not ours to ask
                        yarpy.connect(name, self._port.name, names=self._names)
            self.joined += 1
            self._news.set()
            self._done.wait(PERIOD)


def _size(message: Message) -> int:
    payload = message.payload
    return len(payload) if isinstance(payload, _BYTES) else 100
