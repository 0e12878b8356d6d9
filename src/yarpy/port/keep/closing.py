"""Closing: the steps in which a port ends, each done once, whatever cuts one short.

Rules: one thread does them; another one that closes the same port waits until it has. A frame
beneath that does them already (of a signal handler, of a callback) is not waited for: it goes on
when that returns; where the signal ends the program, the thread that closes everything then does
them in its place. What a step meets is no reason to leave out the others. After Ctrl-C the steps
that are left have HURRY seconds, and it is raised behind them, as is what another signal handler
raises; a step that was cut is done again by the next call.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from typing import Final

from yarpy import linger
from yarpy.errors import YarpError
from yarpy.log import logger
from yarpy.scope import Scope, apart, outside

log = logger("yarpy.port")

HURRY: Final = 0.3  # seconds

# What is done, and by when: the share of the time for closing that is over then.
Step = tuple[Callable[[], object], float]


class Closing:
    """The end of the port that `name` gives."""

    def __init__(self, name: Callable[[], str], steps: Sequence[Step]) -> None:
        self._name = name
        self._todo = [*steps]
        self._lock = threading.RLock()  # held by the thread that closes, for as long as that takes
        self._closer = 0  # that thread

    @property
    def done(self) -> bool:
        """Return whether every step was done."""
        return not self._todo

    def forget(self) -> None:
        """In a forked process: the port is not its own, and nothing is to be done."""
        self._todo = []
        self._lock = threading.RLock()  # of a thread that may not exist here
        self._closer = 0

    def run(self, seconds: float, wait: bool = True, last: float = 0.0) -> None:
        """Do what is left to do, in so many seconds; the last step has `last` seconds at least,
        whatever the others took. With `wait` False, do nothing if another thread is at it."""
        me = threading.get_ident()
        if self._closer == me:
            return
        if linger.suspends(self._closer):
            self._run(seconds, last)
            return
        if not self._lock.acquire(blocking=wait):
            return
        try:
            self._closer = me
            if self._todo:
                self._run(seconds, last)
        finally:
            self._closer = 0
            self._lock.release()

    def _run(self, seconds: float, last: float) -> None:
        begun = time.monotonic()
        limit = begun + seconds
        cut: BaseException | None = None
        for step in (*self._todo,):
            act, share = step
            until = min(begun + share * seconds, limit)
            if cut is None and len(self._todo) == 1:
                until = max(until, time.monotonic() + last)
            try:
                _do(act, until)
            except YarpError as error:
                log.info("%s: while closing: %s", self._name(), error)
            except BaseException as error:
                if not _may_be_the_programs(error):
                    log.exception("%s: a defect while closing", self._name())
                    self._todo.remove(step)
                    continue
                cut = cut or error
                limit = min(limit, time.monotonic() + HURRY)
                continue
            self._todo.remove(step)
        if cut is not None:
            raise cut


@apart
def _do(act: Callable[[], object], until: float) -> None:
    with outside(), Scope(until):
        act()


def _may_be_the_programs(error: BaseException) -> bool:
    """Return whether an error may have come out of a signal handler, which runs in the main thread
    alone, rather than from the system or a defect."""
    if isinstance(error, OSError) and error.errno is not None:
        return False
    main = threading.current_thread() is threading.main_thread()
    return main or not isinstance(error, Exception)
