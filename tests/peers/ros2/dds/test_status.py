"""The quality of service of ROS 2 over DDS, policy by policy: what is said of it does what it does,
and who is kept out is told. The other side is a program of another kind.
"""

from __future__ import annotations

import threading
import time
from typing import Any

import pytest
from support.wait import wait_until

from yarpy.peers import ros2
from yarpy.peers.ros2.event import Event

PAUSE = threading.Event()  # never set
TYPE = "std_msgs/msg/String"
SOON = {"deadline": 50}

#: by policy: what we say, and what the other side says that is more than that
TOO_LITTLE_OFFERED = {
    "reliability": ({"reliability": "best_effort"}, ("reliable", "volatile", 10)),
    "durability": ({"durability": "volatile"}, ("reliable", "transient_local", 10)),
    "deadline": ({"deadline": 5}, ("reliable", "volatile", 10, {"deadline": 100})),
    "liveliness": ({"lease": 5}, ("reliable", "volatile", 10, {"lease": 100})),
}
#: the same for what we ask for
TOO_MUCH_ASKED = {
    "reliability": ({"reliability": "reliable"}, ("best_effort", "volatile", 10)),
    "durability": ({"durability": "transient_local"}, ("reliable", "volatile", 10)),
    "deadline": ({"deadline": 0.1}, ("reliable", "volatile", 10, {"deadline": 5000})),
    "liveliness": (
        {"liveliness": "manual_by_topic", "lease": 0.1},
        ("reliable", "volatile", 10),
    ),
}


@pytest.mark.parametrize("policy", TOO_LITTLE_OFFERED)
def test_a_publisher_hears_whom_it_keeps_out(peer: Any, own: str, policy: str) -> None:
    said, theirs = TOO_LITTLE_OFFERED[policy]
    events: list[Event] = []
    with ros2.Node(own, rmw="dds") as node:
        node.publisher(f"{own}/x", TYPE, qos=ros2.qos_profile(**said), on_event=events.append)
        peer.do("reader", own, f"{own}/x", *theirs)
        wait_until(lambda: events)
        assert events == [("incompatible_qos", 1, policy)]
        wait_until(lambda: peer.do("events", own)[0]["incompatible_qos"] == 1)
    peer.do("close", own)


@pytest.mark.parametrize("policy", TOO_MUCH_ASKED)
def test_a_subscriber_hears_whom_it_keeps_out(peer: Any, own: str, policy: str) -> None:
    said, theirs = TOO_MUCH_ASKED[policy]
    events: list[Event] = []
    with ros2.Node(own, rmw="dds") as node:
        qos = ros2.qos_profile(**said)
        node.subscriber(f"{own}/x", TYPE, print, qos=qos, on_event=events.append)
        peer.do("writer", own, f"{own}/x", *theirs)
        wait_until(lambda: events)
        assert events == [("incompatible_qos", 1, policy)]
    peer.do("close", own)


def test_history_and_depth_of_a_publisher(peer: Any, own: str) -> None:
    rows = {
        "three": ros2.qos_profile(durability="transient_local", depth=3),
        "all": ros2.qos_profile(durability="transient_local", history="keep_all"),
    }
    with ros2.Node(own, rmw="dds") as node:
        for name, qos in rows.items():
            writer = node.publisher(f"{own}/{name}", TYPE, qos=qos)
            for number in range(20):
                writer.write(str(number))
            peer.do("reader", f"{own}{name}", f"{own}/{name}", "reliable", "transient_local", 0)
        wait_until(lambda: len(peer.heard(f"{own}all")) == 20)
        wait_until(lambda: "19" in peer.heard(f"{own}three"))
        assert peer.heard(f"{own}three") == ["17", "18", "19"]
    for name in rows:
        peer.do("close", f"{own}{name}")


