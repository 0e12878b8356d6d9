"""Topics of a node: who gets what is written, in which order, and what it costs."""

from __future__ import annotations

import contextlib
import socket
import threading

import numpy as np
import pytest
from support.ros_graph import RosGraph
from support.steps import measured
from support.wait import HANG, wait_until

import yarpy
import yarpy.idl
import yarpy.peers.ros
from yarpy.link.send import recent
from yarpy.peers.ros.header import encode_header
from yarpy.peers.ros.node.node import Node
from yarpy.peers.ros.node.topic import Publisher


def test_who_subscribes_late_gets_a_latched_message(graph: RosGraph) -> None:
    with Node("/latcher") as node:
        node.publisher("/map", "std_msgs/String", latch=True).write("the map")
        assert "the map" in graph.tool("rostopic", "echo", "-n", "1", "/map")
        late = node.subscriber("/map", "std_msgs/String")
        assert late.take(timeout=HANG).data == "the map"


def test_small_objects_reach_all_and_are_counted(
    graph: RosGraph, caplog: pytest.LogCaptureFixture
) -> None:
    text = yarpy.idl.load("std_msgs/String")
    with Node("/small") as node, yarpy.Port("/small-@/plain~std_msgs/String") as plain:
        out = node.publisher("/small", text)
        assert out.write(text("nobody")) == 0
        one = node.subscriber("/small", text)
        wait_until(lambda: len(out.outputs) == 2, HANG, "both are connected")
        for number in range(100):
            assert out.write(text(f"number {number}")) == 2
        assert [one.take(HANG).data for _ in range(100)] == [
            f"number {number}" for number in range(100)
        ]
        for _ in range(100):
            plain.read(HANG)
        # A thread of the publisher counts a message behind sending it.
        wait_until(lambda: all(link.stats.messages == 100 for link in out.outputs), HANG, "counted")
        assert all(link.stats.drops == 0 for link in out.outputs)
        out.write(text(7))  # type: ignore[arg-type]
        assert "a message is not sent" in caplog.text
        assert out.write(text("x" * 2_000_000)) == 2
        assert len(one.take(HANG).data) == 2_000_000
    with pytest.raises(yarpy.PortClosed):
        out.write(text("late"))


@pytest.mark.parametrize("readers", [1, 2])
@pytest.mark.parametrize("face", ["publisher", "port"])
def test_a_picture_is_published_without_a_copy(
    graph: RosGraph, readers: int, face: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """1080p: the bytes go from the array to the sockets of readers that keep up."""
    monkeypatch.setattr(recent, "GRACE", HANG)  # on a busy machine they are behind sooner
    image = yarpy.Image(np.zeros((1080, 1920, 3), "u1"))
    size = image.array.nbytes
    with contextlib.ExitStack() as opened:
        if face == "publisher":
            node = opened.enter_context(Node("/still"))
            out: yarpy.Port | Publisher = node.publisher("/still_eye", "sensor_msgs/Image")
        else:
            out = opened.enter_context(yarpy.Port("/still_eye+@/still~sensor_msgs/Image"))
        sinks = [opened.enter_context(Sink("/still_eye", out.contact.port)) for _ in range(readers)]
        wait_until(lambda: len(out.outputs) == readers, HANG, "all have come")
        out.write(image)  # whatever is made once
        for sink in sinks:
            wait_until(lambda sink=sink: sink.count > size, HANG, "the first came")
        with measured() as peak:
            for _ in range(3):
                out.write(image)
        assert peak.bytes < size // 10
        for sink in sinks:
            wait_until(lambda sink=sink: sink.count > 4 * size, HANG, "all came")


class Sink:
    """A subscriber that takes what comes into one small buffer, and counts it."""

    def __init__(self, topic: str, port: int) -> None:
        self.count = 0
        self._line = socket.create_connection(("127.0.0.1", port))
        kind = yarpy.idl.load("sensor_msgs/Image")
        fields = {"callerid": "/sink", "topic": topic, "type": kind._type, "md5sum": kind._md5sum}
        self._line.sendall(encode_header(fields))
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self) -> None:
        room = bytearray(1 << 16)
        while taken := self._line.recv_into(room):
            self.count += taken

    def __enter__(self) -> Sink:
        return self

    def __exit__(self, *details: object) -> None:
        self._line.shutdown(socket.SHUT_RDWR)
        self._thread.join()
        self._line.close()


def test_headers_are_counted_and_have_a_time(graph: RosGraph) -> None:
    """As rospy counts; JointState without a time is of no use to robot_state_publisher."""
    kind = yarpy.idl.load("sensor_msgs/JointState")
    with Node("/heads") as node:
        heard = node.subscriber("/joints", kind)
        out = node.publisher("/joints", kind)
        assert out.wait_for_outputs(timeout=HANG)
        before = node.now()
        out.write({"name": ["neck"], "position": [0.5]})
        out.write(kind(name=["neck"]))
        out.write({"header": {"stamp": (12, 5)}})
        out.write({"name": []}, yarpy.Stamp(7, 8.5))
        first, second, third, fourth = (heard.take(timeout=HANG).header for _ in range(4))
        assert [header.seq for header in (first, second, third, fourth)] == [1, 2, 3, 7]
        assert before <= first.stamp.to_sec() <= node.now()
        assert second.stamp == (0, 0)  # its own
        assert (third.stamp, fourth.stamp) == ((12, 5), (8, 500_000_000))
