"""Outbox: what becomes of a message that a port hands to one of its connections.

Rules: one method, `offer(packet, until)`. Which outbox a connection has is decided when it opens
and when its options change, never for a message: Direct (the caller's thread), Queued (a thread of
its own), Lossy (the newest wins), Backlog (the first ones wait, and nobody for them), Followed (one
at a time, each confirmed), and Dated around one of them (a message has a deadline). What is offered
until NOW is never waited for: what takes waiting comes back as a Rest, which is offered again.
Every message is counted once: as sent, as `replaced` where newer ones win, or as a drop.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from yarpy.link.ending import NOW
from yarpy.log import logger

if TYPE_CHECKING:
    from yarpy.link.send.sender import Sender
    from yarpy.wire.message import Packet

log = logger("yarpy.link")

MOMENT: Final = 0.02  # seconds for another thread that does something short under the lock


class Outbox:
    """Of one connection; `sender` puts on the wire what is to leave."""

    def __init__(self, sender: Sender) -> None:
        self.sender = sender

    def offer(
        self, packet: Packet, until: float | None = None, due: float | None = None
    ) -> bool | Rest:
        """Send a message; return False if it was dropped or replaced, and counted.

        It returns once the kernel, the gathering of a burst or a queue has the message, and waits
        for that until `until`. A message of which a part has left by then follows by itself. What
        cannot begin to leave until `due` is dropped as too late. Raises LinkClosed, PortClosed, and
        what the carrier raises for a value that it cannot encode.
        """
        found = self.passed(packet)
        return found is not None and self.put(found, until, due)

    def put(self, packet: Packet, until: float | None, due: float | None) -> bool | Rest:
        """As `offer`, for what the monitors have passed."""
        raise NotImplementedError

    def passed(self, packet: Packet) -> Packet | None:
        """Return what the monitors make of a packet; None, and counted, if one drops it."""
        chain = self.sender.chain
        if chain is None:
            return packet
        found = chain.send(packet)
        if found is None:
            self.sender.counter.drops += 1
        return found

    def drop(self, late: bool = False) -> bool:
        """Count a message that is not sent; return False."""
        self.sender.counter.drops += 1
        self.sender.late += late
        return False

    def replace(self) -> bool:
        """Count a message that gives way to a newer one; return False."""
        self.sender.counter.replaced += 1
        return False

    def beneath(self) -> bool:
        """Drop a message that is written while the frame beneath, under a signal handler or a
        callback, is at work on the connection: it would wait for itself."""
        route = self.sender.route
        log.warning(
            "%s: a message to %s is dropped: it was written by a signal handler, or callback, that "
            "interrupted another write of the same thread",
            route.source,
            route.target,
        )
        return self.drop()


class Rest:
    """The work left for a message: all of it, or (no packet) its second part."""

    __slots__ = ("_box", "_due", "_packet")

    def __init__(self, box: Outbox, packet: Packet | None, due: float | None) -> None:
        self._box = box
        self._packet = packet
        self._due = due

    def offer(self, until: float | None) -> bool | Rest:
        """As `Outbox.offer`; monitors are not asked again."""
        box, packet = self._box, self._packet
        if packet is not None:
            return box.put(packet, until, self._due)
        sender = box.sender
        if not sender.finish(until):
            if until == NOW:
                return self
            sender.leave()
            sender.ending.check()
        return True

    def leave(self) -> None:
        """Its writer does not come back."""
        if self._packet is None:
            self._box.sender.leave()
        else:
            self._box.drop()
