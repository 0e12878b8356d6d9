"""Addresses inside Zenoh: the host is a session, `a1b2.zenoh:10002`.

Rules: pure. The ending is that of the transport `zenoh`, by which the core knows such a host.
"""

from __future__ import annotations

from typing import Final

ZENOH: Final = ".zenoh"


def zid_host(zid: str) -> str:
    """Return a session of Zenoh as the host of an address.

    >>> zid_host("a1b2")
    'a1b2.zenoh'
    """
    return zid + ZENOH


def host_zid(host: str) -> str:
    """Return the session of Zenoh that an address leads to, "" if it is an ordinary address."""
    zid = host.removesuffix(ZENOH)
    return zid if zid != host else ""
