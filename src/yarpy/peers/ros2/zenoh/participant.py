"""Participants: our part in the graph of a domain, shared by all ports of this process.

Rules: a Zenoh session each, which is given back when the last of its topics is. A node is there as
long as one of its endpoints; its token goes with the last. The router is where
ZENOH_SESSION_CONFIG_URI or YARPY_ZENOH say, else on this computer.
"""

from __future__ import annotations

import os
import threading
from dataclasses import dataclass, field
from typing import Any, Final

from yarpy import fork
from yarpy.errors import UnknownPlugin
from yarpy.log import logger
from yarpy.peers.ros2.key import Key
from yarpy.peers.ros2.name import Node
from yarpy.peers.ros2.pool import Pool
from yarpy.peers.ros2.qos import Qos
from yarpy.peers.ros2.token import NODE, Token
from yarpy.peers.ros2.zenoh.graph import Graph
from yarpy.peers.zenoh.place import place
from yarpy.peers.zenoh.transport import SharedSession, share

log = logger("yarpy.ros2")

CONFIGURATION: Final = "ZENOH_SESSION_CONFIG_URI"


@dataclass(eq=False)
class _Node:
    """A node of ours: its token, and how many endpoints it has."""

    nid: int
    token: Any
    users: int = 0


@dataclass(eq=False)
class Declared:
    """An endpoint that others see once it is shown; `close` takes it back."""

    token: Token
    text: str
    _participant: Participant
    _handle: Any = None
    _closed: bool = False

    def show(self) -> None:
        """Show it to the graph. What it does works by then: who sees it makes use of it at once."""
        self._handle = self._participant.session.liveliness().declare_token(self.text)

    def close(self) -> None:
        """Idempotent."""
        if self._closed:
            return
        self._closed = True
        if self._handle is not None:
            self._handle.undeclare()
        self._participant.leave(self.token.node)


@dataclass(eq=False)
class Participant:
    """The session and graph that all topics of a domain share. `close` once for each
    `take_part`."""

    shared: SharedSession
    graph: Graph
    users: int = 0
    _hearing: Any = None
    _count: int = 0
    _nodes: dict[Node, _Node] = field(default_factory=dict)
    _rings: set[str] = field(default_factory=set)  # keys
    _lock: threading.RLock = field(default_factory=threading.RLock)

    @property
    def session(self) -> Any:
        """The Zenoh session."""
        return self.shared.session

    def _number(self) -> int:
        """The next number of what we declare."""
        found, self._count = self._count, self._count + 1
        return found

    def declare(self, kind: str, node: Node, key: Key, qos: Qos, extra: str = "") -> Declared:
        """Make the token of an endpoint of a node, and show the node with its first one."""
        with self._lock:
            ours = self._nodes.get(node)
            if ours is None:
                nid = self._number()
                token = Token(key.domain, self.shared.zid, nid, nid, NODE, node)
                shown = self.session.liveliness().declare_token(str(token))
                ours = self._nodes[node] = _Node(nid, shown)
            ours.users += 1
            zid, id_ = self.shared.zid, self._number()
        token = Token(key.domain, zid, ours.nid, id_, kind, node, key, qos, extra)
        others = self.graph.nodes(node) - {token.whose}
        if others and ours.users == 1:
            log.warning(
                "another node of ROS 2 is called %s already, and its tools take both for one: "
                "+node.NAME gives ours another name",
                node,
            )
        return Declared(token, str(token), self)

    def leave(self, node: Node) -> None:
        """An endpoint of the node is gone."""
        with self._lock:
            ours = self._nodes[node]
            ours.users -= 1
            if ours.users:
                return
            del self._nodes[node]
        ours.token.undeclare()

    def claim(self, key: str) -> bool:
        """Have the ring of a key, until `give_up`; False where another subscription has it."""
        with self._lock:
            free = key not in self._rings
            self._rings.add(key)
        return free

    def give_up(self, key: str) -> None:
        """The ring of a key is gone."""
        self._rings.discard(key)

    def close(self) -> None:
        """One user less; the last one closes the session."""
        _POOL.leave(self)

    def end(self) -> None:
        """Give the session back."""
        self._hearing.undeclare()
        self.shared.close()

    def ended(self) -> bool:
        """Return whether the session is closed."""
        return bool(self.session.is_closed())


def _begin(at: tuple[int, str]) -> Participant:
    domain, where = at
    try:
        shared = share(where)
    except UnknownPlugin as error:
        raise UnknownPlugin(f"{error}; for ROS 2: 'yarpy[ros2]'") from error
    found = Participant(shared, Graph(domain))
    found._hearing = found.graph.begin(shared.session)
    return found


_POOL: Final = Pool(_begin)  # by domain and by where Zenoh is
fork.after_in_child(_POOL.forget)


def take_part(domain: int) -> Participant:
    """Our part in a domain; `close` gives it back. Raises as `share` does."""
    return _POOL.take((domain, str(place(os.environ.get(CONFIGURATION, "")))))
