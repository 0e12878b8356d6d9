"""Frames, and where they were."""

import math
import threading

import pytest
from support.wait import HANG

from yarpy.limit import ROS_FRAMES, ROS_MOMENTS
from yarpy.peers.ros.transform import buffer as module
from yarpy.peers.ros.transform.buffer import Buffer, NoTransform, frame
from yarpy.peers.ros.transform.pose import Pose


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
