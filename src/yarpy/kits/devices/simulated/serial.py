"""SimulatedSerialPort: what is sent comes back, as through a loopback plug; fakeSerialPort in C++.

Rules: so many bytes wait to be received; more are thrown away, as by a full buffer.
"""

from __future__ import annotations

import threading

from yarpy.data.bottle import Bottle
from yarpy.limit import SERIAL_WAITING


class SimulatedSerialPort:
    """Every member of `interfaces.serial.SerialPort`. `ready`: the line of `enable_ready_line`."""

    def __init__(self) -> None:
        self.ready = False
        self._lock = threading.Lock()  # what comes is counted before it is kept
        self._waiting = ""

    def send(self, message: Bottle) -> None:
        """Receive the first word."""
        if message and isinstance(message[0], str):
            with self._lock:
                self._waiting = (self._waiting + message[0])[:SERIAL_WAITING]

    def receive(self) -> Bottle:
        """Return what was sent."""
        with self._lock:
            found, self._waiting = self._waiting, ""
        return Bottle([found] if found else [])

    def enable_ready_line(self, enable: bool) -> bool:
        """Set the line."""
        self.ready = enable
        return True

    def flush(self) -> int:
        """Throw away what was sent."""
        with self._lock:
            count, self._waiting = len(self._waiting), ""
        return count
