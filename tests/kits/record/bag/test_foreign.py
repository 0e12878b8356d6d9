"""Bags of ROS 1 and 2 are played: what readers of YARP get, also of one that is damaged."""

import random
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from kits.record.bag.test_reader import made
from support.recordings import START, fill
from support.wait import HANG

import yarpy
from yarpy import record
from yarpy.errors import DecodeError
from yarpy.kits.record.bag.foreign import ForeignMessage, with_foreign
from yarpy.kits.record.convert import convert
from yarpy.kits.record.mcap.layout import Channel, Other, Schema
from yarpy.kits.record.mcap.writer import McapWriter

pytest.importorskip("rosbags", reason="bags need rosbags: pip install 'yarpy[ros]'")


TRIES = 60


def drive(path: Path, version: int) -> Path:
    """A bag with a picture, a cloud, numbers and joints, a second apart."""
    from rosbags.rosbag1 import Writer as Writer1
    from rosbags.rosbag2 import Writer as Writer2
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS1_NOETIC if version == 1 else Stores.ROS2_HUMBLE)
    types = store.types

    def header() -> Any:
        stamp = types["builtin_interfaces/msg/Time"](sec=12, nanosec=500_000_000)
        extra = {"seq": 7} if version == 1 else {}
        return types["std_msgs/msg/Header"](stamp=stamp, frame_id="eye", **extra)

    def field(name: str, at: int) -> Any:
        made = types["sensor_msgs/msg/PointField"]
        return made(name=name, offset=at, datatype=7, count=1)

    messages = {
        "/eye": types["sensor_msgs/msg/Image"](
            header=header(), height=2, width=3, encoding="mono8", is_bigendian=0, step=3,
            data=np.arange(6, dtype="u1"),
        ),
        "/points": types["sensor_msgs/msg/PointCloud2"](
            header=header(), height=1, width=2, is_bigendian=False, point_step=12, row_step=24,
            fields=[field("x", 0), field("y", 4), field("z", 8)], is_dense=True,
            data=np.arange(6, dtype="<f4").view("u1"),
        ),
        "/numbers": types["std_msgs/msg/Float64MultiArray"](
            layout=types["std_msgs/msg/MultiArrayLayout"](dim=[], data_offset=0),
            data=np.array([1.5, -2.0]),
        ),
        "/joints": types["sensor_msgs/msg/JointState"](
            header=header(), name=["elbow"], position=np.array([0.5]),
            velocity=np.zeros(0), effort=np.zeros(0),
        ),
    }  # fmt: skip
    spell: Any = store.serialize_ros1 if version == 1 else store.serialize_cdr
    writer: Any = Writer1(path) if version == 1 else Writer2(path, version=8)
    with writer:
        for number, (topic, message) in enumerate(messages.items()):
            type_ = message.__msgtype__
            connection = writer.add_connection(topic, type_, typestore=store)
            writer.write(connection, START + number * 10**9, bytes(spell(message, type_)))
    return path


@pytest.mark.parametrize("version", [1, 2])
@pytest.mark.parametrize("through", ["bag", "mcap"])
def test_values(tmp_path: Path, version: int, through: str) -> None:
    path = drive(tmp_path / ("x.bag" if version == 1 else "x"), version)
    if through == "mcap":
        with record.open(path) as found:
            convert(found, tmp_path / "y")
        path = tmp_path / "y.mcap"
    with record.open(path) as bag:
        found = with_foreign(bag)
        assert all(facts.playable for facts in found.ports.values())
        eye, points, numbers, joints = found
        assert found.damages == []
        assert next(iter(found.messages(["/joints"], found.begin + 2))).port == "/joints"
        assert [*found.messages(["/joints"], found.begin, found.begin + 3)] == []
    assert eye.value.array.tolist() == [[0, 1, 2], [3, 4, 5]]
    assert eye.stamp is not None
    assert (eye.stamp.count, eye.stamp.time) == (7 if version == 1 else 0, 12.5)
    assert points.as_(yarpy.PointCloud).array["z"].ravel().tolist() == [2.0, 5.0]
    assert numbers.value.array.tolist() == [1.5, -2.0] and numbers.envelope == ""
    assert joints.value[1] == ["elbow"] and joints.value[2] == [0.5]
    assert isinstance(joints, ForeignMessage) and joints.foreign.name == ["elbow"]
    assert joints.received_ns == START + 3 * 10**9


def test_what_nobody_can_read_is_told_once(tmp_path: Path) -> None:
    made(tmp_path / "x.bag", 1)  # the messages of /odd are a byte too long for their type
    with record.open(tmp_path / "x.bag") as bag:
        found = with_foreign(bag)
        assert [one.value for one in found] == ["0", "1", "3", "4"]
        (said,) = found.damages
    assert "a message of /odd: " in said


