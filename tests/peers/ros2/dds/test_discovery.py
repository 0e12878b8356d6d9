"""Which nodes others see, and which we see, with a program of another kind."""

from __future__ import annotations

from typing import Any

from support.wait import wait_until

import yarpy
from yarpy.peers import ros2
from yarpy.peers.ros2.dds.discovery import Discovery
from yarpy.peers.ros2.dds.pump import Pump
from yarpy.peers.ros2.name import Node


def test_others_see_our_nodes(node_peer: Any, own: str) -> None:
    def seen() -> dict[tuple[str, str], list[int]]:
        return {(row[0], row[1]): row[2:] for row in node_peer.do("nodes")}

    with ros2.Node(f"{own}/arm", rmw="dds") as node:
        # Six services of parameters and one of types have a reader and a writer each; and there
        # are events of parameters and /rosout.
        wait_until(lambda: seen().get((own, "arm")) == [7, 9])
        writer = node.publisher("x", "std_msgs/msg/String")
        wait_until(lambda: seen()[own, "arm"] == [7, 10])
        writer.close()
        wait_until(lambda: seen()[own, "arm"] == [7, 9])
        with yarpy.Port(f"{own}/out:o") as port:
            port.connect(f"ros2+dds:/{own}/y~std_msgs/msg/String")
            wait_until(lambda: seen().get((own, "out_o")) == [0, 1])
        wait_until(lambda: (own, "out_o") not in seen())
    wait_until(lambda: (own, "arm") not in seen())


def test_we_see_nodes_of_others(node_peer: Any, own: str) -> None:
    with ros2.Node(own, rmw="dds") as node:
        node_peer.do("be", own, "theirs")
        part = node._rmw.part  # type: ignore[attr-defined]
        wait_until(lambda: Node(own, "theirs") in part.nodes())
        assert Node("/", own[1:]) in part.nodes()
        theirs = Node(own, "theirs")
        wait_until(lambda: [token.node for token in part.seen("/clock", "MP")].count(theirs) == 1)


def test_what_is_no_list_of_nodes_is_ignored(here: None, own: str) -> None:
    from cyclonedds.domain import DomainParticipant

    class Sample:
        body = b"\0\1\0\0 not a list"

    dds = DomainParticipant(0)
    pump = Pump(dds)
    found = Discovery(dds, pump)
    try:
        found.nodes(set())
        found._hear([Sample(), object()])
        assert found.nodes(set()) == []
    finally:
        found.close()
        found.close()
        pump.close()


def test_who_comes_wakes_nobody_for_ever(here: None, own: str) -> None:
    """That a writer has come is a status of a reader, which stays until somebody takes it."""
    from cyclonedds.core import WaitSet
    from cyclonedds.domain import DomainParticipant

    sides = [(dds, Pump(dds)) for dds in (DomainParticipant(0), DomainParticipant(0))]
    found, other = (Discovery(dds, pump) for dds, pump in sides)
    waiting: Any = WaitSet(sides[0][0])
    try:
        found.nodes(set())
        other.add(Node(own, "other"))
        wait_until(lambda: Node(own, "other") in found.nodes({sides[1][0].guid}))
        waiting.attach(found._reader)
        wait_until(lambda: waiting.wait(0) == 0)
    finally:
        for each in (found, other):
            each.close()
        for _, pump in sides:
            pump.close()
