"""Port: the thing with a name that programs read from and write to.

Rules: opening registers, closing gives the name back; it is a context manager and iterates over
what comes in. Everything is safe to call from any thread.
"""

from __future__ import annotations

from collections.abc import Callable

from yarpy.names.base import NameClient
from yarpy.port.assembly import open_hub
from yarpy.port.event import ConnectionEvent
from yarpy.port.mailbox import Callback, Rendezvous
from yarpy.port.reader import ReadingPort
from yarpy.wire.message import Message
from yarpy.wire.stream import DEFAULT_LIMIT


class Port(ReadingPort):
    """A plain port: every message is read once, and its sender waits until it was.

    A question that was read and is left unanswered is closed by the next `read` of that thread.

    name: begins with `/`; `...` asks the name server for one; "" opens an unregistered port.
    names: a name client, None for the default (see `yarpy.NameServer`, `yarpy.LocalNames`).
    port: the TCP port number, 0 to let the name server or the system choose.
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
        port: int = 0,
        type_: str = "",
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
                port=port,
                type_=type_,
                limit=limit,
                on_connection=on_connection,
            ),
            spin,
        )
