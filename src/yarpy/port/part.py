"""Parts: what ports play in the graph of another system, such as the topics of ROS.

Rules: contracts alone. Who plays them is looked up by name (registry kind `graphs`): it lives above
the ports, since nodes have ports of their own.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol

from yarpy import registry
from yarpy.config.configuration import port_name
from yarpy.errors import AddressError
from yarpy.names.base import NameClient
from yarpy.names.node_name import Category, parse_node_name

if TYPE_CHECKING:
    from yarpy.link.outbound import Outbound
    from yarpy.route import Declared


class Seat(Protocol):
    """The place of an open port in the graph."""

    def welcome(self, link: Outbound, /) -> None:
        """A reader has dialled the port."""

    def lost(self) -> None:
        """A connection of the port has ended."""

    def leave(self) -> None:
        """The port closes."""


class Part(Protocol):
    """What a port will be there. `names`: its name service, None: none is told of it."""

    @property
    def port_name(self) -> str: ...

    @property
    def names(self) -> NameClient | None: ...

    @property
    def declared(self) -> Declared: ...

    def join(self, hub: Any, opener: Callable[..., Any], /) -> None:
        """The port is open: take a `seat`. `opener` opens others. Raises AddressError,
        NoNameServer."""


def find_part(
    name: str, category: Category, port_type: str, names: NameClient | None
) -> Part | None:
    """The part of a port, if it is called like one of a node (`/topic@/node`); None for ordinary
    names. `category` is that of what the port does, where its name does not say.

    Raises AddressError, NoNameServer.
    """
    if not name or name.startswith(("...", "=")):
        return None
    wanted = parse_node_name(port_name(name, os.environ))
    if wanted is None:
        return None
    wanted = wanted.having(category)
    topic, node = wanted.topic, wanted.node
    if not node:
        raise AddressError(f'"{name}": of which node? Name it: {topic}@/node')
    if not wanted.category:
        raise AddressError(
            f'"{name}": say what the port does with the topic: "{topic}+@{node}" publishes it, '
            f'"{topic}-@{node}" subscribes to it'
        )
    part: Part = registry.graphs.load("ros")(wanted, port_type, names)
    return part
