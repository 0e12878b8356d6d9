"""Port and BufferedPort: the things with a name that programs read from and write to.

Rules: opening registers, closing gives the name back; they are context managers and iterate over
what comes in. Everything is safe to call from any thread. What is read goes through a mailbox, the
reading policy; what is written goes straight to the links.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from yarpy.data.stamp import Stamp
from yarpy.errors import LinkClosed, PortClosed, YarpError
from yarpy.link.outbound import Outbound
from yarpy.names.base import NameClient
from yarpy.port.assembly import open_hub
from yarpy.port.base import BasePort
from yarpy.port.connection import ConnectionEvent
from yarpy.port.hub import Hub
from yarpy.port.mailbox import Callback, Fifo, Latest, Mailbox, Rendezvous
from yarpy.port.reader import Reader
from yarpy.wire.message import Message, Packet
from yarpy.wire.stream import DEFAULT_LIMIT


class MessagePort(BasePort):
    """A port that is read from and written to. Subclasses choose the mailbox of its hub."""

    def __init__(self, hub: Hub, spin: bool = False) -> None:
        super().__init__(hub)
        self._mailbox = hub.mailbox
        self._reader = Reader(hub, spin)

    def read(self, timeout: float | None = None) -> Message:
        """The next message, waiting for one if needed.

        Raises Timeout after `timeout` seconds, PortClosed if the port is closed or interrupted.
        """
        return self._reader.read(timeout)

    def poll(self) -> Message | None:
        """A message that is already there, or None."""
        return self._reader.poll()

    @property
    def waiting(self) -> int:
        """Messages that came and were not read yet."""
        return self._mailbox.waiting

    def __iter__(self) -> Iterator[Message]:
        """Messages until the port is closed or interrupted."""
        try:
            while True:
                yield self.read()
        except PortClosed:
            return

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
        envelope = envelope_of(stamp) if stamp is not None else b""
        outputs = hub.outputs
        if not outputs:
            return 0
        packet = Packet(value, envelope)
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


class Port(MessagePort):
    """A plain port: every message is read once, and its sender waits until it was.

    A question that was read and is left unanswered is closed by the next `read` of that thread.

    name: begins with `/`; `...` asks the name server for one; "" opens an unregistered port.
    names: a name client, None for the default (see `yarpy.NameServer`, `yarpy.LocalNames`).
    tcp_port: the number to listen on, 0 to let the name server or the system choose.
    port_type: what the port says it takes or sends, for those who look it up (`yarp/image`).
    callback: called with each message in its connection's thread, instead of `read`.
    spin: readers ask the socket again and again instead of sleeping: the lowest latency, one core.
    limit: the largest message accepted, in bytes.
    Raises AddressError (unusable name, or in use), NoNameServer.
    """

    def __init__(
        self,
        name: str,
        *,
        names: NameClient | None = None,
        tcp_port: int = 0,
        port_type: str = "",
        callback: Callable[[Message], None] | None = None,
        spin: bool = False,
        limit: int = DEFAULT_LIMIT,
        on_connection: Callable[[ConnectionEvent], None] | None = None,
    ) -> None:
        mailbox = Rendezvous() if callback is None else Callback(callback)
        super().__init__(
            open_hub(
                name,
                mailbox,
                names,
                tcp_port=tcp_port,
                port_type=port_type,
                limit=limit,
                on_connection=on_connection,
            ),
            spin,
        )


class BufferedPort(MessagePort):
    """A port between loops that run at their own pace.

    Reading gives the newest message, older ones are dropped and counted; with `strict` every
    message comes, in order. Writing hands each connection its message and returns; a connection
    that still sends the one before drops this one, and counts it; with `strict` the writer waits
    instead. A list may be changed after `write`, but a large array (from 4096 bytes) is sent from
    its own memory, later: write a new one each time, or `flush` before you change it. `callback`
    gets every message in its connection's thread. Other parameters as `Port`.
    """

    def __init__(
        self,
        name: str,
        *,
        strict: bool = False,
        names: NameClient | None = None,
        tcp_port: int = 0,
        port_type: str = "",
        callback: Callable[[Message], None] | None = None,
        spin: bool = False,
        limit: int = DEFAULT_LIMIT,
        on_connection: Callable[[ConnectionEvent], None] | None = None,
    ) -> None:
        mailbox: Mailbox
        mailbox = Callback(callback) if callback is not None else Fifo() if strict else Latest()
        self.strict = strict
        hub = open_hub(
            name,
            mailbox,
            names,
            tcp_port=tcp_port,
            port_type=port_type,
            limit=limit,
            on_connection=on_connection,
        )
        super().__init__(hub, spin)

    def _send_all(self, packet: Packet, outputs: tuple[Outbound, ...], wait: bool) -> int:
        if self.strict or wait:
            return super()._send_all(packet, outputs, wait)
        sent = 0
        for link in outputs:
            if not link.active or link.log:
                continue
            if link.broken:
                self._hub.drop_output(link, "the connection broke", lost=True)
                continue
            try:
                sent += link.try_send(packet)
            except LinkClosed as error:
                self._hub.drop_output(link, str(error), lost=True)
            except YarpError as error:
                self._hub.drop_output(link, str(error))
        return sent


def envelope_of(stamp: Stamp | str | bytes) -> bytes:
    """The envelope's bytes: a Stamp's text, or any one-line text up to its first control
    character. Raises TypeError for anything else."""
    if isinstance(stamp, Stamp):
        return stamp.to_text().encode()
    if not isinstance(stamp, str | bytes):
        raise TypeError(
            f"a stamp is a yarpy.Stamp or a line of text, not {stamp!r}; a message is one "
            "object, several go into a list: write([1, 2])"
        )
    data = stamp.encode() if isinstance(stamp, str) else stamp
    for index, byte in enumerate(data):
        if byte < 0x20 or byte >= 0x80:
            return data[:index]
    return data
