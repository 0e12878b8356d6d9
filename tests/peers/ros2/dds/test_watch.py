"""Who comes to a topic over DDS: a program of another kind whose type is another one."""

from __future__ import annotations

import logging

import pytest
from support.dds_program import Peer
from support.wait import wait_until

import yarpy
from yarpy.peers.ros2.dds.participant import POOL
from yarpy.peers.ros2.token import PUBLISHER, SUBSCRIBER

INT = {"type": "Int32"}
SAID = "std_msgs/msg/Int32 there and std_msgs/msg/String"


@pytest.mark.parametrize("order", ["yarpy first", "yarpy last"])
@pytest.mark.parametrize("what", ["reader", "writer"])
def test_another_type_is_named(
    peer: Peer, topic: str, what: str, order: str, caplog: pytest.LogCaptureFixture
) -> None:
    theirs = (what, f"t{topic}", topic, "reliable", "volatile", 10, INT)
    target = f"ros2+dds:/{topic}~std_msgs/msg/String"
    with yarpy.Port("/mixed") as port, caplog.at_level(logging.WARNING, logger="yarpy"):
        if order == "yarpy last":
            peer.do(*theirs)
        port.connect(target) if what == "reader" else port.listen_to(target)
        if order == "yarpy first":
            peer.do(*theirs)
        wait_until(lambda: SAID in caplog.text)
        told = [item.getMessage() for item in caplog.records if SAID in item.getMessage()]
        assert len(told) == 1
        assert told[0].startswith(f"/mixed and a program do not hear each other at {topic}: ")
        assert "give both one type" in told[0]
    peer.do("close", f"t{topic}")


def test_who_has_the_type_is_told_of_too(peer: Peer, topic: str) -> None:
    part = POOL.take(0)
    heard: list[str] = []
    try:
        peer.do("writer", f"w{topic}", topic, "reliable", "volatile", 10)
        wait_until(lambda: part.seen(topic, PUBLISHER))
        part.watch.add(topic, PUBLISHER, lambda token: heard.append(token.key.type))  # type: ignore[union-attr]
        assert heard[:1] == ["std_msgs::msg::dds_::String_"]
        part.watch.add(topic, SUBSCRIBER, came := lambda token: heard.append(token.kind))  # type: ignore[misc]
        peer.do("reader", f"r{topic}", topic, "reliable", "volatile", 10)
        wait_until(lambda: heard[-1] == SUBSCRIBER)
        part.watch.remove(came)
        peer.do("reader", f"s{topic}", topic, "reliable", "volatile", 10)
        wait_until(lambda: len(part.seen(topic, SUBSCRIBER)) == 2)
        assert heard.count(SUBSCRIBER) == 1
    finally:
        POOL.leave(part)
    for name in "wrs":
        peer.do("close", f"{name}{topic}")
