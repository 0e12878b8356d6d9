"""Slow reader: how long a reader may keep its writer waiting, and when the log says that it does.

Rules: a reader that dialled us may be anybody, so it is cut off after STRANGERS seconds; the limit
counts from when it began to take nothing, whatever its writers do meanwhile. One that we dialled
may take as long as it likes; after a second the log says so, once until it takes something.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Final

from yarpy.log import logger

if TYPE_CHECKING:
    from yarpy.route import Route

log = logger("yarpy.link")

STRANGERS: Final = 10.0  # seconds for a reader that dialled us
SOON: Final = 1.0  # seconds of waiting that are worth a line in the log


class SlowReader:
    """Of one connection. `limit` in seconds; None: as long as it likes."""

    def __init__(self, route: Route, limit: float | None = None) -> None:
        self.limit = limit
        self._route = route
        self._since = 0.0  # when it began to keep us waiting
        self._told = False

    def limit_of(self, until: float | None) -> float | None:
        """Return until when to wait, if the writer itself waits until `until`."""
        if self.limit is None:
            return until
        # Several threads write: another may find meanwhile that the reader has taken all.
        since = self._since
        if not since:
            since = self._since = time.monotonic()
        own = since + self.limit
        return own if until is None else min(until, own)

    def over(self, took: bool) -> bool:
        """Return whether the limit is over, now that the reader took everything or did not."""
        if self.limit is None:
            return False
        if took:
            self._since = 0.0
            return False
        since = self._since
        return since > 0.0 and time.monotonic() >= since + self.limit

    def warning(self, until: float | None) -> float | None:
        """Return when the log should tell of a wait that begins; None if never."""
        if self._told:
            return None
        soon = time.monotonic() + SOON
        return soon if until is None or soon < until else None

    def warn(self) -> None:
        """Say that a writer waits."""
        if not self._told:
            self._told = True
            log.warning(
                "%s: %s has taken nothing for %g s, and write() waits for it; write(timeout=...) "
                "or a BufferedPort would not",
                self._route.source,
                self._route.target,
                SOON,
            )

    def took(self) -> None:
        """It has taken what was waited for."""
        self._told = False

    def disconnect(self) -> str:
        """Say that the reader is cut off; return why."""
        reason = f"it did not take a message within {self.limit:g} s"
        log.warning(
            "%s: %s does not read, and is disconnected: %s",
            self._route.source,
            self._route.target,
            reason,
        )
        return reason