def test_what_is_of_no_encoding_that_is_known(tmp_path: Path) -> None:
    with McapWriter(tmp_path / "x.mcap") as writer:
        fill(writer, 2)
        channel = Channel("/pb", "protobuf", Schema("a.B", "protobuf", b"?"), {})
        writer.add_other(Other(channel, 0, START + 1, START + 1, b"?"))
    with record.open(tmp_path / "x.mcap") as file:
        found = with_foreign(file)
        assert [one.port for one in found] == ["/a", "/b"]
        assert "nobody here reads the encoding 'protobuf': known are " in found.damages[0]


def test_what_is_of_yarp_alone_stays_as_it_is(tmp_path: Path) -> None:
    with McapWriter(tmp_path / "x.mcap") as writer:
        fill(writer)
    with record.open(tmp_path / "x.mcap") as found:
        assert with_foreign(found) is found


def test_a_bag_is_played_from_ports(tmp_path: Path) -> None:
    drive(tmp_path / "x.bag", 1)
    with (
        yarpy.NameServer() as server,
        record.open(tmp_path / "x.bag") as bag,
        record.Player(bag, rate=100.0, names=server.client) as player,
        yarpy.BufferedPort("/in", strict=True, names=server.client) as port,
    ):
        yarpy.connect("/eye", "/in", names=server.client)
        assert player.ports["/joints"] == "/joints"
        assert player.play() and player.played == 4
        message = port.read(timeout=HANG)
        assert message.as_(yarpy.Image).height == 2


def packed(path: Path, compression: str) -> Path:
    """A bag of ROS 1 with texts, packed."""
    from rosbags.rosbag1 import Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS1_NOETIC)
    string = store.types["std_msgs/msg/String"]
    writer = Writer(path)
    if compression:
        writer.set_compression(Writer.CompressionFormat[compression])
    with writer:
        one = writer.add_connection("/chat", "std_msgs/msg/String", typestore=store)
        for n in range(20):
            text = store.serialize_ros1(string(data=f"word {n}" * 10), one.msgtype)
            writer.write(one, (n + 1) * 10**9, bytes(text))
    return path


def tried(path: Path) -> str:
    """What is told of a bag when all of it is read."""
    try:
        with record.open(path) as bag:
            found = with_foreign(bag)
            for _ in found:
                pass
            return " ".join(found.damages)
    except DecodeError as error:
        return str(error)


def changed(data: bytes, chance: random.Random) -> bytes:
    """The bytes with something wrong: cut off, a bit the other way round, a length that lies."""
    at = chance.randrange(len(data))
    which = chance.randrange(3)
    if which == 0:
        return data[:at]
    if which == 1:
        return data[:at] + bytes([data[at] ^ 1 << chance.randrange(8)]) + data[at + 1 :]
    lie = struct.pack("<I", chance.choice([0, 1, 0x7FFFFFFF, 0xFFFFFFFF]))
    return data[:at] + lie + data[at + 4 :]


@pytest.mark.parametrize("compression", ["", "BZ2", "LZ4"])
def test_whatever_is_wrong_with_a_bag_of_ros_1(tmp_path: Path, compression: str) -> None:
    whole = packed(tmp_path / "x.bag", compression).read_bytes()
    assert tried(tmp_path / "x.bag") == ""
    chance, said = random.Random(7), []
    for _ in range(TRIES):
        (tmp_path / "y.bag").write_bytes(changed(whole, chance))
        said.append(tried(tmp_path / "y.bag"))
    assert any("byte " in one for one in said)
    assert all("y.bag: byte " in one for one in said if one), said


def test_whatever_is_wrong_with_a_bag_of_ros_2(tmp_path: Path) -> None:
    folder = drive(tmp_path / "x", 2)
    (file,) = [one for one in folder.iterdir() if one.suffix != ".yaml"]
    whole, chance = file.read_bytes(), random.Random(7)
    for _ in range(TRIES):
        file.write_bytes(changed(whole, chance))
        tried(folder)
    file.write_bytes(whole)
    text = (folder / "metadata.yaml").read_bytes()
    for _ in range(TRIES):
        (folder / "metadata.yaml").write_bytes(changed(text, chance))
        tried(folder)


def test_a_bag_that_claims_more_than_it_has(tmp_path: Path) -> None:
    (tmp_path / "x.bag").write_bytes(b"#ROSBAG V2.0\n" + struct.pack("<I", 0xFFFFFFFF))
    assert "x.bag: byte 17: " in tried(tmp_path / "x.bag")
