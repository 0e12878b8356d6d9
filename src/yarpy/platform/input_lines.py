"""Lines of standard input, and signals that end the wait for the next one.

    Linux, macOS    a signal ends a read, and Python calls the handler
    Windows         a read goes on, for ever where nothing comes: a thread reads, and whoever wants
                    a line waits in slices, between which Python calls the handler

Rules: one at a time asks for lines; on Windows some may be read and never taken. What reading
raises comes out of the wait.
"""

from __future__ import annotations

import sys
import threading
from collections.abc import Iterator
from typing import Final, TextIO

from yarpy.platform.timed_queue import TimedQueue

AHEAD: Final = 1000  # lines that are read and not yet taken

if sys.platform == "win32":

    def lines() -> Iterator[str]:
        """Yield the lines of standard input with their ends; none where it was closed before this
        program began."""
        if sys.stdin is None:
            return
        read: TimedQueue[str | BaseException | None] = TimedQueue()
        room = threading.Semaphore(AHEAD)
        threading.Thread(
            target=_read, args=(sys.stdin, read, room), name="yarpy input", daemon=True
        ).start()
        taken: list[str | BaseException | None] = []
        while True:
            read.take(taken)
            line = taken.pop()
            room.release()
            if line is None:
                return
            if isinstance(line, BaseException):
                raise line
            yield line

    def _read(
        source: TextIO, read: TimedQueue[str | BaseException | None], room: threading.Semaphore
    ) -> None:
        try:
            for line in source:
                room.acquire()
                read.put(line)
        except Exception as error:  # of the stream's, or that it was closed
            read.put(error)
        else:
            read.put(None)

else:

    def lines() -> Iterator[str]:
        """Yield the lines of standard input with their ends; none where it was closed before this
        program began."""
        yield from sys.stdin or ()
