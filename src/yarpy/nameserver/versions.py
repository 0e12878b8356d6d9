"""Versions: which ports are of C++ YARP 4, that spell floats otherwise than YARP 3.

Rules: a port of C++ says nothing about itself while it waits for an answer, which might then be
spelled wrongly. So it is asked when it has registered, and what it says is a property of its name
(`port/answer/spelling.py`). Ports of yarpy, which read both, are not asked; nor is anybody while
many wait for that.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from queue import SimpleQueue
from typing import Final

from yarpy.contact import Contact
from yarpy.errors import YarpError
from yarpy.names.default import secret
from yarpy.port.connect import probe

OURS: Final = "tls"  # a carrier that each port of yarpy takes on every system, and none of C++
MOST: Final = 64  # ports that wait to be asked
PAUSES: Final = (0.002, 0.005, 0.02, 0.1, 0.3)  # seconds until a port that registers listens
TIMEOUT: Final = 0.5  # seconds for an answer


class Versions:
    """`found(contact)` is called with each port that is of C++ YARP 4, in a thread of this."""

    def __init__(self, found: Callable[[Contact], None]) -> None:
        self._found = found
        self._queue: SimpleQueue[Contact | None] = SimpleQueue()
        self._thread: threading.Thread | None = None
        self._closed = threading.Event()

    def ask(self, contact: Contact) -> None:
        """Ask a port that has registered, soon. One thread at a time calls this."""
        if self._queue.qsize() >= MOST or self._closed.is_set():
            return
        self._queue.put(contact)
        if self._thread is None:
            self._thread = threading.Thread(target=self._run, name="yarpy versions", daemon=True)
            self._thread.start()

    def close(self) -> None:
        """Ask nobody any more."""
        self._closed.set()
        self._queue.put(None)

    def _run(self) -> None:
        while (contact := self._queue.get()) is not None and not self._closed.is_set():
            for pause in PAUSES:
                try:
                    if probe.introduce(contact, TIMEOUT, secret()) == (contact.name, True):
                        self._found(contact)
                    break
                except (YarpError, OSError) as error:
                    if not probe.is_refused(error) or self._closed.wait(pause):
                        break
