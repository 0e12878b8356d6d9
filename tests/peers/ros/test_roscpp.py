"""Programs written with roscpp, the C++ library of ROS: those of rosbag and of topic_tools."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from support.process import Process
from support.ros_graph import RosGraph
from support.wait import HANG, wait_until

import yarpy
from yarpy.peers.ros.bag.reader import BagReader
from yarpy.peers.ros.bag.writer import BagWriter
from yarpy.peers.ros.message.convert.native import to_value
from yarpy.peers.ros.message.library import Library
from yarpy.peers.ros.message.source import Texts
from yarpy.peers.ros.node.node import Node

RECORD, PLAY = Path("/usr/lib/rosbag/record"), Path("/usr/lib/rosbag/play")
RELAY, MUX = Path("/usr/lib/topic_tools/relay"), Path("/usr/lib/topic_tools/mux")
SAVER = Path("/usr/lib/image_view/image_saver")

pytestmark = pytest.mark.peer("roscpp")


def start(graph: RosGraph, program: Path, *words: str) -> Process:
    """A program of roscpp, which ends with its `with` block."""
    return Process([str(program), *words], env=graph.environment, cwd=graph.home)


@pytest.fixture
def node(graph: RosGraph) -> Iterator[Node]:
    with Node("/beside_cpp") as found:
        yield found


def test_a_relay_hears_and_is_heard(graph: RosGraph, node: Node) -> None:
    """It takes any type (`*`), and publishes as what it met."""
    out = node.publisher("/images", "sensor_msgs/Image")
    into = node.subscriber("/relayed", "sensor_msgs/Image")
    pixels = np.arange(4 * 5 * 3, dtype="u1").reshape(4, 5, 3)
    with start(graph, RELAY, "/images", "/relayed"):
        assert out.wait_for_outputs(timeout=HANG)

        def arrived() -> bool:
            out.write(yarpy.Image(pixels), yarpy.Stamp(7, 12.5))
            return into.waiting > 0

        wait_until(arrived, HANG, "the relay publishes")
        message = into.take(HANG)
        assert (to_value(message).array == pixels).all()
        assert message.header.stamp == (12, 500_000_000)
        assert "relay" in into.inputs[0].source
    wait_until(lambda: not (out.outputs or into.inputs), HANG, "its end is noticed")


@pytest.mark.peer("image_view")
@pytest.mark.parametrize("code", ["rgb", "mono"])
def test_image_view_shows_our_pictures(
    graph: RosGraph, node: Node, tmp_path: Path, code: str
) -> None:
    """Its saver takes the same way as its window, and needs no screen."""
    cv2 = pytest.importorskip("cv2")
    shape = (48, 63, 3) if code == "rgb" else (48, 63)  # rows that YARP pads
    pixels = np.arange(np.prod(shape), dtype="u4").reshape(shape).astype("u1")
    camera = node.publisher("/icubSim/cam/left", "sensor_msgs/Image")
    target = tmp_path / "saved.png"
    words = ("image:=/icubSim/cam/left", f"_filename_format:={target}", f"__name:=saver_{code}")
    wanted = pixels[..., ::-1] if code == "rgb" else np.repeat(pixels[..., None], 3, 2)
    with start(graph, SAVER, *words):
        assert camera.wait_for_outputs(timeout=HANG)

        def saved() -> bool:  # each picture is written over the one before, so wait for a whole one
            camera.write(yarpy.Image(pixels))
            if not target.exists():
                return False
            found = cv2.imread(str(target), cv2.IMREAD_COLOR)
            return found is not None and np.array_equal(found, wanted)

        wait_until(saved, HANG, "it is saved")


def test_rosbag_records_us_and_plays_to_us(graph: RosGraph, node: Node, tmp_path: Path) -> None:
    path = tmp_path / "recorded.bag"
    out = node.publisher("/steps", "sensor_msgs/JointState")
    with start(graph, RECORD, "-O", str(path), "-l", "20", "/steps") as recorder:
        assert out.wait_for_outputs(timeout=HANG)
        for number in range(20):
            out.write({"name": ["a"], "position": [float(number)]})
        assert recorder.wait(HANG) == 0
    with BagReader(path) as bag:
        assert [each.message.position[0] for each in bag] == [*range(20)]
    steps = node.subscriber("/played", "sensor_msgs/JointState")
    with start(graph, PLAY, "-d", "1", str(path), "/steps:=/played") as player:
        assert [steps.take(HANG).position[0] for _ in range(20)] == [*range(20)]
        assert player.wait(HANG) == 0


def test_rosbag_plays_what_we_wrote(graph: RosGraph, node: Node, tmp_path: Path) -> None:
    path = tmp_path / "ours.bag"
    with BagWriter(path, "lz4") as bag:
        for number in range(5):
            bag.write("/ours", number, 100.0 + number / 100, "std_msgs/Int32")
    heard = node.subscriber("/ours")
    with start(graph, PLAY, "--delay=0", "--wait-for-subscribers", str(path)):
        assert [heard.take(HANG).data for _ in range(5)] == [*range(5)]


def test_services_of_roscpp(graph: RosGraph, node: Node) -> None:
    texts = {
        "topic_tools/MuxList": "---\nstring[] topics\n",
        "topic_tools/MuxSelect": "string topic\n---\nstring prev_topic\n",
    }

    class Services(Texts):
        def find(self, name: str, kind: str) -> str | None:
            return self.texts.get(name) if kind == "srv" else None

    library = Library([Services(texts, "this test")])
    with start(graph, MUX, "/chosen", "/left", "/right"):
        assert node.wait_for_service("/mux/select", HANG)
        assert node.wait_for_service("/mux/list", HANG)
        listed = node.call("/mux/list", library.service("topic_tools/MuxList"))
        assert listed.topics == ["/left", "/right"]
        select = library.service("topic_tools/MuxSelect")
        assert node.call("/mux/select", select, "/right").prev_topic == "/left"
        assert node.call("/mux/select", select, "/left").prev_topic == "/right"
        left = node.publisher("/left", "std_msgs/String")
        chosen = node.subscriber("/chosen", "std_msgs/String")

        def arrived() -> bool:
            left.write("from the left")
            return bool(chosen.inputs)

        wait_until(arrived, HANG, "the mux publishes")
        left.write("from the left")
        assert chosen.take(HANG).data == "from the left"


def test_the_graph_of_roscpp_sees_us(graph: RosGraph, node: Node) -> None:
    """A latched message, and a header that names its publisher."""
    node.publisher("/map", "std_msgs/String", latch=True).write("the map")
    with start(graph, RELAY, "/map", "/map_again"):
        assert "the map" in graph.tool("rostopic", "echo", "-n", "1", "/map")
        info = graph.tool("rostopic", "info", "/map")
        assert "relay" in info and "* /beside_cpp (http" in info
