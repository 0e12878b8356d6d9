"""The controls of ports: changes are made by administrative messages.

Rules: these are the messages of any tool, so C++ ports take them too. What a port refuses is a
LocalProtocolError with its reason; one that says nothing a Timeout.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from yarpy.data.bottle import Bottle
from yarpy.data.text import plain_text
from yarpy.data.value import Vocab
from yarpy.errors import LocalProtocolError
from yarpy.kits.autoqos.change import Change
from yarpy.names.base import NameClient
from yarpy.network.asking import called
from yarpy.network.qos import groups
from yarpy.network.rejoining import rejoin
from yarpy.qos import Qos

Ask = Callable[..., Bottle]  # the name of a port, then words


class Controls:
    """Makes changes at ports. `ask` asks a port."""

    def __init__(self, ask: Ask, names: NameClient | None = None) -> None:
        self._ask = ask
        self._names = names

    def make(self, change: Change) -> None:
        """Raises LocalProtocolError, LinkClosed, Timeout, UnknownName."""
        if change.key == "carrier":
            before = str(change.before or "")
            rejoin(change.port, change.peer, str(change.value), before, names=self._names)
        elif change.key == "limit":
            self._limit(change)
        else:
            peer = self._peer(change)
            reply = self._ask(change.port, "prop", "set", peer, *groups(wanted(change)))
            _check(change, reply)

    def is_gone(self, change: Change) -> bool:
        """Return whether the connection of a change no longer exists, and the setting with it."""
        if change.port == change.peer:
            return False
        return not self._knows(change.port, self._peer(change))

    def _knows(self, port: str, peer: str) -> bool:
        reply = self._ask(port, "prop", "get", peer)
        return bool(reply) and plain_text(reply[0]) != "fail"

    def _peer(self, change: Change) -> str:
        """The peer as the port that is asked calls it: by its address, if it was dialled so."""
        if change.port == change.peer or self._knows(change.port, change.peer):
            return change.peer
        return called(change.port, change.peer, self._names)

    def _limit(self, change: Change) -> None:
        port, peer, mbit = change.port, self._peer(change), change.value
        if port != peer or (mbit is not None and change.before is not None):
            reply = self._ask(port, "set", "out", peer, ["mbit", float(mbit or 0.0)])
        elif mbit is None:
            reply = self._ask(port, "dtch", "out")
        else:
            reply = self._ask(port, "atch", "out", ["monitor", "adaptive"], ["mbit", float(mbit)])
        _check(change, reply)


def wanted(change: Change) -> Qos:
    """Return the Qos that a change of a priority or deadline asks for. Raises ValueError."""
    value: Any = change.value
    if change.key == "packets":
        return Qos(packets=value)
    if change.key == "threads":
        policy, priority = value
        return Qos(policy, priority)
    deadline, rate = value
    return Qos(deadline=deadline, rate=rate)


def _check(change: Change, reply: Bottle) -> None:
    if reply and (reply[0] == 0 or reply[0] == Vocab("ok")):  # "set" and "prop" differ in that
        return
    reason = plain_text(reply[1])[:300] if len(reply) > 1 and isinstance(reply[1], str) else ""
    raise LocalProtocolError(
        f'"{change.port}" does not set {change.key} for "{change.peer}": {reason or "it refuses"}'
    )
