"""What this process holds more than at an earlier moment: threads, open files.

Rules: compared one by one, not by their number: what earlier tests have left may end meanwhile.
"""

from __future__ import annotations

import contextlib
import os
import threading
from collections import Counter


def threads() -> set[threading.Thread]:
    """Return the threads that live now."""
    return set(threading.enumerate())


def files() -> Counter[str]:
    """Return what the open descriptors of this process lead to, and how many lead there; nothing
    where the system does not list them."""
    found: Counter[str] = Counter()
    if not os.path.isdir("/proc/self/fd"):
        return found
    for number in os.listdir("/proc/self/fd"):
        with contextlib.suppress(FileNotFoundError):  # closed meanwhile; or that of this listing
            link = os.readlink(f"/proc/self/fd/{number}")
            if link != f"/proc/{os.getpid()}/fd":
                found[link] += 1
    return found
