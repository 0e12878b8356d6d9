"""Graphs: other systems whose nodes have topics and services, which ports may be.

Rules: contracts alone. Graphs are looked up by name (registry kind `graphs`): they live above the
ports, since nodes have ports of their own.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol

from yarpy import registry
from yarpy.config.configuration import port_name
from yarpy.data.bottle import Bottle
from yarpy.errors import AddressError
from yarpy.facts import Call
from yarpy.names.base import NameClient
from yarpy.names.node_name import Category, NodeName, parse_node_name

if TYPE_CHECKING:
    from yarpy.link.send.outbound import Outbound
    from yarpy.route import Declared


class Membership(Protocol):
    """The place of an open port in the graph."""

    def admit(self, link: Outbound, /) -> None:
        """A reader that has dialled us is about to be an output; it was sent nothing."""

    def welcome(self, link: Outbound, /) -> None:
        """A reader has dialled the port."""

    def lost(self) -> None:
        """A connection of the port has ended."""

    def unheard(self, value: object, /) -> None:
        """The port wrote that while nobody was connected."""

    def leave(self) -> None:
        """The port closes."""


class Role(Protocol):
    """A port as a member of the graph of a node. `names`: its name service, None: none is told of
    it."""

    @property
    def port_name(self) -> str: ...

    @property
    def names(self) -> NameClient | None: ...

    @property
    def declared(self) -> Declared: ...

    def join(self, hub: Any, opener: Callable[..., Any], /) -> None:
        """The port is open: set its `membership`. `opener` opens others. Raises AddressError,
        NoNameServer."""


class Graph(Protocol):
    """A graph, made without arguments. `calls`: those of its nodes."""

    calls: tuple[Call, ...]

    def role_of(self, name: NodeName, port_type: str, names: NameClient | None, /) -> Role:
        """Return what a port with this name is there. Raises AddressError, NoNameServer."""

    def prepare(self) -> None:
        """Get ready for asking its services. Raises NoNameServer."""

    def answer(self, call: str, hub: Any, /) -> Bottle:
        """Return what a port that belongs to no node answers to one of the `calls`."""


def find_role(
    name: str, category: Category, port_type: str, names: NameClient | None
) -> Role | None:
    """The role of a port, if it is called like one of a node (`/topic@/node`); None for ordinary
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
    for kind in registry.graphs:
        graph: Graph = kind()
        return graph.role_of(wanted, port_type, names)
    raise AddressError(f'"{name}": no graph with nodes is installed; `yarpy plugin` lists what is')
