"""Frames, and where they were."""

import itertools
import math
import random
import threading

import pytest
from support import ros
from support.wait import HANG

from yarpy.limit import ROS_FRAMES, ROS_MOMENTS
from yarpy.peers.ros.transform import buffer as module
from yarpy.peers.ros.transform.buffer import Buffer, NoTransform, frame
from yarpy.peers.ros.transform.pose import Pose, unit


def at(x: float, y: float = 0.0) -> Pose:
    return Pose((x, y, 0.0))


@pytest.fixture
def buffer() -> Buffer:
    """map > odom > base > camera (fixed); base > arm."""
    found = Buffer()
    for second in range(5):
        found.put("map", "odom", at(10.0), 100.0 + second)
        found.put("odom", "base", at(float(second)), 100.0 + second)
    found.put("base", "camera", Pose((0.0, 0.0, 1.0), (0, 0, 1, 0)), 50.0, fixed=True)
    found.put("base", "arm", at(0.0, 5.0), 102.5)
    found.put("other", "thing", at(1.0), 102.0)
    return found


@pytest.mark.parametrize(
    ("target", "source", "time", "place"),
    [
        ("odom", "base", 102.0, (2.0, 0.0, 0.0)),
        ("base", "odom", 102.0, (-2.0, 0.0, 0.0)),
        ("map", "camera", 103.5, (13.5, 0.0, 1.0)),  # half way between two moments
        ("/map", "/base", 0.0, (14.0, 0.0, 0.0)),  # the latest
        ("camera", "base", 0.0, (0.0, 0.0, -1.0)),  # fixed: always
        ("camera", "base", 7.0, (0.0, 0.0, -1.0)),
        ("map", "arm", 0.0, (12.5, 5.0, 0.0)),  # the latest that all have
        ("arm", "camera", 102.5, (0.0, -5.0, 1.0)),
        ("map", "map", 0.0, (0.0, 0.0, 0.0)),
    ],
)
def test_lookup(
    buffer: Buffer, target: str, source: str, time: float, place: tuple[float, float, float]
) -> None:
    found = buffer.lookup(target, source, time)
    assert found.pose.at == pytest.approx(place)
    assert (found.target, found.source) == (target.strip("/"), source.strip("/"))
    assert buffer.can_transform(target, source, time)


def test_the_latest_time_is_that_of_all(buffer: Buffer) -> None:
    assert buffer.lookup("map", "arm").time == 102.5
    assert buffer.lookup("map", "base").time == 104.0
    assert buffer.lookup("base", "camera").time == 0.0
    assert buffer.lookup("base", "base").time == 104.0  # as in tf2
    assert buffer.lookup("camera", "camera").time == buffer.lookup("map", "map").time == 0.0


@pytest.mark.parametrize(
    ("target", "source", "time", "why"),
    [
        ("map", "nobody", 0.0, 'no frame "nobody"'),
        ("map", "thing", 0.0, "not connected"),
        ("map", "base", 99.0, "99.000 s is before that"),
        ("map", "base", 105.0, "105.000 s is after that"),
        ("map", "arm", 103.0, 'the frame "arm" is known from 102.500 to 102.500 s'),
    ],
)
def test_what_is_not_known(buffer: Buffer, target: str, source: str, time: float, why: str) -> None:
    with pytest.raises(NoTransform, match=why):
        buffer.lookup(target, source, time)
    assert not buffer.can_transform(target, source, time)


def test_what_is_not_known_yet_is_waited_for(buffer: Buffer) -> None:
    timer = threading.Timer(0.05, lambda: buffer.put("map", "late", at(7.0), 104.0))
    timer.start()
    assert buffer.lookup("map", "late", timeout=HANG).pose.at[0] == 7.0
    timer.join()
    with pytest.raises(NoTransform):
        buffer.lookup("map", "never", timeout=0.01)


