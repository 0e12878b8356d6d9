"""Admission: who is at the other end of a connection, and what they may do with our port.

    read         what the port writes: `r`, HTTP, and connections to their own computer
    write        send it messages
    administer   connect and disconnect it, and the rest of its administration
    attach       let monitors ride on its connections
    register     names, with a name server
    ask          what it is and what it is connected to: any peer with a right may ask

Rules: pure. It is decided once, when a connection begins, and again when a page shows a token. What
stands here admits everybody to everything, as C++ YARP does; `config/access.py` knows the rules of
an owner that has written some.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

from yarpy.contact import host_zid

RIGHTS: Final = ("read", "write", "administer", "attach", "register")
ASK: Final = "ask"


@dataclass(frozen=True, slots=True)
class Peer:
    """Who is at the other end, as far as this is proved.

    here: a program of this computer. names: those of its TLS certificate. key: it knows the key of
    auth.conf. token: the name of the web token that it has shown.
    """

    address: str = ""
    here: bool = False
    names: tuple[str, ...] = ()
    key: bool = False
    token: str = ""

    def __str__(self) -> str:
        where = "this computer" if self.here else self.address or "somebody"
        proofs = [f"tls:{name}" for name in self.names[:3]]
        if self.token:
            proofs.append(f"token:{self.token}")
        return f"{where} ({', '.join(proofs)})" if proofs else where


class Admission:
    """What one peer may do with one port: everything.

    `everything`: nothing needs to be asked for each message. `open`: there are no rules at all.
    `directory`: the port is a name server's, whose events are for those who are told of them.
    """

    everything: bool = True
    open: bool = True
    directory: bool = False
    takes_tokens: bool = False  # whether a token may change something

    def __init__(self, peer: Peer = Peer()) -> None:
        self.peer = peer

    def allows(self, right: str, name: str = "") -> bool:
        """Whether the peer may do that. `name`: of another port, which a name server is told of."""
        return True

    def refusal(self, right: str, name: str = "") -> str:
        """Why the peer may not do that, as it is told; "" if it may. It is logged, once."""
        return ""

    def rights(self) -> list[str]:
        """What the peer may do."""
        return [*RIGHTS]

    def showing(self, token: str) -> Admission | None:
        """What the peer may do once it has shown a token, "" for none; None if that is not
        known."""
        return self


class Gate:
    """How a port finds out what a peer may do.

    `asks_names`: peers that come in TLS are asked for a certificate.
    """

    asks_names: bool = False

    def admit(self, peer: Peer) -> Admission:
        """What a peer may do."""
        return Admission(peer)


def same_computer(remote: str, local: str) -> bool:
    """Whether a connection comes from this computer: over the loopback, or to an own address.

    Inside Zenoh nobody can tell: there a peer says itself who it is.
    """
    if host_zid(remote):
        return False
    return remote.startswith("127.") or remote == "::1" or (bool(remote) and remote == local)


def peer_of(remote: str, local: str, names: Iterable[str] = (), key: bool = False) -> Peer:
    """Who has dialled us, by the two addresses of the connection and what was proved."""
    return Peer(remote, same_computer(remote, local), tuple(names), key)
