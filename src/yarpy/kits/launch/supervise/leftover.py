"""Programs that a supervisor has left, here and at servers: who they are, and their end.

Rules: of a server that does not answer no second question is asked; what runs there stays.
"""

from __future__ import annotations

import signal
import time
from collections.abc import Mapping
from typing import Final

from yarpy.errors import YarpError
from yarpy.kits.launch.run.client import RunClient
from yarpy.kits.launch.supervise import process
from yarpy.names.base import NameClient
from yarpy.platform.process import KILL, signal_one

_POLL: Final = 0.02  # seconds
_GONE: Final = 2.0  # seconds after SIGKILL
_FAR: Final = 3.0  # seconds that a server may take to answer
_FAR_POLL: Final = 0.1  # seconds between questions to a server
_KILL: Final = 9  # what SIGKILL is there; this computer may have none


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


def end_away(
    found: Mapping[str, str], grace: float, names: NameClient | None = None
) -> tuple[list[str], dict[str, str]]:
    """End programs at servers, each the tag of one and its server, as `end_all`; return those that
    have run and ended, and why others may go on."""
    ended: list[str] = []
    left: dict[str, str] = {}
    silent: dict[str, str] = {}  # servers, and why
    for tag, server in found.items():
        try:
            if server not in silent:
                with RunClient(server, timeout=_FAR, names=names) as node:
                    if not node.is_running(tag):
                        continue
                    if _end_one(node, tag, grace):
                        ended.append(tag)
                    else:
                        left[tag] = "it does not end, not even when it is killed"
        except YarpError as error:
            silent[server] = str(error)
        if server in silent:
            left[tag] = silent[server]
    return ended, left


def _end_one(node: RunClient, tag: str, grace: float) -> bool:
    """Return whether a program has ended. Raises a YarpError where its server does not answer."""
    for number, seconds in ((signal.SIGTERM, grace), (_KILL, _GONE)):
        node.signal(tag, number)
        until = time.monotonic() + seconds
        while node.is_running(tag):
            if time.monotonic() > until:
                break
            time.sleep(_FAR_POLL)
        else:
            return True
    return False
