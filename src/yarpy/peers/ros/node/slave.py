"""Answers of a node to the master, to other nodes and to the tools of ROS.

Rules: every answer is [code, message, value]: 1 done, 0 it could not be, -1 not understood. The
first argument is who asks. Over XML-RPC and as administrative messages alike.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import Any, Final, Protocol

from yarpy.data.text import plain_text
from yarpy.data.xmlrpc import Plain
from yarpy.names.node_name import PUBLISHER, SUBSCRIBER
from yarpy.peers.ros.graph_name import ros_name
from yarpy.peers.ros.membership import Membership
from yarpy.peers.ros.node.parameters import Followed
from yarpy.registry import graphs


class Node(Protocol):
    """The node whose state the slave API reports."""

    @property
    def members(self) -> Sequence[Membership]:
        """Its topics and services."""

    @property
    def master_uri(self) -> str:
        """The address of its master."""

    @property
    def host(self) -> str:
        """The host of its topics."""

    @property
    def parameters(self) -> Followed:
        """The parameters that it is told of."""

    def shut_down(self, reason: str) -> None:
        """Leave the graph, soon."""


def answer(node: Node, words: Sequence[Any]) -> Plain | None:
    """The answer to a call; None for what nodes are not asked."""
    name = plain_text(words[0]) if words and isinstance(words[0], str) else ""
    called = graphs.call(name)
    asked = CALLS.get(called[1].name) if called is not None else None
    return None if asked is None else asked(node, [*words[2:]])


def _done(value: Any, text: str = "") -> Plain:
    return Plain([1, text, value])


def _text(arguments: Sequence[Any], at: int) -> str:
    return plain_text(arguments[at]) if len(arguments) > at else ""


def _bus_info(node: Node, arguments: Sequence[Any]) -> Plain:
    found: list[list[Any]] = []
    for member in node.members:
        hub = member.hub
        if hub is None:
            continue
        for link in hub.inputs.links:
            if link.route.source != "admin":
                peer, way = member.uri_of(link) or link.route.source, "i"
                found.append([len(found) + 1, peer, way, "TCPROS", member.topic, True])
        for output in hub.outputs.links:
            peer = output.route.target
            found.append([len(found) + 1, peer, "o", "TCPROS", member.topic, True])
    return _done(found)


def _bus_stats(node: Node, arguments: Sequence[Any]) -> Plain:
    outgoing, incoming = [], []
    for member in node.members:
        hub = member.hub
        if hub is None or member.name.is_service:
            continue
        rows = [
            [at, link.counter.bytes, link.counter.messages, True]
            for at, link in enumerate(hub.outputs.links, 1)
        ]
        if member.name.category == PUBLISHER:
            outgoing.append([member.topic, sum(row[1] for row in rows), rows])
        else:
            received = [
                [at, link.counter.bytes, link.counter.drops, True]
                for at, link in enumerate(hub.inputs.links, 1)
            ]
            incoming.append([member.topic, received])
    return _done([outgoing, incoming, []])


def _topics(node: Node, category: str) -> Plain:
    found = [
        [member.topic, member.shown_type]
        for member in node.members
        if member.name.category == category
    ]
    return _done(found)


def _request_topic(node: Node, arguments: Sequence[Any]) -> Plain:
    topic = ros_name(_text(arguments, 0))
    for member in node.members:
        if member.topic == topic and member.name.category == PUBLISHER and member.hub is not None:
            return _done(["TCPROS", node.host, member.hub.port], f"ready at {node.host}")
    return Plain([0, f"{topic} is not published here", 0])


def _publisher_update(node: Node, arguments: Sequence[Any]) -> Plain:
    topic = ros_name(_text(arguments, 0))
    uris = arguments[1] if len(arguments) > 1 and isinstance(arguments[1], (list, tuple)) else []
    members = [
        member
        for member in node.members
        if member.topic == topic and member.name.category == SUBSCRIBER
    ]
    for member in members:
        member.update([plain_text(uri) for uri in uris])
    return _done(0) if members else Plain([0, f"nobody here subscribes to {topic}", 0])


def _param_update(node: Node, arguments: Sequence[Any]) -> Plain:
    key = ros_name(_text(arguments, 0))
    if node.parameters.change(key):
        return _done(0)
    return Plain([-1, f"nobody here subscribes to the parameter {key}", 0])


def _shutdown(node: Node, arguments: Sequence[Any]) -> Plain:
    node.shut_down(_text(arguments, 0))
    return _done(0)


CALLS: Final[dict[str, Callable[[Node, Sequence[Any]], Plain]]] = {
    "getBusInfo": _bus_info,
    "getBusStats": _bus_stats,
    "getMasterUri": lambda node, arguments: _done(node.master_uri),
    "getPid": lambda node, arguments: _done(os.getpid()),
    "getPublications": lambda node, arguments: _topics(node, PUBLISHER),
    "getSubscriptions": lambda node, arguments: _topics(node, SUBSCRIBER),
    "paramUpdate": _param_update,
    "publisherUpdate": _publisher_update,
    "requestTopic": _request_topic,
    "shutdown": _shutdown,
}
