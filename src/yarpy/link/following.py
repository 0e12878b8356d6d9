"""Following: messages leave one at a time, and a monitor is told when each was confirmed.

Rules: for the monitors of one connection that watch how their messages fare. It runs in the
connection's own sending thread, which waits here; `Sender.lock` is held for a moment at a time, so
that others can look at the connection meanwhile.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final

from yarpy.errors import LocalProtocolError, Timeout, YarpError
from yarpy.monitors.base import Taken
from yarpy.transports.tcp import TcpTransport

if TYPE_CHECKING:
    from yarpy.link.sender import Sender
    from yarpy.monitors.chain import Chain

_AT_A_TIME: Final = 0.1  # seconds of each wait for an acknowledgement
_SOON, _LATER = 0.0005, 0.005  # seconds between two questions to the system


class Following:
    """Sends with `put`, waits for `sender`, and tells `chain`. Raises LocalProtocolError where
    nothing confirms."""

    def __init__(self, sender: Sender, chain: Chain, put: Callable[[Any], object]) -> None:
        self._sender = sender
        self._put = put
        self._chain = chain
        carrier, transport = sender.carrier, sender.driver.transport
        told = carrier.acks or (isinstance(transport, TcpTransport) and transport.taken(0, 0))
        if not told or carrier.delivery.at_once or carrier.connectionless:
            raise LocalProtocolError(
                f'over "{carrier.name}" nothing confirms that messages arrive, and a monitor of '
                f'"{sender.route.target}" goes by that; connect with tcp'
            )

    def send(self, queued: object) -> None:
        """Send what was queued and wait until it was confirmed. Raises LinkClosed."""
        driver, started = self._sender.driver, time.perf_counter()
        before = driver.bytes_out
        self._put(queued)
        if driver.bytes_out == before and not self._sender.gathered:
            return  # it was too late for it
        acks = self._sender.carrier.acks
        if self._wait_acknowledged() if acks else self._wait_taken():
            size = driver.bytes_out - before
            self._chain.confirmed(Taken(size, time.perf_counter() - started))

    def _wait_acknowledged(self) -> bool:
        """Whether the port at the other end acknowledged everything."""
        sender = self._sender
        window, limit = sender.window, sender.write_timeout
        while not (sender.broken or window.mute):
            until = limit.until(time.monotonic() + _AT_A_TIME)
            with sender.lock:
                try:
                    window.collect(wait=True, all_=True, until=until)
                except Timeout:
                    pass
                except YarpError:
                    sender.give_up()
                    raise
                done = not window.open
            if limit.over(done):
                raise sender.cut()
            if done:
                return True
        return False

    def _wait_taken(self) -> bool:
        """Whether the system at the other end has all bytes."""
        sender, driver, pause = self._sender, self._sender.driver, _SOON
        sender.sweep()
        while not sender.broken:
            taken = driver.transport.taken(driver.bytes_out, driver.bytes_in)
            if taken is None:
                return False
            if taken[0] >= driver.bytes_out:
                return True
            time.sleep(pause)
            pause = min(2 * pause, _LATER)
        return False
