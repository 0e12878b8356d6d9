"""Topics over DDS for a node of a program."""

from __future__ import annotations

import sys
import threading
from typing import Any

import pytest
from support.wait import HANG, wait_until

from yarpy.peers import ros2


def test_topics(here: None, own: str) -> None:
    heard: list[Any] = []

    def hear(message: Any) -> None:
        heard.append(message.data)
        raise ValueError("of the test")

    with ros2.Node(own, rmw="dds") as node:
        topic = node.subscriber(f"{own}/x", "std_msgs/msg/String", hear)
        writer = node.publisher(f"{own}/x", "std_msgs/msg/String", qos="latched")
        writer.write("once")

        def twice() -> bool:
            writer.write("more")
            return heard.count("more") > 1

        wait_until(twice)
        # A new reader is beside the old one for a second, and until something comes to it.
        wait_until(lambda: writer.write("more") or writer.subscribers == 1)
        topic.close()
        topic.close()
        wait_until(lambda: writer.subscribers == 0)
        writer.close()
        assert writer.subscribers == 0


def test_who_calls_sys_exit_goes_on_hearing(
    here: None, own: str, caplog: pytest.LogCaptureFixture
) -> None:
    heard: list[Any] = []

    def hear(message: Any) -> None:
        heard.append(message.data)
        if message.data == "leave":
            sys.exit(3)

    with ros2.Node(own, rmw="dds") as node:
        node.subscriber(f"{own}/x", "std_msgs/msg/String", hear)
        writer = node.publisher(f"{own}/x", "std_msgs/msg/String")
        wait_until(lambda: writer.subscribers == 1)
        writer.write("leave")
        writer.write("stay")
        wait_until(lambda: heard == ["leave", "stay"])
    assert "sys.exit() in a thread of a port ends no program" in caplog.text


def test_a_signal_handler_closes_in_the_middle_of_a_write(here: None, own: str) -> None:
    with ros2.Node(own, rmw="dds") as node:
        out: Any = node.publisher(f"{own}/cut", "std_msgs/msg/String")
        give = out.give

        def interrupted(item: Any) -> None:
            out.close()
            give(item)

        out.give = interrupted
        writes = threading.Thread(target=out.write, args=("cut off",), daemon=True)
        writes.start()
        writes.join(HANG)
        assert not writes.is_alive() and out.ended()
