"""Budget: the bytes that unfinished messages may hold, of a port and of the whole process.

    YARPY_INPUT_LIMIT     bytes for each port: 256 MiB; the process has four times as much

Rules: the largest message is not counted, so that one of any allowed size gets through; all others
together stay below the limit. Beyond it memory that connections only keep is given back first, then
connections are ended, those first that have held most for longest (bytes times seconds): a peer
that sends gets done, one that trickles pays. No connection is touched under the lock.
"""

from __future__ import annotations

import threading
import time
from functools import cache
from typing import Final, Protocol

from yarpy.link.setting import number

SETTING: Final = "YARPY_INPUT_LIMIT"
DEFAULT: Final = 1 << 28
PROCESS: Final = 4  # times the limit of a port


class Holder(Protocol):
    """A connection that holds bytes of an unfinished message."""

    held: int
    since: float  # when the message began; 0: none has, the memory is only kept

    def forget(self) -> None:
        """Give back what is only kept."""

    def end(self, reason: str) -> None:
        """Give up the message."""


class Budget:
    """So many bytes at most. `whole`: the budget that this one is a part of."""

    def __init__(self, limit: int, whole: Budget | None = None) -> None:
        self.limit = limit
        self._whole = whole
        self._held: dict[Holder, int] = {}
        self._total = 0
        self._lock = threading.RLock()  # of the two above

    @property
    def total(self) -> int:
        """Bytes that are held."""
        return self._total

    def take(self, holder: Holder, size: int) -> None:
        """`holder` has `size` bytes now. It, or another, may be ended for that."""
        holder.held = size
        idle: list[Holder] = []
        ended: list[Holder] = []
        with self._lock:
            self._total += size - self._held.get(holder, 0)
            self._held[holder] = size
            if self._total > self.limit:
                idle, ended = self._chosen()
        for one in idle:
            one.held = 0
            one.forget()
        for one in ended:
            one.end(
                f"unfinished messages hold more than {self.limit} bytes ({SETTING}), and this one "
                f"has held {one.held} of them for {time.monotonic() - one.since:.3g} s"
            )
        if self._whole is not None:
            for one in (*idle, *ended):
                self._whole.give_back(one)
            if holder not in ended:
                self._whole.take(holder, size)

    def give_back(self, holder: Holder) -> None:
        """`holder` has nothing any more."""
        with self._lock:
            self._total -= self._held.pop(holder, 0)
        if self._whole is not None:
            self._whole.give_back(holder)

    def _chosen(self) -> tuple[list[Holder], list[Holder]]:
        """Those that must give back what they keep, and those that must end; all count no more."""
        largest = max(self._held.values())
        if self._total - largest <= self.limit:
            return [], []
        now = time.monotonic()
        order = sorted(
            self._held,
            key=lambda one: (not one.since, self._held[one] * (now - one.since)),
            reverse=True,
        )
        idle: list[Holder] = []
        ended: list[Holder] = []
        for one in order:
            if self._total - largest <= self.limit:
                break
            (ended if one.since else idle).append(one)
            self._total -= self._held.pop(one)
            largest = max(self._held.values(), default=0)
        return idle, ended


def port_budget(limit: int | None = None) -> Budget:
    """A budget for a port of this process: of `limit` bytes, or as its environment says."""
    setting = number(SETTING, DEFAULT)
    return Budget(setting if limit is None else min(limit, setting), _process(setting))


@cache
def _process(setting: int) -> Budget:
    """Return the budget that all ports of the process share."""
    return Budget(PROCESS * setting)


def start_over() -> None:
    """This process was forked from another, whose connections hold nothing here."""
    _process.cache_clear()