@pytest.mark.parametrize(
    ("target", "target_time", "source", "source_time", "fixed", "place", "time"),
    [
        ("base", 104.0, "base", 101.0, "map", (-3.0, 0.0, 0.0), 104.0),  # it has gone on since
        ("base", 101.0, "base", 104.0, "map", (3.0, 0.0, 0.0), 101.0),
        ("base", 104.0, "camera", 101.5, "odom", (-2.5, 0.0, 1.0), 104.0),
        ("base", 0.0, "arm", 0.0, "map", (-1.5, 5.0, 0.0), 104.0),  # the latest of each
        ("/odom", 103.0, "/base", 102.0, "/odom", (2.0, 0.0, 0.0), 103.0),
        ("base", 104.0, "base", 101.0, "base", (0.0, 0.0, 0.0), 104.0),
        ("camera", 7.0, "base", 8.0, "camera", (0.0, 0.0, -1.0), 7.0),
    ],
)
def test_two_times(
    buffer: Buffer,
    target: str,
    target_time: float,
    source: str,
    source_time: float,
    fixed: str,
    place: tuple[float, float, float],
    time: float,
) -> None:
    found = buffer.lookup_full(target, target_time, source, source_time, fixed)
    assert found.pose.at == pytest.approx(place)
    assert (found.target, found.source) == (target.strip("/"), source.strip("/"))
    assert found.time == time


def test_each_time_has_to_be_known(buffer: Buffer) -> None:
    for target_time, source_time in ((104.0, 105.0), (105.0, 104.0)):
        with pytest.raises(NoTransform, match=r"105\.000 s is after that"):
            buffer.lookup_full("base", target_time, "base", source_time, "map")
    with pytest.raises(NoTransform, match="not connected"):
        buffer.lookup_full("base", 104.0, "base", 104.0, "other")
    timer = threading.Timer(0.05, lambda: buffer.put("odom", "base", at(9.0), 105.0))
    timer.start()
    found = buffer.lookup_full("base", 105.0, "base", 104.0, "odom", timeout=HANG)
    assert found.pose.at[0] == -5.0
    timer.join()


MOVED = """
import rospy, tf2_py
from geometry_msgs.msg import TransformStamped

buffer = tf2_py.BufferCore(rospy.Duration(100))
for parent, child, at, turned, time, fixed in given["moments"]:
    moved = TransformStamped()
    moved.header.frame_id, moved.child_frame_id = parent, child
    moved.header.stamp = rospy.Time(time)
    place, rotation = moved.transform.translation, moved.transform.rotation
    place.x, place.y, place.z = at
    rotation.x, rotation.y, rotation.z, rotation.w = turned
    if fixed:
        buffer.set_transform_static(moved, "test")
    else:
        buffer.set_transform(moved, "test")
answer = []
for target, target_time, source, source_time, fixed in given["asked"]:
    try:
        found = buffer.lookup_transform_full_core(
            target, rospy.Time(target_time), source, rospy.Time(source_time), fixed
        )
    except tf2_py.TransformException as error:
        answer.append(None)
        continue
    place, rotation = found.transform.translation, found.transform.rotation
    answer.append(
        [
            found.header.frame_id, found.child_frame_id, found.header.stamp.to_sec(),
            [place.x, place.y, place.z],
            [rotation.x, rotation.y, rotation.z, rotation.w],
        ]
    )
"""


