"""Bags of ROS's own rosbag, and files that are broken in every way."""

import random
import struct
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from support.peer import brings
from support.ros import PYTHON

from yarpy import idl
from yarpy.errors import DecodeError, UnknownName, UnknownPlugin
from yarpy.peers.ros.bag import reader as bag_reader
from yarpy.peers.ros.bag.reader import BagReader, Recorded, Topic
from yarpy.peers.ros.bag.writer import BagWriter
from yarpy.peers.ros.message.message import Time

THEIRS = """
import sys, rosbag, rospy
from std_msgs.msg import String, Int32
from sensor_msgs.msg import JointState, Image
with rosbag.Bag(sys.argv[1], "w", compression=sys.argv[2], chunk_threshold=200) as bag:
    for n in range(20):
        bag.write("/chatter", String("word %d" % n), rospy.Time(100 + n, 5))
        bag.write("/count", Int32(n), rospy.Time(100 + n, 6))
    bag.write("/joints", JointState(name=["a"], position=[0.5]), rospy.Time(200, 0))
    bag.write("/eye", Image(height=2, width=3, step=3, encoding="mono8", data=bytes(range(6))),
              rospy.Time(201, 0))
"""


@pytest.fixture(scope="module", params=["none", "bz2", "lz4"])
@brings("ros", "rosbag")
def theirs(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A bag that rosbag wrote."""
    path = tmp_path_factory.mktemp("bags") / "theirs.bag"
    done = subprocess.run(
        [PYTHON, "-c", THEIRS, str(path), request.param], capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 0, done.stderr
    return path


@pytest.fixture
def ours(tmp_path: Path) -> Path:
    """A small bag with two topics."""
    path = tmp_path / "ours.bag"
    with BagWriter(path) as bag:
        for number in range(5):
            bag.write("/a", number, float(number), "std_msgs/Int32")
            bag.write("/b", f"text {number}", number + 0.5, "std_msgs/String")
    return path


def test_a_bag_of_rosbag(theirs: Path) -> None:
    with BagReader(theirs) as bag:
        assert bag.topics["/chatter"] == Topic("std_msgs/String", 20)
        assert set(bag.topics) == {"/chatter", "/count", "/joints", "/eye"}
        found = [*bag]
        assert [each.topic for each in found[:4]] == ["/chatter", "/count"] * 2
        topic, message, time = found[2]
        assert (topic, message.data, time) == ("/chatter", "word 1", Time(101, 5))
        joints, eye = found[-2].message, found[-1].message
        assert joints.name == ["a"] and joints.position == np.array([0.5])
        assert isinstance(joints.position, np.ndarray)
        assert bytes(eye.data) == bytes(range(6))
        assert type(joints) is idl.load("sensor_msgs/JointState")
        some = [each.message.data for each in bag.messages("/count", start=Time(105), end=107.0)]
        assert some == [5, 6]
        assert len([*bag.messages("/count", "/joints")]) == 21


def test_a_topic_that_is_not_there(ours: Path) -> None:
    with (
        BagReader(ours) as bag,
        pytest.raises(UnknownName, match=r'has no topic "/c"; it has /a, /b'),
    ):
        next(bag.messages("/c"))


def test_messages_one_by_one(ours: Path) -> None:
    with BagReader(ours) as bag:
        first = next(iter(bag))
        assert isinstance(first, Recorded)
        assert repr(bag) == f"BagReader({str(ours)!r})"
    bag.close()


@pytest.mark.parametrize(
    ("data", "problem"),
    [
        (b"", "seems to be empty"),
        (b"hello\nworld\n", "File magic is invalid"),
        (b"\xff\xfe" * 1000, "cannot be read as a bag"),
        (b"#ROSBAG V1.2\n" + bytes(100), "version 102 is not supported"),
        (b"#ROSBAG V2.0\n", "Header could not be read"),
        (b"#ROSBAG V2.0\n" + struct.pack("<I", 0xFFFFFFFF), "Header could not be read"),
    ],
)
def test_what_is_no_bag(tmp_path: Path, data: bytes, problem: str) -> None:
    path = tmp_path / "no.bag"
    path.write_bytes(data)
    with pytest.raises(DecodeError, match=problem):
        BagReader(path)


def test_files_that_are_not_there(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        BagReader(tmp_path / "missing.bag")
    with pytest.raises((IsADirectoryError, PermissionError)):  # the latter is Windows'
        BagReader(tmp_path)


def test_one_that_was_cut_off_says_what_to_do(ours: Path) -> None:
    data = ours.read_bytes()
    ours.write_bytes(data[:-100])
    with pytest.raises(DecodeError, match="cut off or not closed"):
        BagReader(ours)


def test_one_that_was_not_closed_says_what_to_do(tmp_path: Path) -> None:
    program = (
        "import os, sys; from yarpy.peers.ros import BagWriter; bag = BagWriter(sys.argv[1]);"
        "bag.write('/a', 'x' * 2**21, 1.0, 'std_msgs/String'); os._exit(0)"
    )
    path = tmp_path / "open.bag"
    subprocess.run([sys.executable, "-c", program, str(path)], check=True, timeout=60)
    with pytest.raises(DecodeError, match="cut off or not closed"):
        BagReader(path)


@pytest.mark.parametrize("compression", ["none", "bz2", "lz4"])
def test_any_damage_is_a_decode_error(tmp_path: Path, compression: str) -> None:
    path = tmp_path / "damaged.bag"
    with BagWriter(path, compression) as bag:  # type: ignore[arg-type]
        for number in range(20):
            bag.write("/a", f"text {number}", float(number), "std_msgs/String")
    data = path.read_bytes()
    chance = random.Random(7)
    places = [place for place in range(len(data)) if not 100 < place < 4100]
    for _ in range(300):
        damaged = bytearray(data)
        for _ in range(chance.randint(1, 3)):
            damaged[chance.choice(places)] = chance.randrange(256)
        cut = len(data) if chance.random() < 0.8 else chance.randrange(len(data))
        path.write_bytes(damaged[:cut])
        try:
            with BagReader(path) as bag:
                assert len([*bag]) <= 100
        except (DecodeError, LookupError):  # or nobody has a type of that name
            pass


def test_an_index_that_goes_in_circles_takes_no_memory(ours: Path) -> None:
    """Thousands of entries that lead to one long index."""
    data = ours.read_bytes()
    infos = data.find(b"chunk_count=") + len(b"chunk_count=")
    entry = _chunk_info(data)
    many = 20_000
    path = ours.with_name("circles.bag")
    path.write_bytes(data[:infos] + struct.pack("<I", many) + data[infos + 4 :] + entry * many)
    with pytest.raises(DecodeError, match="leads to the same place over and over"):
        BagReader(path)


def _chunk_info(data: bytes) -> bytes:
    """The last record of a bag, which says where its chunk is."""
    at = data.rindex(b"chunk_pos=")
    for start in range(at, 0, -1):
        (size,) = struct.unpack_from("<I", data, start)
        if start + 4 < at and size < 200 and start + 4 + size <= len(data):
            rest = start + 4 + size
            (length,) = struct.unpack_from("<I", data, rest)
            if rest + 4 + length == len(data):
                return data[start:]
    raise AssertionError("no record")


@pytest.mark.parametrize("compression", ["bz2", "lz4"])
def test_a_bomb_is_not_unpacked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, compression: str
) -> None:
    path = tmp_path / "bomb.bag"
    with BagWriter(path, compression) as bag:  # type: ignore[arg-type]
        bag.write("/a", " " * 500_000, 1.0, "std_msgs/String")
    monkeypatch.setattr(bag_reader, "ROS_BAG_CHUNK", 100_000)
    with BagReader(path) as bag, pytest.raises(DecodeError, match="packed part"):
        next(iter(bag))


def test_without_rosbags(monkeypatch: pytest.MonkeyPatch, ours: Path) -> None:
    monkeypatch.setitem(sys.modules, "rosbags.rosbag1", None)
    with pytest.raises(UnknownPlugin, match=r"pip install 'yarpy\[ros\]'"):
        BagReader(ours)
    with pytest.raises(UnknownPlugin, match=r"pip install 'yarpy\[ros\]'"):
        BagWriter(ours)
