"""Work that is asked for by many, and done by one thread at a time.

    look = Coalesced(act, "name of its thread")
    look()                                         # from any thread; returns at once

Rules: what is asked for while it runs is done once more at its end, however often it was asked for:
a flood of tokens starts one thread, not as many as there are tokens.
"""

from __future__ import annotations

import threading
from collections.abc import Callable


class Coalesced:
    """Calls `act` in a thread called `name`, which ends when nothing is left to do."""

    def __init__(self, act: Callable[[], object], name: str) -> None:
        self._act = act
        self._name = name
        self._lock = threading.Lock()
        self._wanted = False
        self._running = False

    def __call__(self) -> None:
        with self._lock:
            self._wanted = True
            if self._running:
                return
            self._running = True
        try:
            threading.Thread(target=self._run, name=self._name).start()
        except RuntimeError:  # the program ends, or has too many threads
            with self._lock:
                self._running = False
            raise

    def _run(self) -> None:
        try:
            while self._next():
                self._act()
        except BaseException:
            with self._lock:
                self._running = False
            raise

    def _next(self) -> bool:
        with self._lock:
            self._wanted, wanted = False, self._wanted
            self._running = wanted
            return wanted
