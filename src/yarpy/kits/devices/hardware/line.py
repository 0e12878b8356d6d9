"""Line: a serial line, raw, at a speed.

    with Line("/dev/ttyUSB0", 1_000_000) as line:
        line.write(b"...")
        line.read(time.monotonic() + 0.02)         # what has come; b"" if nothing came until then

Rules: one thread at a time. pyserial opens it, for this program alone.
"""

from __future__ import annotations

import time
from contextlib import ExitStack
from typing import Final

from yarpy.errors import UnknownPlugin
from yarpy.kits.devices.closeable import Closeable

TAKEN: Final = 1.0  # seconds for the line to take what is written


class Line(Closeable):
    """The line at `path`, as `/dev/ttyUSB0` or `COM3`. Raises OSError, also for a speed that it
    cannot have, and UnknownPlugin (no pyserial)."""

    def __init__(self, path: str, speed: int) -> None:
        try:
            import serial
        except ImportError as error:
            raise UnknownPlugin(
                "serial lines need pyserial: pip install 'yarpy[hardware]'"
            ) from error
        self.path = path
        with ExitStack() as resources:
            self._serial = serial.Serial(path, speed, write_timeout=TAKEN, exclusive=True)
            resources.callback(self._serial.close)
            self._serial.reset_input_buffer()
            self._resources = resources.pop_all()

    def write(self, data: bytes) -> None:
        """Send all of this. Raises OSError."""
        self._serial.write(data)

    def discard(self) -> None:
        """Forget what has come and was not read. Raises OSError."""
        self._serial.reset_input_buffer()

    def read(self, until: float) -> bytes:
        """Return what has come, b"" at the time `until` (`time.monotonic`). Raises OSError, also
        if the line is unplugged."""
        self._serial.timeout = max(0.0, until - time.monotonic())
        found: bytes = self._serial.read(1)
        if found and (more := self._serial.in_waiting):
            found += self._serial.read(more)
        return found
