"""Direct: a message leaves in the thread that wrote it.

Rules: the writer waits while its reader is behind, as backpressure. A connection's own thread, for
which nobody waits in person, sends in the same way and goes on when the port is interrupted.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from yarpy.link.ending import NOW
from yarpy.link.send.outbox import MOMENT, Outbox, Rest
from yarpy.link.send.sender import ALL, NOTHING, Hold

if TYPE_CHECKING:
    from yarpy.link.ending import Ending
    from yarpy.link.send.sender import Sender
    from yarpy.wire.message import Packet


class Direct(Outbox):
    """`ending`: whom it obeys, by default the port's."""

    def __init__(self, sender: Sender, ending: Ending | None = None) -> None:
        super().__init__(sender)
        self._ending = ending

    def offer(
        self, packet: Packet, until: float | None = None, due: float | None = None
    ) -> bool | Rest:
        sender = self.sender
        if sender.chain is not None:
            found = self.passed(packet)
            if found is None:
                return False
            packet = found
        if until is not None or sender.slow.limit is not None or due is not None:
            return self.put(packet, until, due)
        if sender.held():
            return self.beneath()
        with sender.lock:
            sender.driver.ending = sender.ending
            sent = sender.transmit(packet, None)
        return sent is ALL or self._left(packet, sent is NOTHING, None, None)

    def put(self, packet: Packet, until: float | None, due: float | None) -> bool | Rest:
        sender = self.sender
        if sender.held():
            return self.beneath()
        limit = until
        if due is not None:
            if time.monotonic() >= due:
                return self.drop(late=True)
            limit = due if until is None else min(until, due)
        limit = sender.slow.limit_of(limit)
        hold = Hold(sender, limit, self._ending)
        try:
            if not hold.take() and sender.draining:  # which takes no longer than a moment
                hold = Hold(sender, time.monotonic() + MOMENT, self._ending)
                hold.take()
            sent = sender.transmit(packet, limit) if hold.held else NOTHING
        finally:
            hold.give()
        if sender.slow.over(sent is ALL):
            sender.counter.drops += sent is NOTHING
            raise sender.cut()
        return sent is ALL or self._left(packet, sent is NOTHING, until, due)

    def put_due(self, packet: Packet, due: float | None) -> None:
        """Send what waited in a queue, unless it is too late by now."""
        self.put(packet, None, due)

    def _left(
        self, packet: Packet, whole: bool, until: float | None, due: float | None
    ) -> bool | Rest:
        """Handle a message of which the `whole`, or a part, has not left in time; return its
        rest."""
        late = due is not None and time.monotonic() >= due
        if until == NOW and not (whole and late):
            return Rest(self, packet if whole else None, due)
        if whole:
            self.drop(late)
        else:
            self.sender.leave()
        (self._ending or self.sender.ending).check()
        return not whole
