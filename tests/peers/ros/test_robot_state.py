"""What a simulated robot tells of itself in ROS, whichever it is."""

from __future__ import annotations

from collections.abc import Callable
from math import radians
from typing import Any

import pytest
from support.wait import HANG, wait_until

import yarpy
from yarpy.kits.sim.head_frames import head_frames
from yarpy.kits.sim.robot import Parts, Robot, icub_head
from yarpy.peers.ros.robot_state import Published, RobotState


class Topics:
    """Publishers, of which some are heard."""

    def __init__(self) -> None:
        self.types: dict[str, str] = {}
        self.heard: set[str] = set()
        self.written: dict[str, list[dict[str, Any]]] = {}

    def publish(self, topic: str, type_: str) -> Published:
        self.types[topic] = type_
        write: Callable[[dict[str, Any]], object] = self.written.setdefault(topic, []).append
        return Published(lambda: topic in self.heard, write)


@pytest.fixture
def topics() -> Topics:
    return Topics()


def test_joints_and_frames(topics: Topics) -> None:
    head = icub_head((32, 32), lambda: 12.25)
    with (
        Robot("/bot", head, names=yarpy.LocalNames()) as robot,
        RobotState(robot, topics.publish, lambda *time: list(time)) as state,
    ):
        assert topics.types == {
            "/bot/joint_states": "sensor_msgs/JointState",
            "/tf": "tf2_msgs/TFMessage",
        }
        topics.heard.add("/bot/joint_states")
        wait_until(lambda: topics.written["/bot/joint_states"], HANG)
        assert not topics.written["/tf"]  # nobody hears it
        topics.heard.add("/tf")
        wait_until(lambda: topics.written["/tf"], HANG)
        angles = head.boards["head"].encoders()
        assert state.frame_of("cam/left") == "bot/cam/left"
        assert state.frame_of("cam/behind") == ""
    joints = topics.written["/bot/joint_states"][0]
    assert joints["header"] == {"stamp": [12, 250_000_000]}
    assert joints["position"] == pytest.approx([radians(angle) for angle in angles])
    assert joints["name"] == [joint.name for joint in state.joints]
    frames = topics.written["/tf"][0]["transforms"]
    for found, wanted in zip(frames, head_frames(angles), strict=True):
        assert found["header"] == {"stamp": [12, 250_000_000], "frame_id": f"bot/{wanted.parent}"}
        assert found["child_frame_id"] == f"bot/{wanted.name}"
        assert [*found["transform"]["translation"].values()] == pytest.approx(wanted.origin)
        assert [*found["transform"]["rotation"].values()] == pytest.approx(wanted.orientation)


def test_a_robot_without_joints_and_frames_publishes_nothing(topics: Topics) -> None:
    with (
        Robot("/bare", Parts(), names=yarpy.LocalNames()) as robot,
        RobotState(robot, topics.publish, lambda *time: list(time)),
    ):
        assert topics.types == {}
