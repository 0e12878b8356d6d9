"""Pending connections: those that have not said yet which protocol they speak.

Rules: each costs a file descriptor and no thread, for TIMEOUT seconds at most. When there are too
many, of all or of one address, the one that has waited longest goes.
"""

from __future__ import annotations

import socket
import time
from collections.abc import Iterator
from typing import Final

from yarpy.link.begin.occupancy import is_here

TIMEOUT: Final = 60.0  # seconds for a connection to say which protocol it speaks
MOST: Final = 4096


class Pending:
    """Sockets that wait for their first words, the oldest first. `share`: of one address."""

    def __init__(self, share: int) -> None:
        self._share = share
        self._waiting: dict[socket.socket, tuple[str, float]] = {}  # address, when its time is over
        self._of: dict[str, int] = {}

    def __len__(self) -> int:
        return len(self._waiting)

    def __iter__(self) -> Iterator[socket.socket]:
        return iter(self._waiting)

    def enter(self, sock: socket.socket, address: str) -> None:
        """Add a connection."""
        self._waiting[sock] = address, time.monotonic() + TIMEOUT
        self._of[address] = self._of.get(address, 0) + 1

    def leave(self, sock: socket.socket) -> str:
        """Remove a connection; return its address."""
        address, _ = self._waiting.pop(sock)
        left = self._of.pop(address) - 1
        if left:
            self._of[address] = left
        return address

    def crowded(self, address: str) -> socket.socket | None:
        """The one that must go before another from `address` enters; None: there is room."""
        if self._of.get(address, 0) >= self._share and not is_here(address):
            return next(sock for sock, (of, _) in self._waiting.items() if of == address)
        return self.oldest() if len(self._waiting) >= MOST else None

    def oldest(self) -> socket.socket | None:
        """The one that has waited longest."""
        return next(iter(self._waiting), None)

    def overdue(self) -> list[socket.socket]:
        """Those whose time is over."""
        now = time.monotonic()
        found = []
        for sock, (_, due) in self._waiting.items():
            if due > now:
                break
            found.append(sock)
        return found

    def left(self) -> float | None:
        """Seconds until the next one's time is over; None: nobody waits."""
        oldest = self.oldest()
        return None if oldest is None else max(0.0, self._waiting[oldest][1] - time.monotonic())

    def clear(self) -> None:
        """Close them all, as this process's copies."""
        for sock in self._waiting:
            sock.close()
        self._waiting.clear()
        self._of.clear()
