"""Writer: a port that can write."""

from __future__ import annotations

from yarpy.data.stamp import Stamp
from yarpy.errors import LinkClosed, YarpError
from yarpy.link.outbound import Outbound
from yarpy.port.base import BasePort
from yarpy.wire.message import Packet


class Writer(BasePort):
    """A port that can write."""

    def write(self, value: object, stamp: Stamp | str | None = None, *, wait: bool = False) -> int:
        """Send `value` to every connected port; returns how many connections took it.

        When it returns, the message is in the system's hands (in a burst: about to be, at the
        latest 0.2 ms later) and `value` may be changed. Up to 256 messages per connection may be
        on their way unacknowledged; beyond that a writer waits for its slowest reader. With `wait`
        it returns when every reader that acknowledges has taken this message. `stamp` travels as
        the envelope. A connection that breaks is dropped, counted, and mended in the background.
        Raises PortClosed; TypeError, ValueError or OverflowError for what cannot be sent.
        """
        hub = self._hub
        if hub.closing or hub.interrupted:
            self._check_open()
        outputs = hub.outputs
        if not outputs:
            return 0
        packet = Packet(value, envelope_of(stamp) if stamp is not None else b"")
        if hub.monitoring.output is not None:
            passed = hub.monitoring.output.send(packet)
            if passed is None:
                for link in outputs:
                    link.counter.drops += 1
                return 0
            packet = passed
        return self._send_all(packet, outputs, wait)

    def _send_all(self, packet: Packet, outputs: tuple[Outbound, ...], wait: bool) -> int:
        sent = 0
        for link in outputs:
            if not link.active or link.log:
                continue
            try:
                sent += link.send(packet)
                if wait:
                    link.wait_acknowledged()
            except LinkClosed as error:
                self._hub.drop_output(link, str(error), lost=True)
            except YarpError as error:
                self._hub.drop_output(link, str(error))
        return sent

    def flush(self, timeout: float | None = None) -> bool:
        """Wait until every message was sent and, where readers acknowledge, taken."""
        done = True
        for link in self._hub.outputs:
            try:
                link.wait_acknowledged(timeout)
            except YarpError:
                done = False
        return done


def envelope_of(stamp: Stamp | str | bytes) -> bytes:
    """The envelope's bytes: a Stamp's text, or any one-line text up to its first control
    character."""
    if isinstance(stamp, Stamp):
        return stamp.to_text().encode()
    data = stamp.encode() if isinstance(stamp, str) else stamp
    for index, byte in enumerate(data):
        if byte < 0x20 or byte >= 0x80:
            return data[:index]
    return data
