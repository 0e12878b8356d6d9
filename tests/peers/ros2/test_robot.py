"""The simulated robot as zenoh-ros2-sdk sees it, an implementation of ROS 2 by others."""

from __future__ import annotations

from collections.abc import Iterator
from math import radians
from pathlib import Path
from typing import Any

import pytest
from support.port import free_port
from support.process import Process
from support.robot_frames import messages, sees_the_eyes, turned
from support.ros2_peer import peer_command, peer_environment
from support.wait import HANG, wait_until

import yarpy
from yarpy.errors import AddressError, LinkClosed
from yarpy.kits.sim.robot import Parts, Robot, icub_head
from yarpy.peers import ros2
from yarpy.peers.ros2.robot import IMAGE, Ros2Robot, Ros2RobotPublisher

JOINTS = ["neck_pitch", "neck_roll", "neck_yaw", "eyes_tilt", "eyes_version", "eyes_vergence"]


@pytest.fixture
def robot(names: yarpy.LocalNames, monkeypatch: pytest.MonkeyPatch) -> Iterator[Robot]:
    monkeypatch.delenv("RMW_IMPLEMENTATION", raising=False)
    with Robot("/icubSim", icub_head((64, 48)), names=names) as found:
        yield found


def shown(router: int, home: Path, topic: str, type_: str) -> Process:
    """The other implementation, which prints the messages of a topic."""
    kind: Any = ros2.load(type_)
    options = (f"type={type_}", f"hash={kind._md5sum}", f"definition={kind._full_text}")
    return Process(peer_command(router, "show", topic, *options), env=peer_environment(home))


def test_frames_are_where_our_kinematics_has_them(
    router: int, robot: Robot, tmp_path: Path
) -> None:
    angles = turned(robot)
    with Ros2Robot(robot), shown(router, tmp_path, "/tf", "tf2_msgs/msg/TFMessage") as peer:
        sees_the_eyes(peer, "icubSim", angles)


def test_joints_are_in_radians(router: int, robot: Robot, tmp_path: Path) -> None:
    angles = turned(robot)
    topic, type_ = "/icubSim/joint_states", "sensor_msgs/msg/JointState"
    with Ros2Robot(robot), shown(router, tmp_path, topic, type_) as peer:
        wait_until(lambda: messages(peer), 2 * HANG)
        found = messages(peer)[0]
        assert found["name"] == JOINTS
        assert found["position"] == pytest.approx([radians(angle) for angle in angles])
        assert len(found["velocity"]) == 6
        assert found["header"]["stamp"]["sec"] > 1e9


def test_pictures_name_their_frame(router: int, robot: Robot) -> None:
    seen: list[Any] = []
    with Ros2Robot(robot), ros2.Node("/looks") as node:
        node.subscriber("/icubSim/cam/right", IMAGE, seen.append)
        wait_until(lambda: seen, HANG)
    image = seen[0]
    assert (image.width, image.height, image.encoding) == (64, 48, "rgb8")
    assert image.header.frame_id == "icubSim/cam/right"
    assert image.header.stamp.sec > 1e9
    assert len({*bytes(image.data)}) > 10


def test_nothing_is_drawn_while_nobody_subscribes(router: int, robot: Robot) -> None:
    drawn: list[str] = []
    grabber = robot.cameras["cam/left"]
    eye: Any = grabber.device
    draw = eye.image
    eye.image = lambda: (drawn.append("left"), draw())[1]
    with Ros2Robot(robot) as shown, ros2.Node("/looks") as node:
        subscription = node.subscriber("/icubSim/cam/right", IMAGE, lambda image: None)
        port = grabber.viewers[-1]
        wait_until(lambda: robot.cameras["cam/right"].viewers[-1].outputs, HANG)
        assert not port.outputs and not drawn
        subscription.close()
        wait_until(lambda: not robot.cameras["cam/right"].viewers[-1].outputs, HANG)
        node.subscriber("/icubSim/cam/left", IMAGE, lambda image: None)
        wait_until(lambda: drawn, HANG)
        assert shown.node.name == "/icubSim"
    assert grabber.viewers == [grabber.images]


def test_a_camera_whose_place_nobody_knows_names_no_frame(names: yarpy.LocalNames) -> None:
    seen: list[Any] = []
    cameras = {"eye": icub_head((64, 48)).cameras["cam/left"]}
    with (
        Robot("/blind", Parts(cameras=cameras), names=names) as robot,
        Ros2Robot(robot, rmw="zenoh"),
        ros2.Node("/looks") as node,
    ):
        node.subscriber("/blind/eye", IMAGE, seen.append)
        wait_until(lambda: seen, HANG)
        assert seen[0].header.frame_id == ""


def test_a_name_that_ros_2_does_not_allow(names: yarpy.LocalNames) -> None:
    robot = Robot("/two-arms", Parts(), names=names)
    with robot, pytest.raises(AddressError, match="no name of ROS 2"):
        Ros2Robot(robot, rmw="zenoh")


def test_it_is_shown_where_a_router_answers(router: int, monkeypatch: pytest.MonkeyPatch) -> None:
    guest = Ros2RobotPublisher()
    monkeypatch.delenv("RMW_IMPLEMENTATION", raising=False)
    wait_until(lambda: guest.find(False) == "Zenoh", HANG)
    assert "rmw_zenoh_cpp" in guest.advice("/icubSim", "Zenoh")
    monkeypatch.setenv("YARPY_ZENOH", "127.0.0.1:1")
    assert guest.find(False) == ""
    monkeypatch.setenv("YARPY_ZENOH", "router.invalid:7447")
    assert guest.find(False) == ""  # not on this computer


def test_it_is_shown_over_dds_where_that_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("cyclonedds", reason='DDS: pip install "yarpy[dds]"')
    monkeypatch.setenv("RMW_IMPLEMENTATION", "rmw_cyclonedds_cpp")
    assert Ros2RobotPublisher().find(False) == "DDS"
    assert "RMW_IMPLEMENTATION=rmw_cyclonedds_cpp" in Ros2RobotPublisher().advice("/icubSim", "DDS")


def test_without_a_router_it_says_what_to_do(
    names: yarpy.LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("YARPY_ZENOH", f"127.0.0.1:{free_port()}")
    monkeypatch.delenv("RMW_IMPLEMENTATION", raising=False)
    with (
        Robot("/lonely", Parts(), names=names) as robot,
        pytest.raises(LinkClosed, match=r"yarpy router.*set RMW_IMPLEMENTATION"),
    ):
        Ros2Robot(robot)
