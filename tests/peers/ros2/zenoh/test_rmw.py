"""A node's endpoints over Zenoh."""

from __future__ import annotations

from typing import Any

from support.wait import HANG, wait_until

import yarpy
from yarpy.peers.ros2.exchange import Question, Worker
from yarpy.peers.ros2.name import Node
from yarpy.peers.ros2.zenoh.rmw import ZenohRmw

ADD = "example_interfaces/srv/AddTwoInts"


def test_all_kinds(names: yarpy.LocalNames) -> None:
    rmw, worker = ZenohRmw(Node("/", "rmw"), 0), Worker("test")
    heard: list[Any] = []

    def add(question: Question) -> None:
        question.answer([question.request.a + question.request.b])

    reader = rmw.reader("/rmw/x", "std_msgs/msg/String", heard.append, worker, None)
    writer = rmw.writer("/rmw/x", "std_msgs/msg/String", None)
    answerer = rmw.answerer("/rmw/add", ADD, add, worker, None)
    caller = rmw.caller("/rmw/add", ADD, None)
    try:
        writer.write("hello")
        wait_until(lambda: heard)
        assert heard[0].data == "hello"
        assert caller.wait(HANG) and caller.call([1, 2], HANG).sum == 3
    finally:
        for item in (reader, writer, answerer, caller, worker, rmw):
            item.close()  # type: ignore[attr-defined]
