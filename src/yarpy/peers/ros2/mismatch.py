"""Warnings in the log of others at our topic with another type.

Rules: each node is told of once for each type, and not more than `MOST_TOLD` in all, whichever
threads look: those who are there are told of in the thread that asks, those who come in another.
Where somebody has the same type without saying which version, it counts as ours, unless the
middleware has compared both and says otherwise.
"""

from __future__ import annotations

import threading
from typing import Final

from yarpy.log import logger, readable
from yarpy.peers.ros2 import kind as kinds
from yarpy.peers.ros2.key import NO_HASH, Key
from yarpy.peers.ros2.name import NOBODY, Node
from yarpy.peers.ros2.token import Token

log = logger("yarpy.ros2")

MOST_TOLD: Final = 100  # peers of other types that the log names


class Mismatch:
    """Tells of those at a topic who have another type than `ours`. `strict`: no version at all is
    another one, too, as it is over Zenoh."""

    def __init__(self, port_name: str, ours: Key, strict: bool) -> None:
        self._port_name, self._ours, self._strict = port_name, ours, strict
        self._told: set[tuple[Node, Key]] = set()
        self._lock = threading.Lock()  # guards what was told

    def look(self, token: Token) -> None:
        """Tell of a peer, if it has another type."""
        theirs, ours = token.key, self._ours
        if theirs is None or theirs[2:] == ours[2:]:
            return
        same = theirs.type == ours.type
        if same and not self._strict and NO_HASH in (theirs.hash, ours.hash):
            return
        self._tell(
            token,
            f"it is {readable(_shown(theirs))} there and {_shown(ours)} here",
            "give both the same version of that package"
            if same
            else "give both one type, or one of them another name",
        )

    def refused(self, token: Token, why: str, remedy: str) -> None:
        """Tell of a peer whose type has the name of ours, and that the middleware keeps apart."""
        name = _shown(self._ours._replace(hash=NO_HASH))
        self._tell(token, f"both call their type {name}, but {why}", remedy)

    def _tell(self, token: Token, what: str, remedy: str) -> None:
        assert token.key is not None
        with self._lock:
            if (token.node, token.key) in self._told or len(self._told) >= MOST_TOLD:
                return
            self._told.add((token.node, token.key))
        log.warning(
            "%s and %s do not hear each other at %s: %s; %s",
            self._port_name,
            "a program" if token.node == NOBODY else f"the node {readable(str(token.node))}",
            self._ours.name,
            what,
            remedy,
        )


def _shown(key: Key) -> str:
    return kinds.shown(key).removesuffix(f" ({NO_HASH})")
