"""Threads that a signal handler cannot leave half started, and work in them that none cuts.

Rules: what may be started in the main thread is a `Thread` of this file. Where an exception out of
a signal handler cuts `start` of Python's own, the new thread may wait for ever for a lock that the
cut one left locked, or end before it has done anything. Here another thread, which no handler
cuts, starts it; that one begins within a single call of the interpreter.
"""

from __future__ import annotations

import sys
import threading
from _thread import allocate_lock, start_new_thread
from collections.abc import Callable
from functools import partial
from importlib import import_module
from typing import Any, TypeVar

from yarpy.scope import Flag

T = TypeVar("T")


class Thread(threading.Thread):
    """As `threading.Thread`; an exception out of a signal handler in `start` leaves it running, or
    not begun."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self._turn = allocate_lock()  # who was cut may start it once more: one after the other

    def start(self) -> None:
        """Begin. Raises RuntimeError where threads have run out, or if it has begun before."""
        if threading.current_thread() is not threading.main_thread():
            super().start()
            return
        begun, failed = Flag(), list[BaseException]()

        def begin() -> None:
            try:
                with self._turn:
                    threading.Thread.start(self)
            except BaseException as error:
                failed.append(error)
            finally:
                begun.set()

        start_new_thread(begin, ())
        begun.wait()
        if failed:
            raise failed[0]


def undisturbed(function: Callable[[], T], name: str = "yarpy undisturbed") -> T:
    """Return function(), which no signal handler cuts: from the main thread it is called in another
    one, of that name, and comes to its end also where this one is cut. It must not wait for long.
    Raises what it raises, and RuntimeError where threads have run out."""
    if threading.current_thread() is not threading.main_thread():
        return function()
    found: list[T] = []
    failed: list[BaseException] = []
    done = allocate_lock()
    done.acquire()

    def run() -> None:
        try:
            found.append(function())
        except BaseException as error:
            failed.append(error)
        finally:
            done.release()

    Thread(target=run, name=name, daemon=True).start()
    done.acquire()
    if failed:
        raise failed.pop()  # it would keep itself, and what its frames have, otherwise
    return found[0]


def imported(name: str) -> Any:
    """Return a module, which is imported if need be. An exception out of a signal handler in the
    middle of that would leave it half done: numpy can then not be imported any more, and other
    threads may wait for its lock for ever."""
    if name in sys.modules:
        return import_module(name)  # once it is whole, if another thread is about to
    return undisturbed(partial(import_module, name))
