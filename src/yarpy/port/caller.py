"""Caller: asks one port, again and again, without having a port of its own.

Rules: one connection, dialled when made; the port asked sees the name it is given (un-rooted, so
that nobody is displaced) and nothing is registered anywhere. Not for several threads at once.
"""

from __future__ import annotations

from types import TracebackType
from typing import Final, Self

from yarpy.contact import Contact
from yarpy.errors import LocalProtocolError
from yarpy.link.handshake import find_carrier, greet
from yarpy.link.outbound import Outbound
from yarpy.names.default import secret
from yarpy.route import Route, parse_carrier
from yarpy.wire.message import ADMIN, CALL, Message, Packet

ANONYMOUS: Final = "anon_rpc"  # the name C++ tools give themselves


class Caller:
    """A connection to the port at `contact` for questions and answers.

    With `admin` they are administrative ones (`[ver]`, `[list] [in]` ...). Raises LinkClosed,
    Timeout, UnknownPlugin, LocalProtocolError (a carrier without replies).
    """

    def __init__(
        self,
        contact: Contact,
        name: str = ANONYMOUS,
        *,
        carrier: str = "tcp",
        admin: bool = False,
        timeout: float = 10.0,
    ) -> None:
        if not find_carrier(parse_carrier(carrier).base).replies:
            raise LocalProtocolError(f'"{carrier}" carries no replies; call over tcp')
        route = Route(name, contact.name or f"/{contact.address}", carrier, contact.port)
        driver, speaker = greet(contact, route, key=secret(), timeout=timeout)
        self._link = Outbound(driver, speaker)
        self._key = ADMIN if admin else CALL

    def ask(self, question: object, timeout: float | None = None) -> Message | None:
        """The answer to `question`, None if the port gives none.

        Raises Timeout, LinkClosed; after either, this caller is of no more use.
        """
        return self._link.call(Packet(question, key=self._key), timeout)

    def close(self) -> None:
        """Say goodbye and hang up."""
        self._link.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()
