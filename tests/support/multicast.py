"""Multicast on this computer, for tests of programs that find each other without an address.

Rules: it takes a route. Where there is none (a computer without a network) and it is allowed, the
tests get a network of their own: a namespace with nothing but a loopback, over which multicast
goes. Where that is not allowed either, `needs_multicast` skips and says why.
"""

from __future__ import annotations

import ctypes
import os
import socket
import struct
import sys
from functools import cache

import pytest

from yarpy.names.discovery import GROUP

_CLONE_NEWNET = 0x40000000
_SIOCSIFFLAGS, _SIOCADDRT = 0x8914, 0x890B
_IFF_UP, _IFF_MULTICAST = 0x1, 0x1000
_RTF_UP = 0x1


@cache
def why_not() -> str:
    """Return why programs of this computer cannot talk by multicast, "" if they can."""
    try:
        with (
            socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as near,
            socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as far,
        ):
            far.bind(("", 0))
            member = socket.inet_aton(GROUP) + bytes(4)
            far.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, member)
            far.settimeout(1.0)
            near.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_LOOP, 1)
            near.sendto(b"hello", (GROUP, far.getsockname()[1]))
            far.recv(100)
    except OSError as error:
        return f"no multicast here ({error}): ip route add 224.0.0.0/4 dev lo, or run this as root"
    return ""


def needs_multicast() -> None:
    """Skip the test where there is none."""
    reason = why_not()
    if reason:
        pytest.skip(reason)


def have_it() -> None:
    """Take this process to a network of its own if it has no multicast here and is allowed to.

    Before it has threads: each thread has its network from the one that started it.
    """
    if sys.platform != "linux" or not why_not():
        return
    libc = ctypes.CDLL(None, use_errno=True)
    if not hasattr(libc, "unshare") or os.geteuid() != 0:
        return
    if libc.unshare(_CLONE_NEWNET) == 0:
        _open_loopback()
    why_not.cache_clear()


def _open_loopback() -> None:
    """Bring the loopback up, and lead multicast over it; as `ip` would."""
    import fcntl

    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sock:
        up = struct.pack("16sh14x", b"lo", _IFF_UP | _IFF_MULTICAST)
        fcntl.ioctl(sock, _SIOCSIFFLAGS, up)
        device = ctypes.create_string_buffer(b"lo")
        group, mask, none = (
            struct.pack("HH4s8x", socket.AF_INET, 0, socket.inet_aton(address))
            for address in ("224.0.0.0", "240.0.0.0", "0.0.0.0")
        )
        # struct rtentry: pad, destination, gateway, mask, flags, ..., the name of the device, ...
        route = struct.pack(
            "L16s16s16sHhLPhPLLH",
            *(0, group, none, mask, _RTF_UP, 0, 0, 0, 0, ctypes.addressof(device), 0, 0, 0),
        )
        fcntl.ioctl(sock, _SIOCADDRT, route)
