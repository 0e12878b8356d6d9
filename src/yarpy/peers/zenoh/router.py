"""Routers of Zenoh: they pass on what sessions say to each other.

Rules: a router listens where it is told to, else on the loopback; it looks for nobody.
"""

from __future__ import annotations

import socket
import time
from collections.abc import Container, Sequence
from typing import TYPE_CHECKING, Final

from yarpy.errors import LinkClosed
from yarpy.peers.zenoh.config import RETRY, from_file, override, put, secure
from yarpy.peers.zenoh.config import said as said_in
from yarpy.peers.zenoh.library import load, plain
from yarpy.peers.zenoh.place import HERE, endpoint, parts
from yarpy.peers.zenoh.reason import reason

if TYPE_CHECKING:
    import zenoh

JOINING: Final = 3.0  # seconds until a router says that it is alone


def open_router(
    listen: Sequence[str] = (), connect: Sequence[str] = (), file: str = ""
) -> zenoh.Session:
    """A router: it passes on what sessions say to each other. Close it when done.

    listen: where, the loopback by default. connect: other routers, which may come later. file: a
    configuration file of Zenoh; what it says counts, and the rest is as without one. Raises as
    `share`, and LinkClosed if it cannot listen there.
    """
    config = load().Config()
    put(config, "mode", "router")
    put(config, "scouting/delay", 0)  # it does not wait for others before it begins
    put(config, "scouting/multicast/enabled", False)
    put(config, "scouting/gossip/enabled", False)
    put(config, "connect/retry", RETRY)
    said = said_in(from_file(file)) if file else {}
    where = [endpoint(item) for item in listen or said.get("listen/endpoints") or (HERE,)]
    others = [endpoint(item) for item in connect or said.get("connect/endpoints") or ()]
    secure(config, where, others)
    for key, value in said.items():
        put(config, key, value)
    put(config, "mode", "router")
    put(config, "listen/endpoints", where)
    put(config, "connect/endpoints", others)
    override(config)
    for item in where:
        _check_free(item)
    try:
        router: zenoh.Session = load().open(config)
        return router
    except Exception as error:
        raise LinkClosed(
            f"no router at {', '.join(where) or file}: {plain(error)}; choose another address, or "
            "end what listens there"
        ) from error


def unjoined(router: zenoh.Session, others: Sequence[str]) -> list[str]:
    """The `others` that a router is not soon joined with, and goes on to dial: a line for each,
    which says why."""
    left = [endpoint(one) for one in others]
    dialled = {parts(one)[2] for one in left}
    until = time.monotonic() + JOINING
    while left := [one for one in left if not _is_joined(router, one, dialled)]:
        if time.monotonic() > until:
            return [f"not joined with {one} yet: {reason(one)}" for one in left]
        time.sleep(0.02)
    return []


def _is_joined(router: zenoh.Session, other: str, dialled: Container[str]) -> bool:
    """Return whether there is a link with that router: to it, or from its computer if it has
    dialled us, from a number that is none of those that we have `dialled`."""
    _, host, port = parts(other)
    try:
        hosts = {str(found[4][0]) for found in socket.getaddrinfo(host, None)}
    except (OSError, UnicodeError):
        return False
    info = router.info
    routers = {str(zid) for zid in info.routers_zid()}
    for link in info.links():
        _, theirs, number = parts(str(link.dst))
        fits = number == port or number not in dialled
        if fits and theirs in hosts and str(link.zid) in routers:
            return True
    return False


def _check_free(where: str) -> None:
    """Raise LinkClosed if another program listens there: Zenoh would share the number with it."""
    kind, host, port = parts(where)
    if kind not in ("tcp", "tls", "ws"):
        return
    if not int(port):
        return
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    with socket.socket(family, socket.SOCK_STREAM) as sock:
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            sock.bind((host, int(port)))
        except OSError as error:
            raise LinkClosed(
                f"no router can listen at {where} ({error.strerror or error}): choose another "
                "address, or end what listens there"
            ) from error
