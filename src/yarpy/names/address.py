"""The choice of this computer's addresses to advertise.

Rules: listing interfaces is best effort; where the system cannot, only loopback is known. Texts are
plain: no zone (`%eth0`), and an IPv4 address seen through an IPv6 socket (`::ffff:10.0.0.1`) is
written as IPv4, because that is what C++ YARP compares them with. The library ifaddr lists the
same, but starts a program (ldconfig) when it is imported: 13 to 22 ms, where this takes 0.3 ms.
"""

from __future__ import annotations

import socket
import sys
from collections.abc import Iterable, Iterator
from functools import cache, lru_cache
from typing import Any

from yarpy import registry

LOOPBACK = "127.0.0.1"


def plain_host(text: str) -> str:
    """An address as YARP spells it.

    >>> plain_host("::ffff:10.0.0.1"), plain_host("fe80::1%eth0"), plain_host("myhost")
    ('10.0.0.1', 'fe80::1', 'myhost')
    """
    text = text.partition("%")[0].strip("[]")
    if text.lower().startswith("::ffff:") and "." in text:
        return text[7:]
    return text


@lru_cache(maxsize=256)
def is_loopback(host: str) -> bool:
    """Return whether only this computer can reach `host`."""
    if host == "localhost":
        return True
    import ipaddress  # late: 4 ms at import for one question

    try:
        return ipaddress.ip_address(plain_host(host)).is_loopback
    except ValueError:
        return False


def local_addresses() -> list[str]:
    """Every IPv4 and IPv6 address of this computer, in the system's order, without repetition.

    This is what a port registers as its `ips`.
    """
    try:
        found = list(_interface_addresses())
    # No getifaddrs here, or a strange one. Windows, which knows all by its own name, takes no None.
    except (OSError, AttributeError, ValueError, TypeError):
        found = []
    if not found:
        found = [LOOPBACK, *_addresses_of_own_name()]
    return list(dict.fromkeys(plain_host(address) for address in found))


def is_local(host: str) -> bool:
    """Return whether `host` is an address or a name of this computer."""
    host = plain_host(host)
    if is_loopback(host):
        return True
    if registry.transports.of_host(host).hosts:
        return False  # no name of DNS
    local = set(local_addresses())
    if host in local:
        return True
    try:
        entries = socket.getaddrinfo(host, None, type=socket.SOCK_STREAM)
    except (OSError, UnicodeError):
        return False
    return any(plain_host(str(entry[4][0])) in local for entry in entries)


def outward_address(addresses: Iterable[str] | None = None) -> str:
    """The address that a server advertises: IPv4, not loopback if possible, the shortest text."""
    candidates = [
        address
        for address in (local_addresses() if addresses is None else addresses)
        if "." in address and ":" not in address
    ]
    if not candidates:
        return LOOPBACK
    return min(candidates, key=lambda address: (is_loopback(address), len(address)))


def _addresses_of_own_name() -> Iterator[str]:
    try:
        for entry in socket.getaddrinfo(socket.gethostname(), None, type=socket.SOCK_STREAM):
            yield str(entry[4][0])
    except (OSError, UnicodeError):
        return


def _interface_addresses() -> Iterator[str]:
    """Yield the addresses that `getifaddrs` of the C library lists (Linux, macOS, the BSDs)."""
    import ctypes  # late: 5 ms, and only processes that open ports need it

    library, link = _library()
    head = link()
    if library.getifaddrs(ctypes.byref(head)) != 0:
        return
    try:
        entry = head
        while entry:
            if entry.contents.address:
                text = _socket_address(ctypes.string_at(entry.contents.address, 2), entry)
                if text:
                    yield text
            entry = entry.contents.next
    finally:
        library.freeifaddrs(head)


@cache
def _library() -> tuple[Any, Any]:
    """The C library, and the type of a pointer to `struct ifaddrs`."""
    import ctypes

    class _Interface(ctypes.Structure):
        pass

    link = ctypes.POINTER(_Interface)
    _Interface._fields_ = [
        ("next", link),
        ("name", ctypes.c_char_p),
        ("flags", ctypes.c_uint),
        ("address", ctypes.c_void_p),
    ]
    return ctypes.CDLL(None), link


def _socket_address(start: bytes, entry: object) -> str:
    """The host in a `struct sockaddr`; "" for other families than IPv4 and IPv6."""
    import ctypes

    # BSD begins with a length byte and has a family byte; Linux has a 16 bit family.
    family = int.from_bytes(start, sys.byteorder) if sys.platform == "linux" else start[1]
    place = entry.contents.address  # type: ignore[attr-defined]
    if family == socket.AF_INET:
        return socket.inet_ntop(socket.AF_INET, ctypes.string_at(place + 4, 4))
    if family == socket.AF_INET6:
        return socket.inet_ntop(socket.AF_INET6, ctypes.string_at(place + 8, 16))
    return ""
