"""Permission to start programs: of the owner of a server, and of those who have the right `run`.

    (no access.toml)               programs of the same user on this computer
    [[allow]] who = "tls:operator" may = "run"      ... and peers with that certificate

Rules: an address proves nothing, so from other computers only those come in who show a certificate
or know the shared key, have the right, and only if there is a list of programs. On this computer
the system tells whose program is at the other end; where it does not, nobody is believed. Web
pages never: the browser that shows them is a program of the same user.
"""

from __future__ import annotations

import os
import sys
from typing import Final

from yarpy.config import access_file
from yarpy.link.begin.admission import ASK, RUN, Admission, Gate, Peer
from yarpy.platform.user import user as our_user
from yarpy.wire.framing import REFUSED

_TABLES: Final = ("/proc/net/tcp", "/proc/net/tcp6")
_ESTABLISHED: Final = "01"


def audience(others: bool) -> str:
    """Return for whom a server starts programs, in words. others: rules let others do that."""
    if others:
        return "those who may by access.toml"
    if _tells():
        return "its user on this computer"
    return (
        "nobody yet, for this system, unlike Linux, does not tell whose program asks: yarpy access "
        "allow run tls:NAME, and --allow PROGRAM"
    )


def _tells() -> bool:
    """Return whether the system tells whose program asks."""
    return any(map(os.path.exists, _TABLES))


class RunGate(Gate):
    """The gate of the port called `name`. listed: there is a list of programs."""

    def __init__(self, name: str, listed: bool) -> None:
        self._name, self._listed = name, listed
        self._rules = access_file.gate(name)
        self.asks_names = self._rules.asks_names

    def admit(self, peer: Peer) -> Admission:
        """Return all rights or nearly none."""
        why = self._refusal(peer)
        return Refusing(peer, f"{REFUSED}: {why}") if why else Granted(peer)

    def _refusal(self, peer: Peer) -> str:
        name = self._name
        if peer.page:
            return f"{name} starts programs, and hears no web pages: use `yarpy run --on {name}`"
        if peer.here and is_own(peer):
            return ""
        if not (peer.names or peer.key):
            who = f"a program of another user of {peer}" if peer.here else str(peer)
            if peer.here and not _tells():
                return (
                    f"{peer} may not start programs through {name}: this system, unlike Linux, does"
                    " not tell whose program asks; who comes with a certificate may if the owner of"
                    " the server says so: yarpy access allow run tls:NAME"
                )
            return (
                f"{who} may not start programs through {name}, only its owner on that computer may;"
                " who comes with a certificate may if its owner says so: yarpy access allow run "
                "tls:NAME"
            )
        if not self._rules.admit(peer).allows(RUN):
            first = f"tls:{peer.names[0]}" if peer.names else "key"
            return (
                f"{peer} may not start programs through {name}; its owner types: yarpy access allow"
                f" run {first}"
            )
        if not self._listed:
            return (
                f"{name} has no list of programs that others may start; its owner types: yarpy run "
                f"--server {name} --allow PROGRAM"
            )
        return ""


class Granted(Admission):
    """Refuse nothing but scripts, whatever else the rules say: who starts programs may do that."""


class Refusing(Admission):
    """Nothing, but for asking what the port is, which web pages may not either."""

    everything = False
    open = False

    def __init__(self, peer: Peer, why: str) -> None:
        super().__init__(peer)
        self._why = why

    def allows(self, right: str, name: str = "") -> bool:
        return right == ASK and not self.peer.page

    def refusal(self, right: str, name: str = "") -> str:
        return "" if self.allows(right) else self._why

    def rights(self) -> list[str]:
        return []


def is_own(peer: Peer) -> bool:
    """Return whether the peer is a program of the user that we are, or of the system's owner, as
    the system tells; False where it cannot tell."""
    user = user_of(peer)
    return user is not None and user in (0, our_user())


def user_of(peer: Peer) -> int | None:
    """Return the number of the user whose program is at the other end, None if that is not known:
    it is on another computer, has hung up, or this is not Linux."""
    if len(peer.ends) != 2:
        return None
    theirs, ours = ({_spelled(end, wide) for wide in (False, True)} for end in peer.ends)
    for table in _TABLES:
        try:
            with open(table, encoding="ascii") as file:
                next(file, "")
                for line in file:
                    words = line.split()
                    # A socket whose program has closed it shows no user, which reads as 0.
                    if words[3] != _ESTABLISHED or words[9] == "0":
                        continue
                    if words[1] in theirs and words[2] in ours:
                        return int(words[7])
        except (OSError, IndexError, ValueError):
            continue
    return None


def _spelled(end: tuple[str, int], wide: bool) -> str:
    """Return an address as the system's tables spell it: words of the machine's order, in hex."""
    import socket

    host, port = end[0].partition("%")[0], end[1]
    try:
        packed = socket.inet_aton(host) if host.count(".") == 3 and ":" not in host else None
        if packed is not None and wide:
            packed = b"\0" * 10 + b"\xff\xff" + packed
        if packed is None:
            packed = socket.inet_pton(socket.AF_INET6, host)
    except OSError:
        return ""
    parts = (packed[at : at + 4] for at in range(0, len(packed), 4))
    order = sys.byteorder
    return "".join(f"{int.from_bytes(part, order):08X}" for part in parts) + f":{port:04X}"
