"""Recent: the last messages wait for a reader that is behind, and a writer does not.

Rules: a message leaves in the writer's thread, without a copy, if the reader takes it within
GRACE. One that does not is behind, until it takes one at once again: what it does not take at
once waits for the connection's own thread, with so many others. Where there is no room, the oldest
that waits gives way, and counts as `replaced`.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Final

from yarpy.link.ending import NOW, moment
from yarpy.link.send.outbox import Outbox, Rest
from yarpy.link.send.sender import ALL, NOTHING, PART, Hold

if TYPE_CHECKING:
    from yarpy.link.send.queued import Queue
    from yarpy.link.send.sender import Sender
    from yarpy.wire.message import Packet

GRACE: Final = 0.1  # seconds, once for each time that a reader falls behind


class Recent(Outbox):
    """Keeps the last `size` messages in `queue`."""

    def __init__(self, sender: Sender, queue: Queue, size: int) -> None:
        super().__init__(sender)
        self.behind = False
        self._queue = queue
        self._size = size

    def put(self, packet: Packet, until: float | None, due: float | None) -> bool | Rest:
        sender, queue = self.sender, self._queue
        if sender.held():
            return self.beneath()
        if sender.broken or queue.stopped:
            sender.counter.drops += 1
            raise sender.gone()
        if queue.pending:
            return self.hand_over(packet, due)
        return _Offered(self, packet, due).offer(until)

    def hand_over(self, packet: Packet, due: float | None) -> bool:
        """Let the connection's thread send a message, if it is still wanted then."""
        if not self.sender.carrier.prepare(packet):  # what cannot be sent is the writer's error
            return self.drop()
        self._queue.push(packet, due, self._size)
        return True


class _Offered(Rest):
    """A message that the reader may take for a while."""

    __slots__ = ("_by", "_recent")

    def __init__(self, box: Recent, packet: Packet, due: float | None) -> None:
        super().__init__(box, packet, due)
        self._recent = box
        self._by = moment(NOW if box.behind else GRACE) or NOW

    def offer(self, until: float | None) -> bool | Rest:
        """As `Outbox.offer`."""
        box, sender, packet = self._recent, self._box.sender, self._packet
        again = until == NOW and time.monotonic() < self._by
        by = NOW if until == NOW else self._by if until is None else min(until, self._by)
        if packet is None:
            sent = ALL if sender.finish(by) else PART
        else:
            hold = Hold(sender, by)
            try:
                sent = sender.transmit(packet, by) if hold.take() else NOTHING
            finally:
                hold.give()
        if sent is ALL:
            box.behind = False
            return True
        if sent is PART:
            self._packet = None
        if again:
            return self
        box.behind = True
        if sent is PART or packet is None:
            sender.leave()
            return True
        return box.hand_over(packet, self._due)
