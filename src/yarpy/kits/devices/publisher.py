"""A thread that calls a function at a fixed rate, for servers that publish.

Rules: the thread is named after its server; a step that takes too long delays the next one, and
missed steps are skipped; what a step raises is logged, and the next one still runs. The period is
of the clock of the program (`yarpy.clock`), which may be set back.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from math import isfinite
from typing import Final

from yarpy import clock
from yarpy.kits.devices.refusal import DeviceErrorLog

#: Seconds that a running step may take once its server is being closed.
TIMEOUT: Final = 5.0


class Publisher:
    """Calls `step` every `period` seconds until it is closed."""

    def __init__(self, name: str, period: float, step: Callable[[], object]) -> None:
        if not (isfinite(period) and period > 0):
            raise ValueError(f"{name}: the period must be a positive number of seconds: {period}")
        self.period = period
        self._step = step
        self._complain = DeviceErrorLog(name)
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, name=f"yarpy device {name}", daemon=True)
        self._thread.start()

    def _run(self) -> None:
        due = clock.current().monotonic()
        while not self._sleep(due):
            try:
                self._step()
            except Exception as error:
                if self._ended.is_set():
                    return
                self._complain("publishing", error)
            due = max(due + self.period, clock.current().monotonic())

    def _sleep(self, due: float) -> bool:
        """Wait until then, but no longer than the period; return whether it was closed."""
        time = clock.current()
        return time.wait(self._ended, min(due - time.monotonic(), self.period))

    def close(self) -> None:
        """End the thread and wait for it, but not forever if it is stuck in a device."""
        self._ended.set()
        if self._thread is not threading.current_thread():
            self._thread.join(TIMEOUT)
