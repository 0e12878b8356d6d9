"""Nodes, topics and services of a domain of ROS 2, listed.

Rules: names with a part that begins with `_` are hidden, as the tools of ROS hide them. A topic is
listed once for each of its types.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import Final, NamedTuple

from yarpy.errors import DecodeError
from yarpy.peers.ros2.key import domain
from yarpy.peers.ros2.message.hash import full_name, ros_name
from yarpy.peers.ros2.token import NODE, PUBLISHER, SUBSCRIBER, Token
from yarpy.peers.ros2.zenoh.participant import CONFIGURATION, take_part
from yarpy.peers.zenoh.place import SETTING

RMW: Final = "RMW_IMPLEMENTATION"
OURS: Final = "rmw_zenoh_cpp"


class Entry(NamedTuple):
    """`kind`: node, topic or service; `type` is package/msg/Type, "" for nodes."""

    kind: str
    name: str
    type: str

    @property
    def carrier(self) -> str:
        """The carrier that reaches it."""
        return "ros2+srv" if self.kind == "service" else "ros2"

    @property
    def target(self) -> str:
        """The name to connect it by; for a node, its name."""
        return self.name if self.kind == "node" else f"{self.carrier}:/{self.name}~{self.type}"


def is_used(environment: Mapping[str, str]) -> bool:
    """Return whether an environment says that there is ROS 2 over Zenoh, or where a router is."""
    if environment.get(RMW) == OURS:
        return True
    return any(environment.get(name) for name in (CONFIGURATION, SETTING))


def listed(prefix: str = "") -> list[dict[str, str]]:
    """Return what `yarpy name list` shows of ROS 2; nothing where it is not used. Raises
    YarpError."""
    if not is_used(os.environ):
        return []
    return [
        {
            "line": f'{item.kind} "{item.target}"',
            "kind": item.kind,
            "name": item.name,
            "type": item.type,
            "carrier": item.carrier,
        }
        for item in listing(prefix)
    ]


def entries(tokens: Iterable[Token]) -> list[Entry]:
    """Nodes, topics and services, by name."""
    found: set[Entry] = set()
    for token in tokens:
        key = token.key
        if token.kind == NODE or key is None:
            found.add(Entry("node", str(token.node), ""))
            continue
        try:
            type_ = full_name(*ros_name(key.type))
        except DecodeError:
            type_ = key.type
        what = "topic" if token.kind in (PUBLISHER, SUBSCRIBER) else "service"
        found.add(Entry(what, key.name, type_))
    return sorted(entry for entry in found if "/_" not in entry.name)


def listing(prefix: str = "", domain_: int | None = None) -> list[Entry]:
    """Return what there is now below a prefix. Raises AddressError (ROS_DOMAIN_ID), and as `share`
    does (no router)."""
    part = take_part(domain(None) if domain_ is None else domain_)
    try:
        found = entries(part.graph.tokens)
    finally:
        part.close()
    below = prefix.rstrip("/") + "/"
    return [item for item in found if item.name == prefix or item.name.startswith(below)]
