"""Programs that a killed supervisor has left: who they are, and their end."""

from __future__ import annotations

import signal
import time
from collections.abc import Mapping
from typing import Final

from yarpy.kits.launch.supervise import process
from yarpy.platform.process import KILL, signal_one

_POLL: Final = 0.02  # seconds
_GONE: Final = 2.0  # seconds after SIGKILL


def told(found: Mapping[int, str]) -> str:
    """Return who is still there, for people."""
    return ", ".join(f"{name} (pid {pid})" for pid, name in sorted(found.items()))


def end_all(found: Mapping[int, str], grace: float) -> list[int]:
    """End processes: with SIGTERM, and after `grace` seconds with SIGKILL; return those that are
    there nevertheless."""
    starts = {pid: one.start for pid in found if (one := process.look(pid)) is not None}

    def alive() -> list[int]:
        looks = ((pid, process.look(pid)) for pid in starts)
        return [
            pid for pid, one in looks if one is not None and one.alive and one.start == starts[pid]
        ]

    for number, seconds in ((signal.SIGTERM, grace), (KILL, _GONE)):
        for pid in alive():
            signal_one(pid, number)
        until = time.monotonic() + seconds
        while alive() and time.monotonic() < until:
            time.sleep(_POLL)
    return alive()
