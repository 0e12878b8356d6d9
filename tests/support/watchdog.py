"""The time limits of all tests of a process, watched by one thread: pytest-timeout would start and
join one for each, which costs more than most tests do.

Rules: a limit is looked at every second; what comes after it is pytest-timeout's own, which prints
what each thread does and ends the process.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from time import monotonic, sleep  # tests replace those of the module
from typing import Any, Final

import pytest

PERIOD: Final = 1.0  # seconds


class Watchdog:
    """Calls `expire(item, settings)` for the item that is watched when its time is over."""

    def __init__(self, expire: Callable[[Any, Any], object], period: float = PERIOD) -> None:
        self._expire = expire
        self._period = period
        self._watched: tuple[float, Any, Any] | None = None
        threading.Thread(target=self._run, name="time limits of tests", daemon=True).start()

    def watch(self, item: Any, settings: Any) -> None:
        """Watch this item instead of the last one, for `settings.timeout` seconds."""
        self._watched = monotonic() + settings.timeout, item, settings

    def rest(self) -> None:
        """Watch nothing."""
        self._watched = None

    def _run(self) -> None:
        while True:
            sleep(self._period)
            watched = self._watched
            if watched is not None and monotonic() > watched[0]:
                self.rest()
                self._expire(*watched[1:])


class TimeLimits:
    """The plug-in of pytest: takes the place of the timers of pytest-timeout."""

    def __init__(self) -> None:
        self._watchdog: Watchdog | None = None

    @pytest.hookimpl(tryfirst=True, optionalhook=True)
    def pytest_timeout_set_timer(self, item: Any, settings: Any) -> bool | None:
        if settings.method != "thread":
            return None
        if self._watchdog is None:
            from pytest_timeout import timeout_timer

            self._watchdog = Watchdog(timeout_timer)
        self._watchdog.watch(item, settings)
        item.cancel_timeout = self._watchdog.rest
        return True
