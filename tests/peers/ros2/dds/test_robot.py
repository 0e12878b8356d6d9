"""The simulated robot over DDS: as rclpy sees it, and a program with the types of cyclonedds."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from math import radians
from typing import Any

import pytest
from support import dds_frames
from support.process import Process
from support.rclpy_program import Rclpy
from support.robot_frames import sees_the_eyes, turned
from support.wait import HANG, wait_until

import yarpy
from yarpy.kits.sim.robot import Robot, icub_head
from yarpy.peers import ros2
from yarpy.peers.ros2.robot import IMAGE, Ros2Robot

STATE = "sensor_msgs/msg/JointState"


@pytest.fixture
def robot(own: str) -> Iterator[Robot]:
    with Robot(own, icub_head((64, 48)), names=yarpy.LocalNames()) as found:
        yield found


def test_frames_are_where_our_kinematics_has_them(robot: Robot) -> None:
    angles = turned(robot)
    words = [sys.executable, "-P", dds_frames.__file__, "/tf"]
    with Ros2Robot(robot, rmw="dds"), Process(words) as peer:
        sees_the_eyes(peer, robot.name.strip("/"), angles)


def test_rclpy_reads_joints_and_pictures(rclpy: Rclpy, robot: Robot, own: str) -> None:
    """It sends on what it has read."""
    angles = turned(robot)
    states: list[Any] = []
    images: list[Any] = []
    with Ros2Robot(robot, rmw="dds"), ros2.Node(f"{own}_looks", rmw="dds") as node:
        node.subscriber(f"{own}/back", STATE, states.append)
        node.subscriber(f"{own}/image", IMAGE, images.append)
        rclpy.do("echo", STATE, f"{robot.name}/joint_states", f"{own}/back")
        rclpy.do("echo", IMAGE, f"{robot.name}/cam/left", f"{own}/image")
        wait_until(lambda: states and images, HANG)
        assert [*states[-1].position] == pytest.approx([radians(angle) for angle in angles])
        assert states[-1].name[2] == "neck_yaw" and len(states[-1].velocity) == 6
        image = images[-1]
        assert (image.width, image.height, image.encoding) == (64, 48, "rgb8")
        assert image.header.frame_id == f"{robot.name.strip('/')}/cam/left"
        assert "tf2_msgs/msg/TFMessage" in {row[1] for row in rclpy.do("publishers_of", "/tf")}
