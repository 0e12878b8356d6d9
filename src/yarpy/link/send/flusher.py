"""Flusher: a thread that sends what a burst left behind, if its writer does not come back.

Rules: it does not know the connection; it is handed a callable, which takes the connection's lock
for moments. The thread begins when there is something to do for the first time, so that whoever
makes a flusher can stop it whatever a signal handler does meanwhile. It sleeps while nothing is
left.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Final

from yarpy.threads import Thread

GATHER_SECONDS: Final = 200e-6  # how long a burst's message may wait for others


class Flusher:
    """`flush` sends what is there, and says whether the burst may still go on."""

    def __init__(self, name: str, flush: Callable[[], bool]) -> None:
        self._flush = flush
        self._wake = threading.Lock()  # free: there is something to do; a handler may free it
        self._wake.acquire()
        self._asleep = True
        self._stopped = False
        self.thread = Thread(target=self._run, name=name, daemon=True)

    def watch(self) -> None:
        """Something was gathered."""
        if self.thread.ident is None and not self._stopped:
            try:
                self.thread.start()
            except RuntimeError:
                if self.thread.ident is None:
                    raise  # threads have run out; else a start that a signal had cut was done
        if self._asleep:
            self._asleep = False
            self._rouse()

    def stop(self) -> None:
        """Let the thread end."""
        self._stopped = True
        self._rouse()

    def _rouse(self) -> None:
        try:
            self._wake.release()
        except RuntimeError:
            pass  # it is awake

    def _run(self) -> None:
        while True:
            self._wake.acquire()
            if self._stopped:
                return
            while True:
                time.sleep(GATHER_SECONDS)
                if not self._flush():
                    break
            self._asleep = True
            self._flush()
