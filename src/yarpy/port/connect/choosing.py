"""Choosing: the carrier of a connection for which none was named.

Rules: `memory` between two programs of yarpy on one computer, else tcp. What the name service knows
of a port decides whether it is tried: a C++ port is not asked for what it does not have. Whether
two programs see the same memory shows only when they try: containers, or another user. Between
ports of one program it stays tcp: `local` is there for those who want it.
"""

from __future__ import annotations

import os
import time
from dataclasses import replace
from typing import Final

from yarpy import registry
from yarpy.contact import Contact
from yarpy.errors import YarpError
from yarpy.names.address import is_local
from yarpy.names.base import NameClient
from yarpy.route import CarrierSpec, parse_carrier
from yarpy.transports.shared.sealed import available
from yarpy.transports.tls_setting import required

MEMORY: Final = "memory"
OPENING: Final = 0.1  # seconds for a port to tell of itself, once its name is known
POLL: Final = 0.005


def choose(contact: Contact, names: NameClient | None, own: bool) -> CarrierSpec:
    """Return the carrier to connect to `contact` with; see CarrierSpec for `own`."""
    found = MEMORY if _is_neighbour(contact, names) else "tcp"
    found = registry.transports.of_host(contact.host).prefers or found
    return replace(parse_carrier(found), own=own, chosen=True)


def instead(spec: CarrierSpec) -> CarrierSpec | None:
    """Return the carrier to try where a chosen one did not work; None: there is none."""
    return spec.over("tcp") if spec.chosen and spec.base == MEMORY else None


def offers_memory(contact: Contact, names: NameClient | None) -> bool:
    """Return whether a port knows `memory`, as it told the name service."""
    return bool(contact.name) and names is not None and _process(contact.name, names) != ""


def _is_neighbour(contact: Contact, names: NameClient | None) -> bool:
    """Return whether it is a port of yarpy in another program of this computer."""
    if not available() or required() or contact.carrier not in ("", "tcp"):
        return False
    if names is None or not contact.name or not is_local(contact.host):
        return False
    return _process(contact.name, names) not in ("", str(os.getpid()))


def _process(name: str, names: NameClient) -> str:
    """The number of the program that has a port which knows `memory`; "" for any other.

    A port that is just opening is known by its name before it has told all of itself; a name that
    somebody entered by hand never tells anything.
    """
    deadline = time.monotonic() + OPENING
    try:
        while not (found := [*names.get(name, "process")]) and time.monotonic() < deadline:
            time.sleep(POLL)
        if not found or MEMORY not in names.get(name, "accepts"):
            return ""
    except YarpError:
        return ""
    return str(found[0])
