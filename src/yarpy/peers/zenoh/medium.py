"""The transport `zenoh`: dials ports inside Zenoh, and makes the endpoint that a connection of a
port with a key goes over.

Rules: everything is in the target: `zenoh+sub://robot/arm` is the key `robot/arm`. The router is
that of YARPY_ZENOH, else the one where names are, else that of this computer. Words that begin with
`@` are Zenoh's, and ours.
"""

from __future__ import annotations

import os
import re
from typing import Final

from yarpy.carriers.hosted import LISTENS, SERVICE
from yarpy.contact import Contact
from yarpy.errors import AddressError, NoNameServer
from yarpy.names.default import DEFAULT
from yarpy.peers.zenoh.address import ZENOH
from yarpy.peers.zenoh.endpoint import Asker, Endpoint, Publisher, Server, Subscriber
from yarpy.peers.zenoh.names import on_zenoh
from yarpy.peers.zenoh.place import SETTING
from yarpy.peers.zenoh.transport import share
from yarpy.peers.zenoh.tunnel.exchange import dial_inside
from yarpy.route import Route
from yarpy.transports.base import Transport
from yarpy.transports.opener import Opener

LONGEST: Final = 4096  # letters of a key
_CHUNK = re.compile(r"[^/*$#?@][^/*$#?]*+")  # a part of a key
_ROUTER = re.compile(r".*:\d+")

_KINDS: Final[dict[tuple[bool, bool], type[Endpoint]]] = {
    (False, False): Publisher,
    (False, True): Subscriber,
    (True, False): Asker,
    (True, True): Server,
}


def open_medium(contact: Contact, route: Route) -> Endpoint:
    """The endpoint of a connection of the port `route.source`.

    Raises AddressError (no key), and as `share`: UnknownPlugin, LinkClosed (no router), ...
    """
    tokens = route.spec.tokens
    serves, listens = SERVICE in tokens, LISTENS in tokens
    key = check_key(contact.name, patterns=listens and not serves)
    shared = share(_where())
    try:
        return _KINDS[serves, listens](shared, key, route.spec)
    except BaseException:
        shared.close()
        raise


def check_key(name: str, patterns: bool = False) -> str:
    """The key in a target's name; with `patterns` it may be one of several keys.

    >>> check_key("/robot/arm"), check_key("/robot/**", patterns=True)
    ('robot/arm', 'robot/**')

    Raises AddressError.
    """
    key = name.removeprefix("/")
    chunks = key.split("/")
    shown = key[:80]
    if len(chunks) > 1 and _ROUTER.fullmatch(chunks[0]):
        raise AddressError(
            f'"zenoh://{shown}": the key alone stands there, zenoh://{"/".join(chunks[1:])[:80]}; '
            f"the router is said by {SETTING}=tcp/{chunks[0][:80]}"
        )
    fine = all(_CHUNK.fullmatch(one) or (patterns and one in ("*", "**")) for one in chunks)
    if not fine or len(key) > LONGEST or ("**/**" in key):
        allowed = "* and ** stand for one word and for any" if patterns else "without * $ # ? and @"
        raise AddressError(f'"{shown}" is no key of Zenoh: words with slashes between, {allowed}')
    return key


def _where() -> str:
    """Return the place of Zenoh, "" for the usual one."""
    if os.environ.get(SETTING, "").strip():
        return ""
    try:
        names = on_zenoh(DEFAULT.current())
    except NoNameServer:
        return ""
    return "" if names is None else names.where


class ZenohOpener(Opener):
    """Ports inside Zenoh, by their hosts; and its keys, which have none."""

    name = "zenoh"
    hosts = ZENOH
    title = "Zenoh"
    prefers = "fast_tcp"  # acknowledgements cost as much as messages there, and it has its own
    no_tls = (
        "it is reached through Zenoh, whose routers pass messages on in TLS if they are at "
        "tls/HOST, but there is no TLS through them: take tcp"
    )
    proves = False
    meets = False

    @classmethod
    def dial(cls, contact: Contact, timeout: float, route: Route | None = None) -> Transport:
        if contact.host:
            return dial_inside(contact.host, contact.port, timeout)
        if route is None:
            raise AddressError(f'"{contact}" is no port: it cannot be asked')
        return open_medium(contact, route)
