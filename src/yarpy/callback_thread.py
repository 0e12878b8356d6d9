"""The thread of a connection that waits for a callback, wherever that runs.

    with in_callback_of(thread):
        ...                 # here `waited_by()` is that thread, also in what a task hands on

Rules: callbacks of an event loop run in its thread, while the thread of their connection waits for
them. What ends connections does not wait for the thread that waits for it: it asks `waited_by`
instead of `threading.current_thread`. For a task or a thread that goes on when the callback has
returned nobody waits any more.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Final


class _Wait:
    def __init__(self, thread: threading.Thread) -> None:
        self.thread = thread
        self.over = False


_CURRENT: Final[ContextVar[_Wait | None]] = ContextVar("yarpy callback", default=None)


@contextmanager
def in_callback_of(thread: threading.Thread) -> Iterator[None]:
    """Let what runs in the block, and in copies of its context meanwhile, be waited for by
    `thread`."""
    wait = _Wait(thread)
    token = _CURRENT.set(wait)
    try:
        yield
    finally:
        wait.over = True
        _CURRENT.reset(token)


def waited_by() -> threading.Thread:
    """Return the thread that waits for the callback in which this is called; where there is none,
    the current thread."""
    wait = _CURRENT.get()
    return threading.current_thread() if wait is None or wait.over else wait.thread