@pytest.mark.peer("ros", "tf2")
def test_both_times_as_tf2_has_them() -> None:
    """A robot that drives and turns, with an arm that moves and a fixed camera; all frames, at
    all pairs of some times, over all frames."""
    numbers = random.Random(7)
    moments = [
        (parent, child, [numbers.uniform(-5, 5) for _ in "xyz"], quaternion(numbers), time, fixed)
        for parent, child, times, fixed in (
            ("map", "base", range(100, 110), False),
            ("base", "arm", range(102, 108, 2), False),
            ("base", "camera", [0], True),
            ("map", "dock", [0], True),
        )
        for time in times
    ]
    buffer = Buffer(kept=100)
    for parent, child, (x, y, z), turned, time, fixed in moments:
        buffer.put(parent, child, Pose((x, y, z), turned), time, fixed)
    frames = ("map", "base", "arm", "camera", "dock")
    times = (0.0, 102.0, 105.25, 106.0, 108.5)
    asked = [*itertools.product(frames, times, frames, times, frames)]
    answers = ros.ask(MOVED, {"moments": moments, "asked": asked})
    found = 0
    for question, answer in zip(asked, answers, strict=True):
        if answer is None:
            with pytest.raises(NoTransform):
                buffer.lookup_full(*question)
            continue
        target, source, time, place, turned = answer
        ours = buffer.lookup_full(*question)
        assert (ours.target, ours.source) == (target, source)
        assert ours.time == pytest.approx(time, abs=1e-6), question
        assert ours.pose.at == pytest.approx(tuple(place), abs=1e-6), question
        # a rotation is two quaternions
        alike = sum(a * b for a, b in zip(ours.pose.turned, turned, strict=True))
        assert abs(alike) == pytest.approx(1.0, abs=1e-6), question
        found += 1
    assert len(asked) > found > len(asked) / 3


def quaternion(numbers: random.Random) -> tuple[float, float, float, float]:
    x, y, z, w = unit(tuple(numbers.gauss(0, 1) for _ in "xyzw"))  # type: ignore[arg-type]
    return x, y, z, w


def test_a_frame_with_another_parent(buffer: Buffer) -> None:
    buffer.put("other", "base", at(3.0), 105.0)
    assert buffer.lookup("other", "base").pose.at[0] == 3.0
    assert buffer.lookup("odom", "base", 104.5).pose.at[0] == 4.0  # until then
    assert buffer.frames == ["arm", "base", "camera", "map", "odom", "other", "thing"]


def test_circles_end(buffer: Buffer) -> None:
    buffer.put("base", "map", at(1.0), 104.0)
    with pytest.raises(NoTransform, match="lies in itself"):
        buffer.lookup("map", "thing")


@pytest.mark.parametrize(
    ("parent", "child", "pose", "why"),
    [
        ("a", "/a", at(0.0), "in itself"),
        ("", "b", at(0.0), "no name"),
        ("a", "x" * 2000, at(0.0), "no name"),
        ("a", "b", at(math.nan), "no number"),
        ("a", "b", Pose(turned=(0, 0, 0, 0)), "no rotation"),
    ],
)
def test_what_makes_no_sense(parent: str, child: str, pose: Pose, why: str) -> None:
    with pytest.raises(ValueError, match=why):
        Buffer().put(parent, child, pose, 1.0)


def test_old_moments_go(monkeypatch: pytest.MonkeyPatch) -> None:
    buffer = Buffer(kept=2.0)
    for second in (10.0, 11.0, 12.0, 13.0, 10.5, 13.0):
        buffer.put("a", "b", at(second), second)
    assert len(buffer._moments["b"]) == 3
    assert not buffer.can_transform("a", "b", 10.9)
    buffer.put("a", "b", at(11.5), 11.5)  # late, but not too late
    assert buffer.lookup("a", "b", 11.25).pose.at[0] == pytest.approx(11.25)
    monkeypatch.setattr(module, "ROS_MOMENTS", 3)
    buffer.put("a", "b", at(13.1), 13.1)
    assert len(buffer._moments["b"]) == 3
    buffer.clear()
    assert not buffer.frames


def test_limits(monkeypatch: pytest.MonkeyPatch) -> None:
    assert ROS_FRAMES >= 1000 and ROS_MOMENTS >= 1000
    monkeypatch.setattr(module, "ROS_FRAMES", 2)
    buffer = Buffer()
    for name in "bc":
        buffer.put("a", name, at(1.0), 1.0)
    buffer.put("a", "b", at(1.0), 2.0)
    with pytest.raises(ValueError, match="more than 2 frames"):
        buffer.put("a", "d", at(1.0), 1.0, fixed=True)
    assert frame("/x") == "x"
