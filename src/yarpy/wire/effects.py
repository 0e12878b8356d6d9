"""Effects: a protocol's requests besides bytes, which a `Steps` generator yields.

Rules: plain values, no behaviour. `None` asks for more bytes; everything else is listed here. A
connection greets over TCP; carriers that move elsewhere (UDP, multicast, Unix sockets, in-process)
`Open` the new place, tell the peer about it, and `Switch` onto it. One whose peer hangs up after
the first answer opens another one to ask again. `Show` is for `decode` alone.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from yarpy.wire.steps import Effect
from yarpy.wire.stream import ByteStream


@dataclass(frozen=True, slots=True)
class Open(Effect):
    """Open another way to the same peer; the driver sends back a handle with `.port` (0: none).

    `kind` names the transport (`udp`, `unix`, `memory` ...); "": the one of this connection, anew.
    `listen` is true on the side that accepted the TCP connection. `group` and `port` say where: a
    multicast group, the peer's port. For `memory` they are whose it is, and the number where its
    sender can be met; the handle is None if that cannot be seen from here.
    """

    kind: str
    listen: bool
    port: int = 0
    group: str = ""


@dataclass(frozen=True, slots=True)
class Switch(Effect):
    """Leave TCP: from here on this connection's bytes move by `handle`, buffered in `stream`. With
    None they stay where they are, and pass through `stream` alone."""

    handle: Any
    stream: ByteStream


@dataclass(frozen=True, slots=True)
class Group(Effect):
    """Ask for the multicast group of the sending port; the driver sends back `(address, port)`."""


@dataclass(frozen=True, slots=True)
class Within(Effect):
    """A message has begun to come: it has `seconds` to its end, or raises Timeout inside `decode`.
    The same of the rest of a greeting.

    None: no message is under way any more. The end of `decode` says so too.
    """

    seconds: float | None


@dataclass(frozen=True, slots=True)
class Flush(Effect):
    """Send what was written so far, and wait until it is in the system's hands: the rest of a long
    answer is made after that."""


@dataclass(frozen=True, slots=True)
class Show(Effect):
    """Ask the port's program for its page at `path`; the driver sends back a Page, or None."""

    path: str
    fields: Mapping[str, str]


#: to read what the port writes from now on: the right "read", at a port that writes at all
HEAR: Final = "hear"


#: to send datagrams, to a port that has a place for another sender of them
SEND_DATAGRAMS: Final = "send datagrams"

#: to come under a name that nobody else has who sends to this port
BE_CALLED: Final = "be called so"


@dataclass(frozen=True, slots=True)
class May(Effect):
    """Ask whether the peer may do that here; the driver sends back why not, or "".

    `link/begin/admission.py` lists the rights, and there are HEAR, SEND_DATAGRAMS and BE_CALLED.
    `asking`: the peer did not try to, so nothing is logged. `name`: what the peer calls itself.
    """

    right: str
    asking: bool = False
    name: str = ""


@dataclass(frozen=True, slots=True)
class Claim(Effect):
    """The peer shows a web token, "" for none: `May` is answered for whom it belongs to.

    The driver sends back whether it is known; None: there are no tokens here. `public_key`: it is
    one, in hexadecimal digits, and the peer has proven that it has the secret one.
    """

    token: str
    public_key: bool = False
