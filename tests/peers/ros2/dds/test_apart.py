"""Others whose type has the name of ours, and may grow, while those of ROS 2 stay as they are: a
program of another kind."""

from __future__ import annotations

import logging

import pytest
from support.dds_program import Peer
from support.wait import wait_until

import yarpy
from yarpy.peers import ros2
from yarpy.peers.ros2.event import Event

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
    """Beside one who does not, who is told of once; and a program hears of it, too."""
    events: list[Event] = []
    caplog.set_level(logging.WARNING, logger="yarpy")
    with Peer() as fitting, ros2.Node(own, rmw="dds") as node:  # a program has one type at a topic
        writer = node.publisher(f"{own}/x", TYPE, on_event=events.append)
        fitting.do("reader", f"{own}good", f"{own}/x", "reliable", "volatile", 10)
        peer.do("reader", f"{own}bad", f"{own}/x", "reliable", "volatile", 10, GROWING)
        peer.do("reader", f"{own}worse", f"{own}/x", "reliable", "volatile", 10, GROWING)
        wait_until(lambda: sum(event.times for event in events) == 2)
        assert {(event.kind, event.policy) for event in events} == {
            ("incompatible_qos", "type_consistency")
        }
        wait_until(lambda: writer.subscribers == 1)
        writer.write("hi")
        wait_until(lambda: fitting.heard(f"{own}good") == ["hi"])
        assert len(told(caplog)) == 1
    for name in ("bad", "worse"):
        peer.do("close", f"{own}{name}")
