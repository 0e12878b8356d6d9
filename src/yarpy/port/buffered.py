"""BufferedPort: reads without holding up its senders, writes without waiting for its readers."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from yarpy.errors import LinkClosed, PortClosed, YarpError
from yarpy.link.outbound import Outbound
from yarpy.names.base import NameClient
from yarpy.port.event import ConnectionEvent
from yarpy.port.hub import Hub
from yarpy.port.mailbox import Callback, Fifo, Latest, Mailbox
from yarpy.port.port import Reader, Writer, _is_log
from yarpy.wire.message import Message, Packet
from yarpy.wire.stream import DEFAULT_LIMIT


class BufferedPort(Writer):
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
        strict: bool = False,
        *,
        names: NameClient | None = None,
        port: int = 0,
        type_: str = "",
        callback: Callable[[Message], None] | None = None,
        spin: bool = False,
        limit: int = DEFAULT_LIMIT,
        on_connection: Callable[[ConnectionEvent], None] | None = None,
    ) -> None:
        mailbox: Mailbox
        mailbox = Callback(callback) if callback is not None else Fifo() if strict else Latest()
        self.strict = strict
        hub = Hub(
            name,
            mailbox,
            names,
            port=port,
            type_=type_,
            limit=limit,
            on_connection=on_connection,
        )
        super().__init__(hub)
        self._mailbox = mailbox
        self._reader = Reader(hub, spin)

    def read(self, timeout: float | None = None) -> Message:
        """The newest message that was not read yet (`strict`: the next), waiting for one if needed.

        Raises Timeout after `timeout` seconds, PortClosed if the port is closed or interrupted.
        """
        return self._reader.read(timeout)

    def poll(self) -> Message | None:
        """A message that is already there, or None."""
        return self._mailbox.poll()

    @property
    def waiting(self) -> int:
        """Messages that came and were not read yet."""
        return self._mailbox.waiting

    def _send_all(self, packet: Packet, outputs: tuple[Outbound, ...], wait: bool) -> int:
        if self.strict or wait:
            return super()._send_all(packet, outputs, wait)
        sent = 0
        for link in outputs:
            if not link.active or _is_log(link):
                continue
            if link.broken:
                self._hub.drop_output(link, "the connection broke", lost=True)
                continue
            try:
                sent += link.offer(packet)
            except LinkClosed as error:
                self._hub.drop_output(link, str(error), lost=True)
            except YarpError as error:
                self._hub.drop_output(link, str(error))
        return sent

    def __iter__(self) -> Iterator[Message]:
        """Messages until the port is closed or interrupted."""
        try:
            while True:
                yield self.read()
        except PortClosed:
            return
