"""Fork: what a process does before it forks, and a forked child before anything else.

Rules: the only hook of the system that this library sets. A room that has a thread, a socket or a
lock which a child must not share registers here, when it first has it. What one of them raises is
no reason to leave out the others.

A fork waits for the imports of other threads: in the child, Python would keep a module that is half
imported locked for ever, and connections import what they need while they are made. One that it did
not see, or did not wait for, is forgotten in the child, which imports that module anew.
"""

from __future__ import annotations

import os
import sys
import threading
import time
from collections.abc import Callable
from types import FrameType
from typing import Any, Final
from weakref import WeakSet

Action = Callable[[], object]

IMPORTING: Final = 0.5  # seconds for which a fork waits for another thread's import, once
_LOOK: Final = 0.001  # seconds between two looks whether it is over

_endless: set[int] = set()  # threads whose import took longer: perhaps the whole program runs in it
_actions: list[Action] = []
_locks: WeakSet[Any] = WeakSet()


def after_in_child(action: Action) -> None:
    """Call `action` in every child that is forked from now on, in the order of these calls. Systems
    that do not fork, such as Windows, have no use for it."""
    if not _actions and hasattr(os, "register_at_fork"):
        os.register_at_fork(before=_wait_for_imports, after_in_child=_start_over)
    _actions.append(action)


def lock() -> Any:
    """Return an RLock for what a whole process shares. In a forked child it is free, whichever
    thread held it: that thread is not there, and nobody else would ever release it. What the lock
    guards has to be whole at every moment."""
    made: Any = threading.RLock()
    if not _locks:
        after_in_child(_free)
    _locks.add(made)
    return made


def _free() -> None:
    for each in [*_locks]:
        if not each._is_owned():  # the thread that forked is here, and releases what it holds
            each._at_fork_reinit()


def _wait_for_imports() -> None:
    limit = time.monotonic() + IMPORTING
    while importing := _importing() - _endless:
        if time.monotonic() > limit:
            _endless.update(importing)
            return
        time.sleep(_LOOK)


def _importing() -> set[int]:
    """The other threads that are importing something."""
    found = set()
    for thread, top in sys._current_frames().items():
        frame: FrameType | None = top
        while frame is not None and thread != threading.get_ident():
            if frame.f_code.co_filename == "<frozen importlib._bootstrap>":
                found.add(thread)
                break
            frame = frame.f_back
    return found


def _forget_imports() -> None:
    """Forget what threads that are not here had half imported, and the locks that they hold."""
    importer: Any = sys.modules.get("_frozen_importlib")
    for name, reference in [*getattr(importer, "_module_locks", {}).items()]:
        held = reference()
        if getattr(held, "owner", None) in (None, threading.get_ident()):
            continue
        importer._module_locks.pop(name, None)
        spec = getattr(sys.modules.get(name), "__spec__", None)
        if getattr(spec, "_initializing", False):
            del sys.modules[name]


def _start_over() -> None:
    _forget_imports()
    for action in tuple(_actions):
        try:
            action()
        except Exception as error:
            sys.excepthook(type(error), error, error.__traceback__)
