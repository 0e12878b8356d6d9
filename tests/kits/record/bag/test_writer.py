"""Bags of YARP's messages, as the library of ROS reads them."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.recordings import START, payload_of

import yarpy
from yarpy.errors import LocalProtocolError
from yarpy.kits.record.bag.writer import BagWriter
from yarpy.kits.record.mcap.layout import Channel, Other, Schema

pytest.importorskip("rosbags", reason="bags need rosbags: pip install 'yarpy[ros]'")

SENT = "7 1700000000.5"


def decoded(path: Path, version: int) -> dict[str, tuple[str, Any]]:
    from rosbags.rosbag1 import Reader as Reader1
    from rosbags.rosbag2 import Reader as Reader2
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS1_NOETIC if version == 1 else Stores.ROS2_HUMBLE)
    read: Any = store.deserialize_ros1 if version == 1 else store.deserialize_cdr
    reader: Any = Reader1(path) if version == 1 else Reader2(path)
    with reader:
        return {
            one.topic: (one.msgtype.rpartition("/")[2], read(data, one.msgtype))
            for one, _, data in reader.messages()
        }


@pytest.mark.parametrize("version", [1, 2])
def test_what_ros_sees(tmp_path: Path, version: int) -> None:
    picture = np.arange(2 * 5 * 3, dtype="u1").reshape(2, 5, 3)
    writer = BagWriter(tmp_path / "x", version)
    writer.add("/cam", SENT, START, payload_of(yarpy.Image(picture)))
    writer.add("/vec", SENT, START + 1, payload_of(yarpy.Vector([1.5, 2])))
    writer.add("/say", SENT, START + 2, payload_of(["hello", 3]))
    writer.add("/say", SENT, START + 3, payload_of([1, 2]))
    writer.close()
    assert writer.path.exists() and writer.size > 0
    found = decoded(writer.path, version)
    name, image = found["/cam"]
    assert (name, image.encoding, image.step, image.header.frame_id) == (
        "Image",
        "rgb8",
        15,
        "/cam",
    )
    assert (image.header.stamp.sec, image.header.stamp.nanosec) == (1_700_000_000, 500_000_000)
    assert image.data.tobytes() == picture.tobytes()
    assert found["/vec"][1].data.tolist() == [1.5, 2]
    assert (found["/say"][0], found["/say"][1].data) == ("String", "hello 3")
    assert found["/say/Float64MultiArray"][1].data.tolist() == [1, 2]


def test_nothing_is_replaced(tmp_path: Path) -> None:
    BagWriter(tmp_path / "x", 1).close()
    with pytest.raises(FileExistsError):
        BagWriter(tmp_path / "x", 1)


def test_what_is_of_the_other_ros(tmp_path: Path) -> None:
    writer = BagWriter(tmp_path / "x", 1)
    channel = Channel("/a", "cdr", Schema("std_msgs/msg/String", "ros2msg", b"string data"), {})
    with pytest.raises(LocalProtocolError, match="cdr"):
        writer.add_other(Other(channel, 0, START, START, b""))
    writer.close()


def test_a_file_of_another_program(tmp_path: Path) -> None:
    """Without what a bag would tell of its publishers."""
    writer = BagWriter(tmp_path / "x", 2)
    channel = Channel("/a", "cdr", Schema("std_msgs/msg/String", "ros2msg", b"string data"), {})
    data = b"\0\1\0\0\x03\0\0\0hi\0"
    writer.add_other(Other(channel, 0, START, START, data))
    odd = channel._replace(topic="/b", metadata={"offered_qos_profiles": "{nonsense"})
    writer.add_other(Other(odd, 0, START, START, data))
    writer.close()
    assert decoded(tmp_path / "x", 2)["/a"][1].data == "hi"
