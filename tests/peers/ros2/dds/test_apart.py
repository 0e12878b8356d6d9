"""Others whose type has the name of ours, and may grow, while those of ROS 2 stay as they are: a
program of another kind."""

from __future__ import annotations

import logging

import pytest
from support.dds_program import Peer
from support.wait import wait_until

import yarpy
from yarpy.peers import ros2
from yarpy.peers.ros2.dds.apart import apart
from yarpy.peers.ros2.dds.status import TYPE as CONSISTENCY
from yarpy.peers.ros2.event import Event
from yarpy.peers.ros2.token import SUBSCRIBER

TYPE = "std_msgs/msg/String"
GROWING = {"type": "Growing"}
SAID = f"both call their type {TYPE}, but "


def told(caplog: pytest.LogCaptureFixture) -> list[str]:
    return [item.getMessage() for item in caplog.records if SAID in item.getMessage()]


@pytest.mark.parametrize("order", ["yarpy first", "yarpy last"])
@pytest.mark.parametrize("what", ["reader", "writer"])
@pytest.mark.parametrize("qos", ["", "+qos.default"])
def test_a_type_that_may_grow_is_named(
    peer: Peer, topic: str, what: str, order: str, qos: str, caplog: pytest.LogCaptureFixture
) -> None:
    theirs = (what, f"t{topic}", topic, "reliable", "volatile", 10, GROWING)
    target = f"ros2+dds{qos}:/{topic}~{TYPE}"
    with yarpy.Port("/growing") as port, caplog.at_level(logging.WARNING, logger="yarpy"):
        if order == "yarpy last":
            peer.do(*theirs)
        port.connect(target) if what == "reader" else port.listen_to(target)
        if order == "yarpy first":
            peer.do(*theirs)
        wait_until(lambda: told(caplog))
        (text,) = told(caplog)
        assert text.startswith(f"/growing and a program do not hear each other at {topic}: ")
        assert "@appendable" in text
        assert text.endswith("@final: declare it there so, with the same fields")
        assert "promises less" not in caplog.text
    peer.do("close", f"t{topic}")


def test_who_takes_the_second_way_of_writing_alone_is_named(
    peer: Peer, topic: str, caplog: pytest.LogCaptureFixture
) -> None:
    """One of the very type."""
    with yarpy.Port("/first") as port, caplog.at_level(logging.WARNING, logger="yarpy"):
        port.connect(f"ros2+dds:/{topic}~{TYPE}")
        peer.do("reader", f"t{topic}", topic, "reliable", "volatile", 10, {"xcdr2": True})
        wait_until(lambda: told(caplog))
        (text,) = told(caplog)
        assert f"{SAID}it is taken there as XCDR2 alone" in text
        assert text.endswith("go as XCDR1: declare it there so, and let that be taken")
    peer.do("close", f"t{topic}")


def test_who_fits_is_heard_and_not_named(
    peer: Peer, own: str, caplog: pytest.LogCaptureFixture
) -> None:
    """Nor is one of our type that asks for more than we promise. Two of one program are told of
    once, and our program hears of them, too."""
    events: list[Event] = []
    caplog.set_level(logging.WARNING, logger="yarpy")
    name = f"{own}/x"
    with Peer() as fitting, ros2.Node(own, rmw="dds") as node:  # a program has one type at a topic
        writer = node.publisher(name, TYPE, qos=ros2.qos_profile(), on_event=events.append)
        fitting.do("reader", f"{own}good", name, "reliable", "volatile", 10)
        fitting.do("reader", f"{own}more", name, "reliable", "transient_local", 10)
        wait_until(lambda: events)
        peer.do("reader", f"{own}bad", name, "reliable", "volatile", 10, GROWING)
        peer.do("reader", f"{own}worse", name, "reliable", "volatile", 10, GROWING)
        wait_until(lambda: sum(event.times for event in events) == 3)
        assert {event.policy for event in events} == {"durability", "type_consistency"}
        wait_until(lambda: writer.subscribers == 1)
        writer.write("hi")
        wait_until(lambda: fitting.heard(f"{own}good") == ["hi"])
        assert len(told(caplog)) == 1
        part, entity = writer._part, writer._entity
        found = [*apart(CONSISTENCY, part, entity, writer._class, writer._key, SUBSCRIBER)]
        assert len(found) == 2
        assert len({token.zid for token in found}) == 1
    for each in ("bad", "worse"):
        peer.do("close", f"{own}{each}")
