"""YARP's messages as ROS's: each field."""

import math
from typing import Any

import numpy as np
import pytest
from support.recordings import payload_of

import yarpy
from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.kits.record.bag.spelling import Spelling
from yarpy.kits.record.kind import kind_of

pytest.importorskip("rosbags", reason="bags need rosbags: pip install 'yarpy[ros]'")


@pytest.fixture(params=[1, 2])
def spelling(request: pytest.FixtureRequest) -> Spelling:
    from rosbags.typesys import Stores, get_typestore

    store = Stores.ROS1_NOETIC if request.param == 1 else Stores.ROS2_HUMBLE
    return Spelling(get_typestore(store).types)


def spelled(spelling: Spelling, value: object) -> tuple[str, Any]:
    payload = payload_of(value)
    found = spelling.spelled("/a", kind_of(payload), payload, 1_500_000_000, 3)
    assert found is not None
    return found[0].rpartition("/")[2], found[1]


def test_points(spelling: Spelling) -> None:
    name, found = spelled(spelling, yarpy.PointCloud([[1.0, 2, 3], [4, 5, 6]]))
    assert (name, found.width, found.height, found.point_step) == ("PointCloud2", 2, 1, 16)
    assert [(one.name, one.offset) for one in found.fields] == [("x", 0), ("y", 4), ("z", 8)]
    assert found.data.view("<f4").reshape(2, 4)[:, :3].tolist() == [[1, 2, 3], [4, 5, 6]]


def test_a_laser(spelling: Spelling) -> None:
    name, found = spelled(spelling, [0.0, 180.0, 0.1, 10.0, [1.0, 2.0, 3.0], 0])
    assert name == "LaserScan" and found.ranges.tolist() == [1, 2, 3]
    assert found.angle_increment == pytest.approx(math.pi / 2)
    assert found.header.frame_id == "/a"


def test_joints(spelling: Spelling) -> None:
    parts = [part for _ in range(11) for part in (Bottle([90.0, 180.0]), Vocab("ok"))]
    name, found = spelled(spelling, Bottle(parts))
    assert (name, found.name) == ("JointState", ["joint_0", "joint_1"])
    assert found.position.tolist() == pytest.approx([math.pi / 2, math.pi])
    assert found.effort.tolist() == [90.0, 180.0]


def test_numbers(spelling: Spelling) -> None:
    for value in ([1, 2.5], yarpy.Vector([1, 2.5]), yarpy.Matrix([[1, 2.5]])):
        name, found = spelled(spelling, value)
        assert (name, found.data.tolist()) == ("Float64MultiArray", [1, 2.5])


def test_what_becomes_a_text(spelling: Spelling) -> None:
    odd = yarpy.Image(np.zeros((2, 2, 3), "f4"), "rgb.")
    for value in (["words"], odd, yarpy.Sound(np.zeros(4, "i2"))):
        payload = payload_of(value)
        assert spelling.spelled("/a", kind_of(payload), payload, 0, 0) is None
    assert spelling.text("hi").data == "hi"
