"""Readiness: waiting for the first of several slow readers to take more.

Rules: a connection with a rest of a message waits for room in its socket, another one for an
acknowledgement. What neither shows, such as a thread that is in the way, the caller finds out by
looking again after a while.
"""

from __future__ import annotations

import select
import sys
import time
from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from yarpy.link.send.outbound import Outbound


def wait_for_any(links: Iterable[Outbound], seconds: float) -> bool:
    """Wait until one of them can go on; False if none could within `seconds`."""
    waiting: dict[int, bool] = {}  # whether for room, by descriptor
    for link in links:
        sock = link.driver.transport.sock
        if sock is None or (number := sock.fileno()) < 0:
            continue  # in this process, or closed by another thread
        waiting[number] = link.sender.halfway
    if not waiting:
        time.sleep(seconds)
        return False
    if sys.platform == "win32" or not hasattr(select, "poll"):
        readers = [number for number, room in waiting.items() if not room]
        return any(select.select(readers, [n for n in waiting if waiting[n]], [], seconds))
    poll = select.poll()
    for number, room in waiting.items():
        poll.register(number, select.POLLOUT if room else select.POLLIN)
    return bool(poll.poll(seconds * 1000))
