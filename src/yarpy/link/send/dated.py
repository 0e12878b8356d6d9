"""Dated: a message has a deadline, after which it is not sent any more.

Rules: it is as old as its stamp says, or new when it is written. One that is late already costs
no work; one that waits, for its reader or in a queue, is dropped when its time comes. What has
begun to leave leaves whole.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from yarpy.link.send.outbox import Outbox, Rest
from yarpy.link.timing import age_of

if TYPE_CHECKING:
    from yarpy.wire.message import Packet


class Dated(Outbox):
    """In front of another outbox; `limit` in seconds."""

    def __init__(self, box: Outbox, limit: float) -> None:
        super().__init__(box.sender)
        self._box = box
        self._limit = limit

    def offer(
        self, packet: Packet, until: float | None = None, due: float | None = None
    ) -> bool | Rest:
        age = age_of(packet.envelope.decode()) if packet.envelope else None
        now = time.monotonic()
        due = now + self._limit - max(age or 0.0, 0.0)
        if now >= due:
            return self.drop(late=True)
        return self._box.offer(packet, until, due)
