"""Lossy: the newest message wins, and a writer never waits.

Rules: a message that comes while the one before is still on its way is not sent, before any work is
done on it, and counts as `replaced`. It leaves in the writer's thread as far as it goes without
waiting; the flusher sends the rest, and nothing else begins before it has left. People look at it,
or its text takes long to make: then a thread of the connection sends, a few messages behind and so
often as the carrier says.

A reader that is quick may be a thread of the same program. A writer that floods it would keep the
interpreter to itself, so it gives way for a moment, a few times, before a message is not sent.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Final

from yarpy.link.ending import NOW
from yarpy.link.send.outbox import MOMENT, Outbox, Rest
from yarpy.link.send.sender import ALL, NOTHING, PART, Sent

if TYPE_CHECKING:
    from yarpy.link.send.queued import Queue
    from yarpy.link.send.sender import Sender
    from yarpy.wire.message import Packet

GIVEN: Final = 20e-6  # seconds that a flooding writer gives to a quick reader
IN_VAIN: Final = 16  # times in a row; a reader that has taken nothing then is not quick


class Lossy(Outbox):
    """`queue`: of a thread that sends instead of the writer's."""

    def __init__(self, sender: Sender, queue: Queue | None = None) -> None:
        super().__init__(sender)
        self._queue = queue
        self._due = 0.0  # when the carrier's interval is over
        self._given = 0  # times that it has given way since the last message left

    def offer(
        self, packet: Packet, until: float | None = None, due: float | None = None
    ) -> bool | Rest:
        sender, queue = self.sender, self._queue
        if sender.held():
            return self.beneath()
        if sender.broken or (queue is not None and queue.stopped):
            sender.counter.drops += 1
            raise sender.gone()
        if queue is None and sender.chain is None:
            sent = self._send(packet)
            if sent is NOTHING and self._given < IN_VAIN and sender.floods and sender.window.quick:
                self._given += 1
                time.sleep(GIVEN)
                sent = self._send(packet)
            if sent is not NOTHING:
                self._given = 0
        else:
            if self._send(None) is NOTHING or not self._is_time():
                return self.replace()
            found = self.passed(packet)
            if found is None:
                return False
            if queue is not None:
                if not sender.carrier.prepare(found):
                    return self.drop()
                return queue.put(found, due, sender.carrier.delivery.backlog) or self.replace()
            sent = self._send(found)
        if sent is PART:
            sender.leave()
        return sent is not NOTHING or self.replace()

    def put(self, packet: Packet, until: float | None, due: float | None) -> bool | Rest:
        return self.offer(packet, until, due)

    def _send(self, packet: Packet | None) -> Sent:
        """Send what leaves without waiting, or (no packet) say whether something would begin to."""
        sender, queue = self.sender, self._queue
        if queue is not None and not queue.has_room(sender.carrier.delivery.backlog):
            return NOTHING
        window, lock = sender.window, sender.lock
        try:
            if not lock.acquire(blocking=False) and not (
                queue is None
                and not sender.halfway
                and sender.ending.acquire(lock, time.monotonic() + MOMENT)
            ):
                return NOTHING if queue is None or window.open else ALL
            if (
                window.open
                and not window.has_room()
                and not sender.broken
                and not sender.keeps_up()
            ):
                return NOTHING
            return ALL if packet is None else sender.transmit(packet, NOW)
        finally:
            try:  # at once: a signal handler could raise behind any other call
                lock.release()
            except RuntimeError:
                pass  # another thread has it

    def _is_time(self) -> bool:
        """Return whether the carrier's interval is over. On the average, so that no beat is
        missed."""
        interval = self.sender.carrier.delivery.interval
        if interval:
            now = time.perf_counter()
            if now < self._due:
                return False
            self._due = max(self._due + interval, now)
        return True
