"""What there is in a domain of ROS 2: its nodes, topics and services.

Rules: names with a part that begins with `_` are hidden, as the tools of ROS hide them. A topic is
listed once for each of its types.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Final, NamedTuple

from yarpy.errors import DecodeError
from yarpy.idl.ros2msg.hash import full_name, ros_name
from yarpy.ros2.key import domain
from yarpy.ros2.participant import CONFIGURATION, take_part
from yarpy.ros2.token import NODE, PUBLISHER, SUBSCRIBER, Token
from yarpy.transports.zenoh_place import SETTING

RMW: Final = "RMW_IMPLEMENTATION"
OURS: Final = "rmw_zenoh_cpp"


class Entry(NamedTuple):
    """`kind`: node, topic or service; `type` is package/msg/Type, "" for nodes."""

    kind: str
    name: str
    type: str

    @property
    def carrier(self) -> str:
        """What it is spoken to over."""
        return "ros2+srv" if self.kind == "service" else "ros2"

    @property
    def target(self) -> str:
        """What it is connected by; the name of a node."""
        return self.name if self.kind == "node" else f"{self.carrier}:/{self.name}~{self.type}"


def is_used(environment: Mapping[str, str]) -> bool:
    """Whether an environment says that there is ROS 2 over Zenoh, or where a router is."""
    if environment.get(RMW) == OURS:
        return True
    return any(environment.get(name) for name in (CONFIGURATION, SETTING))


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
    """What there is now, below a prefix. Raises AddressError (ROS_DOMAIN_ID), and as `share` does
    (no router)."""
    part = take_part(domain(None) if domain_ is None else domain_)
    try:
        found = entries(part.graph.tokens)
    finally:
        part.close()
    below = prefix.rstrip("/") + "/"
    return [item for item in found if item.name == prefix or item.name.startswith(below)]
