"""The places that sessions of Zenoh go to, as users write them. A place is

    (nothing)                 what YARPY_ZENOH says, else the router of this computer
    tcp/192.168.1.2:7447      a router; or `tls/...`, `quic/...`, or `host` or `host:port` alone
    tcp/a:7447,tcp/b:7447     one of several routers, whichever answers
    lan                       no router: the peers in the local network, found by multicast
    /etc/robot.json5          a configuration file of Zenoh, as it is; on Windows C:\\robot.json5

Rules: nothing is opened here. Where YARPY_TLS requires TLS, a place without it is refused.
"""

from __future__ import annotations

import os
import re
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from yarpy.errors import AddressError, LocalProtocolError
from yarpy.transports.tls_setting import required

SETTING: Final = "YARPY_ZENOH"
PORT: Final = 7447
LAN: Final = "lan"
HERE: Final = f"127.0.0.1:{PORT}"

_ENDPOINT = re.compile(r"(tcp|tls|quic|udp|ws|unixsock-stream)/(.+)")
_DRIVE = re.compile(r"(?:file:///)?([A-Za-z]:[\\/].*)")
SECURE: Final = ("tls", "quic")


@dataclass(frozen=True, slots=True)
class Place:
    """The place that a session goes to: one of `routers`, or what `file` says; with neither, the
    local network."""

    routers: tuple[str, ...] = ()
    file: str = ""

    def __str__(self) -> str:
        return ",".join(self.routers) or self.file or "the local network"


def place(text: str = "") -> Place:
    """Parse the text of a place; "" for that of YARPY_ZENOH. Raises AddressError,
    LocalProtocolError."""
    text = text.strip() or os.environ.get(SETTING, "").strip() or HERE
    if text == LAN:
        if required():
            raise LocalProtocolError(
                "YARPY_TLS requires TLS, which peers that find each other by multicast do not "
                f"have: let them meet at a router, {SETTING}=tls/HOST:{PORT}"
            )
        return Place()
    drive = _DRIVE.fullmatch(text) if sys.platform == "win32" else None
    if drive is not None:
        return Place(file=str(Path(drive[1])))
    if text.startswith(("/", ".", "~", "file:")):
        return Place(file=str(Path(text.removeprefix("file://")).expanduser()))
    return Place(tuple(endpoint(item) for item in re.split(r"[, ]+", text) if item))


def parts(address: str) -> tuple[str, str, str]:
    """The protocol, host and number of an address as Zenoh writes it; they may be empty.

    >>> parts("tls/[::1]:7447?rel=0")
    ('tls', '::1', '7447')
    """
    kind, _, rest = address.partition("/")
    host, _, port = rest.partition("#")[0].partition("?")[0].rpartition(":")
    return kind, host.strip("[]"), port


def endpoint(text: str) -> str:
    """A router's or listener's address as Zenoh writes it.

    >>> endpoint("192.168.1.2"), endpoint("tls/robot.lab:7448")
    ('tcp/192.168.1.2:7447', 'tls/robot.lab:7448')

    Raises AddressError, LocalProtocolError.
    """
    found = _ENDPOINT.fullmatch(text)
    kind, rest = found.groups() if found else ("tls" if required() else "tcp", text)
    if kind == "unixsock-stream":
        return text
    if required() and kind not in SECURE:
        raise LocalProtocolError(f'YARPY_TLS requires TLS: "{text}" has none, take tls/{rest}')
    where, mark, options = rest.partition("#")
    where, query, metadata = where.partition("?")
    host, colon, port = where.rpartition(":")
    if not colon or where.endswith("]"):
        host, port = where, str(PORT)
    if not (port.isascii() and port.isdigit() and len(port) < 6 and int(port) < 65536):
        port = ""
    if not host or not port or "/" in host or (":" in host and not host.startswith("[")):
        raise AddressError(
            f'"{text[:80]}" is no address for Zenoh: write tcp/HOST:{PORT} or tls/HOST:{PORT}, '
            f"{LAN}, or the path of a configuration file, in {SETTING}"
        )
    return f"{kind}/{host}:{port}{query}{metadata}{mark}{options}"
