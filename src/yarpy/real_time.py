"""realtime(): make this process answer faster than Python does by default.

Rules: explicit, never at import; undone when used as a context manager.
"""

from __future__ import annotations

import gc
import sys

from yarpy.qos import Sched, schedule

SWITCH_INTERVAL = 0.0005  # seconds; Python's own is 0.005


def realtime(priority: int = 0, switch_interval: float = SWITCH_INTERVAL) -> _Realtime:
    """Let threads take turns every `switch_interval` seconds, so that a busy one delays messages
    less.

    With `priority` 1..99 the calling thread also gets SCHED_FIFO; that needs CAP_SYS_NICE or root
    (LocalProtocolError says so). Objects that exist are frozen: garbage collection skips them.
    Stays in force; `with yarpy.realtime(): ...` undoes it at the end.
    """
    undo = _Realtime(sys.getswitchinterval(), priority)
    if priority:
        schedule(0, Sched(1, priority))
    sys.setswitchinterval(switch_interval)
    gc.freeze()
    return undo


class _Realtime:
    """The changes that `realtime` made, to be undone."""

    def __init__(self, interval: float, priority: int) -> None:
        self._interval = interval
        self._priority = priority

    def __enter__(self) -> _Realtime:
        return self

    def __exit__(self, *details: object) -> None:
        sys.setswitchinterval(self._interval)
        gc.unfreeze()
        if self._priority:
            schedule(0, Sched(0, 0))
