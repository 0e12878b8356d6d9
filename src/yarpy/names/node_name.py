"""Names of ports that are topics or services of a node, in the graph of another system.

    /camera+@/robot                 the node /robot publishes the topic /camera
    /camera-@/viewer                /viewer subscribes to it
    /sum-1@/server, /sum+1@/user    serves and calls the service /sum
    /chatter+@/me~std_msgs/String   ... with a type

    /viewer=-/camera, /viewer-#/camera      older ways to write the second

Rules: pure. A port without a category (`/camera@/robot`) gets the one for what it does. Names
without `@`, `=/` and `#/` are those of ordinary ports.

    >>> name = parse_node_name("/camera+@/robot~sensor_msgs/Image")
    >>> name.node, name.topic, name.category, name.type
    ('/robot', '/camera', '+', 'sensor_msgs/Image')
    >>> str(name)
    '/camera+@/robot'
    >>> parse_node_name("/viewer=-/camera"), parse_node_name("/viewer-#/camera").topic
    (NodeName(node='/viewer', topic='/camera', category='-', type=''), '/camera')
    >>> parse_node_name("/an/ordinary/port") is None
    True
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from typing import Final, Literal, TypeAlias

from yarpy.errors import AddressError

Category: TypeAlias = Literal["", "+", "-", "+1", "-1"]

PUBLISHER: Final = "+"
SUBSCRIBER: Final = "-"
CLIENT: Final = "+1"
SERVER: Final = "-1"

_PREFIX: Final = re.compile(r"[A-Za-z0-9_]*:/(?=/)")
_CATEGORY: Final = re.compile(r"[+-]1?\Z")
_EQUALS: Final = re.compile(r"([^=]*)=([+-]1?)?(/.*)")
_HASH: Final = re.compile(r"([^#]*?)([+-])?#(/.*)")


@dataclass(frozen=True, slots=True)
class NodeName:
    """A topic or service of a node, and what the node does with it. `node` is "" where the program
    says which it is."""

    node: str
    topic: str
    category: Category = ""
    type: str = ""

    @property
    def is_service(self) -> bool:
        """Return whether it is a service, not a topic."""
        return self.category in (CLIENT, SERVER)

    def having(self, category: Category) -> NodeName:
        """The same name with a category, if it has none of its own."""
        return self if self.category else replace(self, category=category)

    def __str__(self) -> str:
        return f"{self.topic}{self.category}@{self.node}"


def parse_node_name(text: str) -> NodeName | None:
    """Parse the name of a port that belongs to a node; None for that of an ordinary port.

    Raises AddressError for a topic or node that does not begin with a slash.
    """
    prefix = _PREFIX.match(text)
    text, _, type_ = text[prefix.end() if prefix else 0 :].partition("~")
    category = ""
    if "@" in text:
        topic, _, node = text.partition("@")
        found = _CATEGORY.search(topic)
        if found:
            category, topic = found[0], topic[: found.start()]
    else:
        parts = _EQUALS.fullmatch(text) or _HASH.fullmatch(text)
        if parts is None:
            return None
        node, category, topic = parts[1], parts[2] or "", parts[3]
    if not topic.startswith("/") or (node and not node.startswith("/")):
        raise AddressError(
            f'"{text[:80]}": a topic and its node begin with "/", as in /topic@/node'
        )
    return NodeName(node, topic, category, type_)  # type: ignore[arg-type]


def node_of(name: str) -> str:
    """The name of the node that a port belongs to; an ordinary port is its own node.

    >>> node_of("/camera+@/robot"), node_of("/w")
    ('/robot', '/w')
    """
    try:
        found = parse_node_name(name)
    except AddressError:
        return name
    return name if found is None or not found.node else found.node
