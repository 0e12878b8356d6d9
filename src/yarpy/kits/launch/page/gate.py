"""The gate of an application's page: it admits the user whose application it is, on this computer.

Rules: whoever starts and stops programs may do what that user may, so an address proves nothing,
and other users of this computer are refused as other computers are. The system says whose program
is at the other end; where it does not (outside Linux), nobody is let in. Whether a page of another
origin asks is decided before, by `carriers/web/http/origin.py`.
"""

from __future__ import annotations

from collections.abc import Callable

from yarpy.kits.launch.run.permission import Granted, Refusing, is_own
from yarpy.link.begin.admission import Admission, Gate, Peer
from yarpy.wire.framing import REFUSED


class OwnerGate(Gate):
    """The gate of the port called `name`; `own`: whether a peer is a program of this user."""

    def __init__(self, name: str, own: Callable[[Peer], bool] = is_own) -> None:
        self._name = name
        self._own = own

    def admit(self, peer: Peer) -> Admission:
        """Return all rights or nearly none."""
        if peer.here and self._own(peer):
            return Granted(peer)
        return Refusing(
            peer,
            f"{REFUSED}: {self._name} starts and stops programs, for its user on that computer "
            "alone; `ssh -L` brings its page to another one",
        )
