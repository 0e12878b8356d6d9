"""BufferedPort: reads without holding up its senders, writes without waiting for its readers."""

from __future__ import annotations

from collections.abc import Callable

from yarpy.errors import LinkClosed, YarpError
from yarpy.link.outbound import Outbound
from yarpy.names.base import NameClient
from yarpy.port.assembly import open_hub
from yarpy.port.event import ConnectionEvent
from yarpy.port.mailbox import Callback, Fifo, Latest, Mailbox
from yarpy.port.reader import ReadingPort
from yarpy.wire.message import Message, Packet
from yarpy.wire.stream import DEFAULT_LIMIT


class BufferedPort(ReadingPort):
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
        hub = open_hub(
            name,
            mailbox,
            names,
            port=port,
            type_=type_,
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
