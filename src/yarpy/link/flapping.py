"""Flapping: trouble that comes again and again, logged when it begins and when it ends.

Rules: strangers cannot fill the log: however often it happens in between, there are two lines.
"""

from __future__ import annotations

import threading

from yarpy.log import logger

log = logger("yarpy.link")


class Flapping:
    """A state of trouble of the port called `name`. Any thread may call."""

    def __init__(self, name: str, end: str) -> None:
        self._name = name
        self._end = end  # what is said when it is over
        self.count = 0  # how often it happened since it began; 0: all is well
        self._lock = threading.RLock()  # so that one thread alone tells of a change

    def happened(self, text: str, *arguments: object) -> None:
        """Count the trouble; log `text`, which says what to do, if this is its beginning."""
        with self._lock:
            self.count += 1
            first = self.count == 1
        if first:
            log.warning("%s: " + text, self._name, *arguments)

    def over(self) -> None:
        """Log the end of the trouble, if there was any."""
        if not self.count:
            return
        with self._lock:
            count, self.count = self.count, 0
        if count:
            log.warning("%s: %s (%d times in between)", self._name, self._end, count)
