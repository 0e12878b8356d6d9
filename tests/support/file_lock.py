"""A lock that processes share: whoever holds it prepares what the others then find."""

from __future__ import annotations

import sys
import time
from typing import IO, Any


def hold(file: IO[Any]) -> None:
    """Lock an open file until it is closed."""
    if sys.platform == "win32":
        import msvcrt

        while True:
            try:
                msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
                return
            except OSError:
                time.sleep(0.05)
    else:
        import fcntl

        fcntl.flock(file, fcntl.LOCK_EX)
