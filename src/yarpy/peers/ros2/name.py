"""Names of ROS 2: what topics and nodes may be called, and what ports of YARP are called there.

Rules: a name has parts of letters, digits and `_`, none of which begins with a digit. The name of a
port becomes that of a node: its last part in a namespace of those before.
"""

from __future__ import annotations

import re
from typing import Final, NamedTuple

from yarpy.errors import AddressError

MOST: Final = 250  # characters of a name
_PART = re.compile(r"[A-Za-z_][A-Za-z0-9_]*+")
_NAME = re.compile(rf"(?>(?:/{_PART.pattern})+)")


class Node(NamedTuple):
    """A node: `namespace` begins with a slash, and is "/" for the root."""

    namespace: str
    name: str

    def __str__(self) -> str:
        return f"{self.namespace.rstrip('/')}/{self.name}"


NOBODY: Final = Node("/", "_")  # of an endpoint over DDS whose node nobody has told


def check_topic(name: str) -> str:
    """The name of a topic or service with its leading slash. Raises AddressError."""
    whole = "/" + name.strip("/")
    if not _NAME.fullmatch(whole) or len(whole) > MOST:
        raise AddressError(
            f'"{name[:80]}" is no name of ROS 2: letters, digits and "_", in parts with a "/" '
            "between, none of which begins with a digit"
        )
    return whole


def node_of(port: str) -> Node:
    """Return the name of a port as a node.

    >>> str(node_of("/icub/head/state:o"))
    '/icub/head/state_o'
    """
    parts = [re.sub(r"[^A-Za-z0-9_]", "_", part) for part in port.split("/") if part] or ["yarpy"]
    whole = [part if part[0].isalpha() else f"n{part}" for part in parts]  # with `_` it is hidden
    return Node("/" + "/".join(whole[:-1]), whole[-1])


def check_node(name: str) -> Node:
    """The node that a user names, with or without a namespace. Raises AddressError."""
    whole = check_topic(name)
    namespace, _, last = whole.rpartition("/")
    return Node(namespace or "/", last)
