"""Admission: who is at the other end of a connection, and what they may do with our port.

    read         what the port writes: `r`, HTTP, and connections to their own computer
    write        send it messages
    administer   connect and disconnect it, and the rest of its administration
    attach       let monitors ride on its connections
    register     names, with a name server
    script       name scripts as monitors; it is asked for apart, and nobody has it by default
    run          start programs, through a port that does so; it is asked for apart as well
    ask          what it is and what it is connected to: any peer with a right may ask

Rules: pure. It is decided once, when a connection begins, and again when a page shows a token. What
stands here admits everybody to everything, as C++ YARP does; `config/access.py` knows the rules of
an owner that has written some.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from typing import Final

RIGHTS: Final = ("read", "write", "administer", "attach", "register")
SCRIPT: Final = "script"
RUN: Final = "run"
KNOWN: Final = (*RIGHTS, SCRIPT, RUN)
ASK: Final = "ask"

_scripts: ContextVar[bool] = ContextVar("scripts", default=False)


@dataclass(frozen=True, slots=True)
class Peer:
    """The other end of a connection, as far as it has proved who it is.

    here: a program of this computer. names: those of its TLS certificate. key: it knows the key of
    auth.conf. token: the name of the web token that it has shown. page: it may be a web page, by
    what it speaks. ends: the two addresses of the connection, the peer's and ours, where they are a
    proof.
    """

    address: str = ""
    here: bool = False
    names: tuple[str, ...] = ()
    key: bool = False
    token: str = ""
    page: bool = False
    ends: tuple[tuple[str, int], ...] = ()

    def __str__(self) -> str:
        where = "this computer" if self.here else self.address or "somebody"
        proofs = [f"tls:{name}" for name in self.names[:3]]
        if self.token:
            proofs.append(f"token:{self.token}")
        return f"{where} ({', '.join(proofs)})" if proofs else where


Room = Callable[[Peer], str]  # why a port takes no more senders of datagrams; "" if it does


def any_number(peer: Peer) -> str:
    """Take as many as come."""
    return ""


Rival = Callable[[str], str]  # why nobody else may come under that name now; "" if he may


def no_rival(name: str) -> str:
    """Let everybody call himself as he likes."""
    return ""


class Admission:
    """The rights of one peer at one port; of this class, all of them.

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
        """Return whether the peer has that right. `name`: of another port, which a name server is
        told of."""
        return right not in (SCRIPT, RUN)

    def refusal(self, right: str, name: str = "") -> str:
        """Return why the peer may not do that, as it is told; "" if it may. It is logged once."""
        return ""

    def rights(self) -> list[str]:
        """Return the rights of the peer."""
        return [*RIGHTS]

    def showing(self, token: str, public_key: bool = False) -> Admission | None:
        """Return the rights of the peer once it has shown a token, "" for none, or has proven that
        it has the secret key of this public one; None if that is not known."""
        return self


class Gate:
    """The rules by which a port finds the rights of a peer.

    `asks_names`: peers that come in TLS are asked for a certificate.
    """

    asks_names: bool = False

    def admit(self, peer: Peer) -> Admission:
        """Return the rights of a peer."""
        return Admission(peer)


@contextmanager
def on_behalf(admission: Admission) -> Iterator[None]:
    """Carry out a peer's command in this thread: `scripts_allowed` answers for that peer."""
    token = _scripts.set(admission.allows(SCRIPT))
    try:
        yield
    finally:
        _scripts.reset(token)


def scripts_allowed() -> bool:
    """Return whether the peer whose command this thread carries out may name scripts."""
    return _scripts.get()


def same_computer(remote: str, local: str) -> bool:
    """Return whether a connection comes from this computer: over the loopback, or to one of its own
    addresses. `local` is "" where addresses are no proof."""
    return remote.startswith("127.") or remote == "::1" or (bool(remote) and remote == local)


def peer_of(remote: str, local: str, names: Iterable[str] = (), key: bool = False) -> Peer:
    """Return the peer that has dialled us, by the two addresses of the connection and what was
    proved."""
    return Peer(remote, same_computer(remote, local), tuple(names), key)
