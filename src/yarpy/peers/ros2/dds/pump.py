"""One thread that waits for what comes to the readers of a participant.

Rules: what is taken from a reader is taken under a lock, so that one that is removed is not in use;
what is done with it is done outside of it. Callbacks are short, as those of a middleware are.
"""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable
from typing import Any, Final

from yarpy.log import logger
from yarpy.peers.ros2.dds.library import delete, load

log = logger("yarpy.ros2")

LONG: Final = 10.0  # seconds of each wait
CLOSING: Final = 5.0  # seconds for the thread to end

Take = Callable[[], Callable[[], None] | None]  # takes what came; what is to be done with it


class Pump:
    """Waits for the readers that are added; the thread begins with the first."""

    def __init__(self, dds: Any) -> None:
        core = load()
        self._failure: Any = core.DDSException
        self._set: Any = core.WaitSet(dds)
        self._bell: Any = core.GuardCondition(dds)
        self._set.attach(self._bell)
        self._held: dict[int, tuple[Any, Take]] = {}
        self._lock = threading.RLock()
        self._over = False
        self._thread: threading.Thread | None = None

    def add(self, reader: Any, take: Take) -> None:
        """Call `take` whenever something came to a reader, and then what it returns."""
        with self._lock:
            self._held[id(reader)] = (reader, take)
            self._set.attach(reader)
            if self._thread is None:
                self._thread = threading.Thread(target=self._run, name="yarpy DDS", daemon=True)
                self._thread.start()
        self._bell.set(True)

    def remove(self, reader: Any) -> None:
        """Forget a reader; it may be deleted then."""
        with self._lock:
            if self._held.pop(id(reader), None) is not None:
                self._set.detach(reader)

    def _run(self) -> None:
        while not self._over:
            try:
                self._set.wait(int(LONG * 1e9))
                self._bell.set(False)
            except self._failure:
                if not self._over:
                    log.exception("DDS cannot be waited for")
                return
            with self._lock:
                held = [*self._held]
            for key in held:
                self._look(key)

    def _look(self, key: int) -> None:
        with self._lock:
            found = self._held.get(key)
            if found is None or self._over:
                return
            try:
                act = found[1]()
            except Exception:
                log.exception("something that came over DDS is lost")
                return
        if act is not None:
            try:
                act()
            except Exception:
                log.exception("something that came over DDS is lost")

    def close(self) -> None:
        """Idempotent."""
        if self._over:
            return
        self._over = True
        with contextlib.suppress(self._failure):
            self._bell.set(True)
        if self._thread is not None and self._thread is not threading.current_thread():
            self._thread.join(CLOSING)
        for item in (self._set, self._bell):
            delete(item)
