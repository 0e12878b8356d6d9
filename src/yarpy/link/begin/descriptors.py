"""Descriptors: how many file descriptors the process has left. The last of them are the program's.

Rules: a program that cannot open its own files fails, one that takes no more connections waits. So
a port leaves a reserve. Counting descriptors takes time, so it is done when those that were free at
the last count may be half used up, and not more often than every RECOUNT seconds.
"""

from __future__ import annotations

import errno
import os
import sys
import time
from typing import Final

SHARE: Final = 20  # the reserve is a twentieth of what is allowed
LEAST: Final = 16
RECOUNT: Final = 0.05  # seconds for which a count of none holds
STALE: Final = 1.0  # seconds for which any count holds


class Descriptors:
    """The file descriptors that this process may still take."""

    def __init__(self) -> None:
        self.plenty = True  # there were twice as many as the reserve, at the last count
        self._left = 0  # to be taken before the next count
        self._counted = 0.0

    def take(self) -> bool:
        """Return whether one more may be taken."""
        now = time.monotonic()
        age = now - self._counted
        if age > STALE or (self._left <= 0 and age > RECOUNT):
            self._left = self._room()
            self._counted = now
        if self._left <= 0:
            return False
        self._left -= 1
        return True

    def _room(self) -> int:
        """Return how many descriptors may be taken without looking again."""
        most = allowed()
        if most is None:
            return 1 << 20
        over = most - used(most) - reserve(most)
        self.plenty = over >= reserve(most)
        return (over + 1) // 2  # other threads of the program take some too


def reserve(most: int) -> int:
    """Return how many of `most` descriptors are the program's."""
    return max(LEAST, most // SHARE)


def allowed() -> int | None:
    """Return how many descriptors this process may have; None if nobody knows."""
    if sys.platform == "win32":
        return None
    try:
        import resource
    except ImportError:  # a Python that was built without
        return None
    most = resource.getrlimit(resource.RLIMIT_NOFILE)[0]
    return None if most == resource.RLIM_INFINITY else most


def used(most: int) -> int:
    """Return how many descriptors this process has, `most` where not one is left for looking."""
    for folder in ("/proc/self/fd", "/dev/fd"):
        try:
            return len(os.listdir(folder)) - 1  # without that of the listing
        except OSError as error:
            if error.errno in (errno.EMFILE, errno.ENFILE):
                return most  # not even one for looking
    return 0
