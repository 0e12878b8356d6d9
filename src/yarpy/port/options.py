"""PortOptions: the keyword arguments that ports of every kind take.

Rules: they go on as they are, from a port's constructor to `assembly.open_hub`, which knows the
values of those that are missing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from difflib import get_close_matches
from typing import Final, TypedDict

from yarpy.link.begin.admission import Gate
from yarpy.names.base import NameClient
from yarpy.port.connection import ConnectionEvent


class PortOptions(TypedDict, total=False):
    """The options with which a port is opened.

    names: a name client, None for the default (see `yarpy.NameServer`, `yarpy.LocalNames`).
    tcp_port: the number to listen on, 0 to let the name server or the system choose.
    port_type: what the port says it takes or sends, for those who look it up (`yarp/image`).
    limit: the largest message accepted, in bytes.
    on_connection: called with an event when a connection comes or goes.
    timeout: seconds for opening it, else 5.
    gate: called with the port's name; what it returns decides who may do what, instead of the rules
    of access.toml.
    """

    names: NameClient | None
    tcp_port: int
    port_type: str
    limit: int
    on_connection: Callable[[ConnectionEvent], object] | None
    timeout: float | None
    gate: Callable[[str], Gate] | None


_KNOWN: Final = (*PortOptions.__annotations__, "callback", "strict")
_LATER: Final = {
    "carrier": "a carrier is chosen for each connection: port.connect(target, carrier)",
    "type": "`port_type` says what a port takes or sends",
    "port": "`tcp_port` is the number to listen on",
}
_ELSEWHERE: Final = {  # what ports of another kind take
    "callback": "Port and BufferedPort call one with each message, RpcServer has its handler",
    "strict": "a BufferedPort may be strict, all others keep every message anyway",
}


def wrong(unknown: Iterable[str]) -> TypeError:
    """Return the error for keyword arguments that no port takes."""
    name = next(iter(unknown))
    if name in _ELSEWHERE:
        return TypeError(f'this port takes no "{name}": {_ELSEWHERE[name]}')
    near = get_close_matches(name, (*_KNOWN, *_LATER), n=1)
    advice = _LATER.get(near[0], f'did you mean "{near[0]}"?') if near else ""
    return TypeError(f'a port takes no "{name}"' + (f": {advice}" if advice else ""))
