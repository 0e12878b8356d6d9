"""Backlog: a writer never waits, and so many messages wait for a reader that is behind.

Rules: a message leaves in the writer's thread as far as it goes without waiting. What cannot begin
to waits for the connection's own thread, in order, with at most `most` others and `held` bytes;
where there is no room the newest message is dropped. (A high-water mark.)
"""

from __future__ import annotations

import time
from collections import deque
from typing import TYPE_CHECKING

from yarpy.link.ending import NOW
from yarpy.link.send.outbox import MOMENT, Outbox, Rest
from yarpy.link.send.sender import NOTHING, PART, Hold

if TYPE_CHECKING:
    from yarpy.link.send.queued import Queue
    from yarpy.link.send.sender import Sender
    from yarpy.wire.message import Packet


class Backlog(Outbox):
    """Keeps the first `most` messages, of at most `held` bytes, in `queue`."""

    def __init__(self, sender: Sender, queue: Queue, most: int, held: int) -> None:
        super().__init__(sender)
        self._queue = queue
        self._most = most
        self._held = held
        self._sizes: deque[int] = deque()  # of what waits, and of some that does not any more
        self._bytes = 0

    def put(self, packet: Packet, until: float | None, due: float | None) -> bool | Rest:
        sender, queue = self.sender, self._queue
        if sender.held():
            return self.beneath()
        if sender.broken or queue.stopped:
            sender.counter.drops += 1
            raise sender.gone()
        if not queue.pending:
            # Another thread that does something short under the lock, as the flusher of a burst.
            hold = Hold(sender, NOW if sender.halfway else time.monotonic() + MOMENT)
            try:
                sent = sender.transmit(packet, NOW) if hold.take() else NOTHING
            finally:
                hold.give()
            if sent is PART:
                sender.leave()
            if sent is not NOTHING:
                return True
        return self._hand_over(packet, due) or self.drop()

    def _hand_over(self, packet: Packet, due: float | None) -> bool:
        """Let the connection's thread send a message; return False if there is no room."""
        if not self.sender.carrier.prepare(packet):
            return False
        size = len(packet.foreign) if packet.foreign is not None else sum(map(len, packet.blocks))
        sizes, queue = self._sizes, self._queue
        while len(sizes) > queue.pending:
            self._bytes -= sizes.popleft()
        if self._bytes + size > self._held or not queue.put(packet, due, self._most):
            return False
        sizes.append(size)
        self._bytes += size
        return True
