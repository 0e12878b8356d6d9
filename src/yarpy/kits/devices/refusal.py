"""Refused: a request that is not carried out. Its reason is for the log; the answer is `[fail]`."""

from __future__ import annotations

import time
from typing import Final

from yarpy.errors import YarpError
from yarpy.log import logger

log = logger("yarpy.devices")

#: The same error is logged again after this many seconds.
QUIET: Final = 5.0
_MOST: Final = 200  # errors remembered: anybody can cause them, under any name


class Refused(Exception):
    """A request for something the device does not have, or a malformed one."""


class DeviceErrorLog:
    """Log lines about a user's device: one for each kind of error, not for each occurrence.

    A sensor that fails fifty times per second would otherwise bury all other lines.
    """

    def __init__(self, name: str) -> None:
        self.name = name
        self._said: dict[str, tuple[str, float]] = {}

    def __call__(self, about: str, error: Exception) -> None:
        """Log that `about` (a method of the device) failed, unless that was logged just now."""
        text = str(error)
        if not isinstance(error, (Refused, YarpError)):
            text = f"{type(error).__name__}: {error}"
        now = time.monotonic()
        before, at = self._said.get(about, ("", 0.0))
        if before != text or now - at > QUIET:
            if len(self._said) >= _MOST:
                self._said.clear()
            self._said[about] = (text, now)
            log.warning("%s: %s: %s", self.name, about, text)
