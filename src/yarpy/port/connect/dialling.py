"""Dialling: of the attempts to reach one target, a single one at a time.

Rules: a receiver lets a second connection from the same port replace the first. So a reconnection
at the same time as a program's own `connect` would break the connection that the program has just
got. A watcher of many targets waits for none of them: each attempt has a thread, since a target may
hang.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Final

from yarpy import scope
from yarpy.log import logger
from yarpy.scope import Waiter
from yarpy.threads import Thread

log = logger("yarpy.port")

AGAIN: Final = 0.2  # seconds; whoever should wake us may have been cut by a signal handler
ATTEMPTS: Final = 32  # that one watcher has under way at the same time


class Dialling:
    """The targets that a port is connecting to right now."""

    def __init__(self) -> None:
        self._targets: dict[str, list[int]] = {}  # whose setdefault is one step
        self._waiting: dict[int, Callable[[], None]] = {}

    @contextmanager
    def alone(self, target: str, wait: bool = True) -> Iterator[bool]:
        """Be the only one to dial `target` while the block runs.

        True inside if so, also where a frame beneath of this thread is at it. With `wait` False it
        may be False: another thread is at it, leave it alone. Raises Timeout and PortClosed, as
        the call under way ends.
        """
        mine = [threading.get_ident()]
        try:
            owner = self._targets.setdefault(target, mine)
            if wait and owner[0] != mine[0]:
                owner = self._wait(target, mine)
            yield owner[0] == mine[0]
        finally:
            # Also where a signal handler has raised above. Here none can: nothing is called.
            if target in self._targets and self._targets[target] is mine:
                del self._targets[target]
                for wake in tuple(self._waiting.values()):
                    wake()

    def _wait(self, target: str, mine: list[int]) -> list[int]:
        waiter = Waiter()
        self._waiting[id(waiter)] = waiter.wake
        try:
            while (owner := self._targets.setdefault(target, mine)) is not mine:
                scope.left()
                waiter.wait(AGAIN)
        finally:
            del self._waiting[id(waiter)]
        return owner


class Attempts:
    """Short-lived threads for what may hang: one for each target, `ATTEMPTS` in all. `task` is
    what they do, for the names of the threads."""

    def __init__(self, task: str) -> None:
        self._task = task
        self._targets: set[str] = set()
        self._lock = (
            threading.RLock()
        )  # a signal handler may begin another above a frame that is here

    def begin(self, target: str, attempt: Callable[[], object]) -> bool:
        """Call `attempt` in a thread of its own; False if that has to wait: one at the same target
        is under way, or too many at others, or the system has no more threads."""
        with self._lock:
            if target in self._targets or len(self._targets) >= ATTEMPTS:
                return False
            self._targets.add(target)
        name = f"yarpy {self._task} {target}"
        thread = Thread(target=self._run, args=(target, attempt), name=name, daemon=True)
        try:
            thread.start()
        except RuntimeError as error:
            with self._lock:
                self._targets.discard(target)
            if threading.main_thread().is_alive():  # else Python is ending, which is no news
                log.warning("to %s %s has to wait: %s", self._task, target, error)
            return False
        return True

    @property
    def under_way(self) -> int:
        """The number of dials that have not ended yet."""
        return len(self._targets)

    def _run(self, target: str, attempt: Callable[[], object]) -> None:
        try:
            attempt()
        except Exception:
            log.exception("to %s %s failed", self._task, target)
        finally:
            with self._lock:
                self._targets.discard(target)
