"""Events: names that monitors set, for a while or for good, and that constraints test.

Rules: one container for the whole process, as in C++, so monitors at different ports see each
other's events. An event belongs to the monitor that set it: only its owner can unset it, and it
ends with its owner. Set by several, it lasts until the last one is gone. (In C++ a forgotten event
outlives its monitor, and an expired one hides another monitor's.)
"""

from __future__ import annotations

import time
from collections.abc import Callable
from math import inf
from typing import Final

from yarpy import fork
from yarpy.errors import LocalProtocolError
from yarpy.limit import SCRIPT_EVENTS
from yarpy.monitors.constraint import RESERVED


class Events:
    """The events of all owners, and when each expires."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._lock = fork.lock()  # monitors of all connections share this
        self._ends: dict[str, dict[object, float]] = {}
        self._names: dict[object, set[str]] = {}

    def set(self, owner: object, name: str, lifetime: float | None = None) -> None:
        """Set or renew an event for `lifetime` seconds; None or below 0: until it is unset.

        Raises LocalProtocolError for a name that no constraint could test, and
        beyond SCRIPT_EVENTS.
        """
        if name in RESERVED or not name or any(c.isspace() or c in "()" for c in name):
            words = ", ".join(sorted(RESERVED))
            raise LocalProtocolError(f'"{name}" cannot name an event: use a word, not {words}')
        forever = lifetime is None or lifetime < 0
        with self._lock:
            now = self._clock()
            mine = self._names.setdefault(owner, set())
            if name not in mine and len(mine) >= SCRIPT_EVENTS:
                for other in [n for n in mine if self._ends[n][owner] <= now]:
                    self._drop(owner, other)
                if len(mine) >= SCRIPT_EVENTS:
                    raise LocalProtocolError(
                        f"a monitor cannot set more than {SCRIPT_EVENTS} events"
                    )
            mine.add(name)
            self._ends.setdefault(name, {})[owner] = inf if forever else now + (lifetime or 0)

    def unset(self, owner: object, name: str) -> None:
        """Remove an event, if `owner` has set it."""
        with self._lock:
            if name in self._names.get(owner, ()):
                self._drop(owner, name)

    def clear(self, owner: object) -> None:
        """Remove all events of `owner`."""
        with self._lock:
            for name in [*self._names.get(owner, ())]:
                self._drop(owner, name)
            self._names.pop(owner, None)

    def has(self, name: str) -> bool:
        """Return whether the event is set now."""
        with self._lock:
            ends = self._ends.get(name)
            if not ends:
                return False
            now = self._clock()
            if max(ends.values()) > now:
                return True
            for owner in [*ends]:
                self._drop(owner, name)
            return False

    def _drop(self, owner: object, name: str) -> None:
        self._names[owner].discard(name)
        ends = self._ends[name]
        del ends[owner]
        if not ends:
            del self._ends[name]


EVENTS: Final = Events()
"""Those of this process."""
