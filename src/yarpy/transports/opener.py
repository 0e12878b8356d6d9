"""Opener: a transport as a plug-in, how one is opened, and what can be asked before.

Rules: an Opener is found by name (`yarpy.transports`), like a carrier, and has no state. It dials a
host, or meets the peer of a connection elsewhere; most do one of the two. Its facts are those of
`yarpy.facts.TransportRow`; which carriers go over which transport `link/combine.py` says.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Final

from yarpy.contact import Contact
from yarpy.errors import LocalProtocolError
from yarpy.route import Route
from yarpy.transports.base import Transport

CONNECT_TIMEOUT: Final = 10.0  # seconds, as C++ YARP


@dataclass(frozen=True, slots=True)
class MeetingPlace:
    """The meeting place of the two ends of a connection that have greeted over `through`.

    `listen`: we accepted that connection. `port`, `group`: what the carrier says about the place
    (`wire/effects.py`, Open). `timeout`: seconds.
    """

    through: Transport
    listen: bool
    port: int
    group: str
    timeout: float


class Opener:
    """The facts of a transport, and the ways in which it is opened."""

    name: ClassVar[str] = ""
    hosts: ClassVar[str] = ""
    title: ClassVar[str] = ""
    setting: ClassVar[str] = ""
    prefers: ClassVar[str] = ""
    no_tls: ClassVar[str] = ""
    proves: ClassVar[bool] = True
    meets: ClassVar[bool] = True
    stays: ClassVar[bool] = False
    datagrams: ClassVar[bool] = False
    system: ClassVar[str] = ""
    uses: ClassVar[str] = ""

    @classmethod
    def dial(cls, contact: Contact, timeout: float, route: Route | None = None) -> Transport:
        """Return a connection to `contact`; `route` is what it is for, if that is known. Raises
        OSError, and what tells a user what to do."""
        raise LocalProtocolError(f"nothing can be dialled over {cls.name}: take tcp")

    @classmethod
    def meet(cls, place: MeetingPlace) -> Any:
        """Return our end, before the peer has come: a Transport, whose `ready` waits for it. None
        if the peer cannot be met from here. Raises OSError, LocalProtocolError."""
        raise LocalProtocolError(f"two ends of a connection cannot meet over {cls.name}: take tcp")
