"""Findings about addresses: a port that cannot be reached from here.

Rules: every address that the port has told the name server is tried; nothing but a connection is
made.
"""

from __future__ import annotations

import socket
from collections.abc import Iterator
from typing import Final

from yarpy.kits.doctor.case import Case
from yarpy.kits.doctor.finding import Finding
from yarpy.names.address import is_local, is_loopback
from yarpy.network.traffic import PortState

TIMEOUT: Final = 0.5  # seconds for an address
MOST: Final = 8  # of one port


def find(case: Case) -> Iterator[Finding]:
    """unreachable."""
    for state in case.ports.values():
        if state.state == "unreachable":
            yield _unreachable(case, state)
        elif is_loopback(state.contact.host) and _server_is_away(case):
            yield Finding(
                "unreachable",
                state.name,
                f'"{state.name}" is registered at {state.contact.address}, which is each '
                "computer's address for itself: from here it leads to this one",
                "start its program with YARP_IP set to the beginning of the address that others "
                "reach it at, for example YARP_IP=192.168.",
            )


def _unreachable(case: Case, state: PortState) -> Finding:
    contact = state.contact
    text = (
        f'"{state.name}" is registered at {contact.address}, which cannot be reached from here '
        f"({state.error})"
    )
    for address in case.property_of(state.name, "ips")[:MOST]:
        if address != contact.host and not is_loopback(address) and _listens(address, contact.port):
            return Finding(
                "unreachable",
                state.name,
                f"{text}; at {address}:{contact.port} something listens",
                f"start its program with YARP_IP={address}, so that it registers that address",
            )
    if _listens("127.0.0.1", contact.port) and not is_local(contact.host):
        text += f"; on this computer something listens at number {contact.port}"
    return Finding(
        "unreachable",
        state.name,
        text,
        f"try `ping {contact.host}`; if that works, a firewall is in between (it must let TCP "
        "through to the ports that the name server hands out), or a container whose ports are "
        "not published; if it does not, start its program with YARP_IP set to the beginning of an "
        "address in a network that both have",
    )


def _server_is_away(case: Case) -> bool:
    return bool(case.servers) and not is_local(case.servers[0].host)


def _listens(host: str, port: int) -> bool:
    try:
        socket.create_connection((host, port), TIMEOUT).close()
    except (OSError, UnicodeError, OverflowError):
        return False
    return True
