"""Crowd: how many senders of datagrams a port takes, and which of them leaves for another one.

Rules: each costs us a thread and a socket, but costs its sender nothing, since no connection is
left that would end with the sender's program. So a port takes MOST, a quarter of them from one
other computer, and turns the next one away before it says where to send to. One that has sent
nothing for a while, and that no port calls its own when asked, gives its place to the next.
"""

from __future__ import annotations

import time
from collections.abc import Iterable
from typing import Final

from yarpy.link.begin.admission import Peer
from yarpy.link.receive.inbound import Inbound

MOST: Final = 256
QUIET: Final = 10.0  # seconds without a message after which a sender may have to leave
REPLACED: Final = "it sent nothing, and others wanted its place"


def room(links: Iterable[Inbound], peer: Peer) -> tuple[str, Inbound | None]:
    """Return why the port takes no more inputs over datagrams from that peer ("" if it does), and
    which of its `links` could leave instead."""
    found = [link for link in links if link.carrier.delivery.connectionless]
    of_peer = [link for link in found if link.driver.admission.peer.address == peer.address]
    if not peer.here and 4 * len(of_peer) >= MOST:
        found = of_peer
    elif len(found) < MOST:
        return "", None
    why = (
        f"there are too many inputs over datagrams already, of {MOST} and a quarter of them from "
        "one computer; try again later, or use tcp"
    )
    return why, next((link for link in found if _is_idle(link)), None)


def _is_idle(link: Inbound) -> bool:
    silent = not link.counter.messages or time.perf_counter() - link.receiver.heard > QUIET
    return silent and not (link.vouched or link.closing)
