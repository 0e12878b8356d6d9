"""An alarm clock: calls something at a time, for waits that cannot have a limit of their own.

Rules: one thread for the process, which is started when first needed; what is called must not wait.
"""

from __future__ import annotations

import heapq
import itertools
import threading
import time
from collections.abc import Callable

from yarpy import fork

_Alarm = tuple[float, int, Callable[[], object]]


class AlarmClock:
    """Calls what was set, each once. There is one instance, `CLOCK`."""

    def __init__(self) -> None:
        self._alarms: list[_Alarm] = []
        self._changed = threading.Condition()
        self._numbers = itertools.count()
        self._running = False

    def set(self, when: float, call: Callable[[], object]) -> None:
        """Call it at the time `when` of time.monotonic, in the clock's thread."""
        with self._changed:
            heapq.heappush(self._alarms, (when, next(self._numbers), call))
            if self._alarms[0][2] is call:
                self._changed.notify()
            if not self._running:
                self._running = True
                threading.Thread(target=self._run, name="yarpy alarm clock", daemon=True).start()

    def _run(self) -> None:
        while True:
            with self._changed:
                while not self._alarms or (left := self._alarms[0][0] - time.monotonic()) > 0:
                    self._changed.wait(left if self._alarms else None)
                call = heapq.heappop(self._alarms)[2]
            call()

    def start_over(self) -> None:
        """In a forked process: the thread is not here, nor those that wait."""
        self.__init__()  # type: ignore[misc]


CLOCK = AlarmClock()
fork.after_in_child(CLOCK.start_over)
