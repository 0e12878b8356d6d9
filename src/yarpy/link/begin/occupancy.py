"""Occupancy: how many connections a port serves at the same time, and from one address.

    YARPY_CONNECTIONS     connections of a port: 1024; of one address a quarter of that

Rules: each served connection has a thread, so this limits threads too. Programs of this computer
count for the port alone, since they all have one address. Connections beyond the limit are closed
at once, and the log says so once until there is room again.
"""

from __future__ import annotations

import threading
from typing import Final

from yarpy.link.flapping import Flapping
from yarpy.link.setting import number

SETTING: Final = "YARPY_CONNECTIONS"
DEFAULT: Final = 1024
SHARE: Final = 4  # an address has a quarter


def connections() -> int:
    """Return how many connections a port serves, as the environment says now."""
    return max(1, number(SETTING, DEFAULT))


class Occupancy:
    """The connections that the port called `name` serves."""

    def __init__(self, name: str) -> None:
        self.most = connections()
        self.share = max(1, self.most // SHARE)  # of one address
        self._served: dict[str, int] = {}  # by address
        self._total = 0
        self._lock = threading.RLock()  # of the two above
        self._full = Flapping(name, "takes connections again")

    @property
    def total(self) -> int:
        """Connections that are being served."""
        return self._total

    def admit(self, address: str) -> bool:
        """Count a connection from `address`; False if it must be refused."""
        with self._lock:
            here = self._served.get(address, 0)
            crowded = here >= self.share and not is_here(address)
            full = self._total >= self.most
            if not (crowded or full):
                self._served[address] = here + 1
                self._total += 1
                return True
        if full:
            text = "serves %d connections and refuses more (%s sets how many)"
            self._full.happened(text, self.most, SETTING)
        else:
            text = "serves %d connections of %s and refuses more (a quarter of %s)"
            self._full.happened(text, here, address, SETTING)
        return False

    def leave(self, address: str) -> None:
        """A connection from `address` is not served any more."""
        with self._lock:
            left = self._served.pop(address) - 1
            if left:
                self._served[address] = left
            self._total -= 1
            relaxed = 4 * self._total < 3 * self.most and 4 * left < 3 * self.share
        if relaxed:
            self._full.over()


def is_here(address: str) -> bool:
    """Return whether a program of this computer has that address."""
    return address.startswith("127.") or address == "::1"
