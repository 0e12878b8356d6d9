"""Followed: messages leave one at a time, and a monitor is told when each was confirmed.

Rules: for the monitors of one connection that watch how their messages fare. It runs in the
connection's own sending thread, which waits here; the sender's lock is held for a moment at a time,
so that others can look at the connection meanwhile.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Final

from yarpy.errors import LocalProtocolError, YarpError
from yarpy.link.ending import NEVER, NOW
from yarpy.link.send.direct import Direct
from yarpy.link.send.outbox import Rest
from yarpy.link.send.sender import Hold
from yarpy.monitors.base import Taken

if TYPE_CHECKING:
    from yarpy.link.send.sender import Sender
    from yarpy.monitors.chain import Chain
    from yarpy.wire.message import Packet

_AT_A_TIME: Final = 0.1  # seconds of each wait for an acknowledgement
_SOON, _LATER = 0.0005, 0.005  # seconds between two questions to the system


class Followed(Direct):
    """Sends, waits, and tells `chain`. Raises LocalProtocolError where nothing confirms."""

    def __init__(self, sender: Sender, chain: Chain) -> None:
        super().__init__(sender, NEVER)
        self._chain = chain
        carrier, transport = sender.carrier, sender.driver.transport
        told = carrier.acks or transport.taken(0, 0)
        if not told or carrier.delivery.at_once or carrier.delivery.connectionless:
            raise LocalProtocolError(
                f'over "{carrier.name}" nothing confirms that messages arrive, and a monitor of '
                f'"{sender.route.target}" goes by that; connect with tcp'
            )

    def put(self, packet: Packet, until: float | None, due: float | None) -> bool | Rest:
        """Send what was queued and wait until it was confirmed. Raises LinkClosed."""
        driver, started = self.sender.driver, time.perf_counter()
        before = driver.bytes_out
        sent = super().put(packet, until, due)
        if driver.bytes_out == before and not self.sender.gathered:
            return sent  # it was too late for it
        acks = self.sender.carrier.acks
        if self._wait_acknowledged() if acks else self._wait_taken():
            size = driver.bytes_out - before
            self._chain.confirmed(Taken(size, time.perf_counter() - started))
        return sent

    def _wait_acknowledged(self) -> bool:
        """Return whether the port at the other end acknowledged everything."""
        sender = self.sender
        window, slow = sender.window, sender.slow
        while not (sender.broken or window.mute):
            until = slow.limit_of(time.monotonic() + _AT_A_TIME)
            hold = Hold(sender, None, NEVER)
            try:
                hold.take()
                try:
                    done = window.collect(wait=True, all_=True, until=until)
                except YarpError:
                    sender.give_up()
                    raise
            finally:
                hold.give()
            if slow.over(done):
                raise sender.cut()
            if done:
                return True
        return False

    def _wait_taken(self) -> bool:
        """Return whether the system at the other end has all bytes."""
        sender, driver, pause = self.sender, self.sender.driver, _SOON
        while not sender.broken:
            sender.drain(NOW)
            taken = driver.transport.taken(driver.bytes_out, driver.bytes_in)
            if taken is None:
                return False
            if taken[0] >= driver.bytes_out and not sender.gathered:
                return True
            time.sleep(pause)
            pause = min(2 * pause, _LATER)
        return False