def test_deadline_of_a_publisher(peer: Any, own: str) -> None:
    events: list[Event] = []
    with ros2.Node(own, rmw="dds") as node:
        qos = ros2.qos_profile(deadline=0.05)
        writer = node.publisher(f"{own}/x", TYPE, qos=qos, on_event=events.append)
        peer.do("reader", own, f"{own}/x", "reliable", "volatile", 10, SOON)

        def missed() -> bool:
            writer.write("once")  # again, should the reader not have known us yet
            PAUSE.wait(0.2)
            return bool(peer.do("events", own)[0]["deadline_missed"])

        wait_until(missed)
        wait_until(lambda: [event for event in events if event.kind == "deadline_missed"])
        assert writer.events.counts["deadline_missed"] >= 1
    peer.do("close", own)


def test_deadline_of_a_subscriber(peer: Any, own: str) -> None:
    events: list[Event] = []
    heard: list[Any] = []
    with ros2.Node(own, rmw="dds") as node:
        qos = ros2.qos_profile(deadline=0.05)
        node.subscriber(f"{own}/x", TYPE, heard.append, qos=qos, on_event=events.append)
        peer.do("writer", own, f"{own}/x", "reliable", "volatile", 10, SOON)
        while not heard:
            peer.do("write", own, "once")
            PAUSE.wait(0.1)
        wait_until(lambda: [event for event in events if event.kind == "deadline_missed"])
    peer.do("close", own)


def test_lifespan_of_a_publisher(peer: Any, own: str) -> None:
    """What is older than that is not told to who comes late."""
    with ros2.Node(own, rmw="dds") as node:
        qos = ros2.qos_profile("latched", depth=10, lifespan=0.1)
        writer = node.publisher(f"{own}/x", TYPE, qos=qos)
        writer.write("old")
        over = time.monotonic() + 0.3
        wait_until(lambda: time.monotonic() > over)
        peer.do("reader", own, f"{own}/x", "reliable", "transient_local", 10)

        def heard() -> bool:
            writer.write("new")
            PAUSE.wait(0.02)
            return "new" in peer.heard(own)

        wait_until(heard)
        assert "old" not in peer.heard(own)
    peer.do("close", own)


def test_lifespan_of_others(peer: Any, own: str) -> None:
    heard: list[str] = []
    peer.do("writer", own, f"{own}/x", "reliable", "transient_local", 10, {"lifespan": 300})
    peer.do("write", own, "old")
    over = time.monotonic() + 0.6
    wait_until(lambda: time.monotonic() > over)
    with ros2.Node(own, rmw="dds") as node:
        arrived = threading.Event()

        def hear(message: Any) -> None:
            heard.append(message.data)
            arrived.set()

        node.subscriber(f"{own}/x", TYPE, hear)
        while not heard:  # a flood would make the writer wait for its reader
            peer.do("write", own, "new")
            arrived.wait(0.1)
    assert set(heard) == {"new"}
    peer.do("close", own)


def test_liveliness_of_a_publisher(peer: Any, own: str) -> None:
    events: list[Event] = []
    with ros2.Node(own, rmw="dds") as node:
        qos = ros2.qos_profile(liveliness="manual_by_topic", lease=0.1)
        writer = node.publisher(f"{own}/x", TYPE, qos=qos, on_event=events.append)
        peer.do("reader", own, f"{own}/x", "reliable", "volatile", 10, {"lease": 100})

        def lost() -> bool:
            writer.write("once")  # again, should the reader not have known us yet
            PAUSE.wait(0.3)
            return bool(peer.do("events", own)[0]["not_alive"] == 1)

        wait_until(lost)
        wait_until(lambda: [event for event in events if event.kind == "liveliness_lost"])
    peer.do("close", own)


def test_liveliness_of_others(peer: Any, own: str) -> None:
    alive: list[int] = []

    def hear(event: Event) -> None:
        if event.kind == "liveliness_changed":
            alive.append(event.times)

    with ros2.Node(own, rmw="dds") as node:
        qos = ros2.qos_profile(liveliness="manual_by_topic", lease=0.3)
        node.subscriber(f"{own}/x", TYPE, print, qos=qos, on_event=hear)
        peer.do("writer", own, f"{own}/x", "reliable", "volatile", 10, {"lease": 300})
        while 1 not in alive:  # again, should we not have known it yet
            peer.do("write", own, "once")
            PAUSE.wait(0.1)
        wait_until(lambda: alive[-1] == 0)
    peer.do("close", own)
