"""Bags that rosbag reads; what cannot be written."""

import subprocess
import threading
from pathlib import Path

import numpy as np
import pytest
from support.ros import PYTHON
from support.ros_graph import RosGraph
from support.wait import HANG

import yarpy
from yarpy import idl
from yarpy.errors import AddressError, LocalProtocolError, UnknownType
from yarpy.peers.ros.bag.reader import BagReader, Topic
from yarpy.peers.ros.bag.writer import BagWriter
from yarpy.peers.ros.message.message import Time
from yarpy.peers.ros.node.node import Node

THEIRS = """
import sys, rosbag
with rosbag.Bag(sys.argv[1]) as bag:
    for topic, message, time in bag.read_messages():
        print(topic, message._type, message._md5sum, time.to_nsec(), flush=True)
        if topic == "/eye":
            print(message.width, message.height, message.header.seq, message.header.stamp,
                  list(message.data[:3]), flush=True)
        if topic == "/words":
            print(message.data, flush=True)
"""


@pytest.mark.peer("ros", "rosbag")
@pytest.mark.parametrize("compression", ["none", "bz2", "lz4"])
def test_rosbag_reads_it(tmp_path: Path, compression: str) -> None:
    path = tmp_path / "ours.bag"
    pixels = np.arange(12, dtype="u1").reshape(2, 2, 3)
    with BagWriter(path, compression) as bag:  # type: ignore[arg-type]
        bag.write("/words", idl.load("std_msgs/String")("hello"), Time(12, 7))
        bag.write("/eye", yarpy.Image(pixels), 12.5, "sensor_msgs/Image")
        bag.write("/words", {"data": "there"}, 13.0, "std_msgs/String")
    done = subprocess.run(
        [PYTHON, "-c", THEIRS, str(path)], capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 0, done.stderr
    words, image = idl.load("std_msgs/String"), idl.load("sensor_msgs/Image")
    assert done.stdout.splitlines() == [
        f"/words std_msgs/String {words._md5sum} 12000000007",
        "hello",
        f"/eye sensor_msgs/Image {image._md5sum} 12500000000",
        "2 2 0 12500000000 [0, 1, 2]",
        f"/words std_msgs/String {words._md5sum} 13000000000",
        "there",
    ]


def test_threads_record_what_a_node_hears(graph: RosGraph, tmp_path: Path) -> None:
    path = tmp_path / "heard.bag"
    with Node("/speaker") as speaker, Node("/recorder") as node, BagWriter(path) as bag:
        done = threading.Semaphore(0)

        def record(topic: str, message: object) -> None:
            bag.write(topic, message)
            done.release()

        outs = []
        for topic in ("/one", "/two"):
            node.subscriber(topic, None, lambda message, topic=topic: record(topic, message))
            outs.append(speaker.publisher(topic, "std_msgs/Int32"))
        for out in outs:
            assert out.wait_for_outputs(timeout=HANG)
        for number in range(50):
            for out in outs:
                out.write(number)
        for _ in range(100):
            assert done.acquire(timeout=HANG)
    with BagReader(path) as read:
        assert read.topics == {
            "/one": Topic("std_msgs/Int32", 50),
            "/two": Topic("std_msgs/Int32", 50),
        }
        assert [each.message.data for each in read.messages("/two")] == [*range(50)]
        assert all(each.time.secs > 1e9 for each in read)


def test_what_cannot_be_written(tmp_path: Path) -> None:
    path = tmp_path / "new.bag"
    with BagWriter(path) as bag:
        with pytest.raises(TypeError, match="the type of str in ROS has to be said"):
            bag.write("/a", "text")
        with pytest.raises(UnknownType, match="nothing/Known"):
            bag.write("/a", "text", type_="nothing/Known")
        with pytest.raises(ValueError, match="std_msgs/String"):
            bag.write("/a", 42, type_="std_msgs/String")
        with pytest.raises(AddressError, match="no names like"):
            bag.write("/a-b", "text", type_="std_msgs/String")
        with pytest.raises(ValueError, match="from 1970 to 2106"):
            bag.write("/a", "text", -1.0, "std_msgs/String")
        bag.write("/a", "text", 0.0, "std_msgs/String")
    with pytest.raises(LocalProtocolError, match="is closed"):
        bag.write("/a", "text", type_="std_msgs/String")
    with pytest.raises(FileExistsError, match="bags are not replaced"):
        BagWriter(path)
    with pytest.raises(FileNotFoundError):
        BagWriter(tmp_path / "missing" / "new.bag")
    with BagReader(path) as read:
        assert [each.message.data for each in read] == ["text"]


def test_an_empty_one(tmp_path: Path) -> None:
    path = tmp_path / "empty.bag"
    BagWriter(path).close()
    with BagReader(path) as bag:
        assert ([*bag], bag.topics) == ([], {})
