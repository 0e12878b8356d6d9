"""Line: a serial line as a file, raw, at a speed; on systems with termios.

    with Line("/dev/ttyUSB0", 1_000_000) as line:
        line.write(b"...")
        line.read(time.monotonic() + 0.02)         # what has come; b"" if nothing came until then

Rules: one thread at a time. Speeds that termios has no name for are refused.
"""

from __future__ import annotations

import os
import select
import sys
import time
from contextlib import ExitStack

from yarpy.errors import UnknownPlugin
from yarpy.kits.devices.closeable import Closeable


class Line(Closeable):
    """The line at `path`. Raises OSError, ValueError for a speed that there is not, UnknownPlugin
    on Windows."""

    def __init__(self, path: str, speed: int) -> None:
        self.path = path
        self._file: int
        if sys.platform == "win32":
            raise UnknownPlugin("serial lines are files of Linux and macOS; Windows has none")
        import termios
        import tty

        rate = getattr(termios, f"B{speed}", None)
        if rate is None:
            raise ValueError(f"no serial line of this system has {speed} baud")
        with ExitStack() as resources:
            self._file = os.open(path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
            resources.callback(os.close, self._file)
            tty.setraw(self._file)
            settings = termios.tcgetattr(self._file)
            settings[4] = settings[5] = rate
            termios.tcsetattr(self._file, termios.TCSANOW, settings)
            termios.tcflush(self._file, termios.TCIOFLUSH)
            self._resources = resources.pop_all()

    def write(self, data: bytes) -> None:
        """Send all of this. Raises OSError."""
        while data:
            select.select([], [self._file], [])
            data = data[os.write(self._file, data) :]

    def read(self, until: float) -> bytes:
        """Return what has come, b"" at the time `until` (`time.monotonic`). Raises OSError, also
        if the line is unplugged."""
        left = max(0.0, until - time.monotonic())
        if not select.select([self._file], [], [], left)[0]:
            return b""
        found = os.read(self._file, 4096)
        if not found:
            raise OSError(f"{self.path}: nothing is plugged in there any more")
        return found
