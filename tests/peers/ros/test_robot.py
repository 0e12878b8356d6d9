"""The simulated robot as rospy sees it."""

from collections.abc import Iterator
from math import degrees
from pathlib import Path

import pytest
from support.process import Process
from support.ros_graph import RosGraph
from support.wait import HANG, wait_until

import yarpy
from yarpy import idl
from yarpy.errors import AddressError
from yarpy.kits.sim.axis import Axis
from yarpy.kits.sim.board import Board
from yarpy.kits.sim.body import Body
from yarpy.kits.sim.head import eye_pose
from yarpy.kits.sim.joint import Joint
from yarpy.kits.sim.robot import Parts, Robot, icub_head
from yarpy.peers.ros.node.node import Node
from yarpy.peers.ros.robot import SERVICE, RosRobot, RosRobotPublisher

WATCHER = """
import rospy
from sensor_msgs.msg import Image, JointState
rospy.init_node("watcher", disable_signals=True)
for side in ("left", "right"):
    image = rospy.wait_for_message("/icubSim/cam/" + side, Image, timeout=30)
    print("saw", side, image.width, image.height, image.encoding, len(set(image.data)) > 10,
          image.header.stamp.to_sec() > 1e9, image.header.frame_id, flush=True)
state = rospy.wait_for_message("/icubSim/joint_states", JointState, timeout=30)
print("joints", *state.name, len(state.position), len(state.velocity), len(state.effort),
      state.header.stamp.to_sec() > 1e9, flush=True)
"""
# rospy makes its classes when a package is built; this makes them of the text, as the build does.
MOVER = """
import pathlib, subprocess, sys, tempfile
import rospy
from sensor_msgs.msg import JointState
from genpy.generator import SrvGenerator
root = pathlib.Path(tempfile.mkdtemp())
package = root / "gazebo_msgs"
(package / "srv").mkdir(parents=True)
(package / "srv" / "SetModelConfiguration.srv").write_text(sys.argv[1])
out = package / "classes"
SrvGenerator().generate_messages("gazebo_msgs", [str(package / "srv/SetModelConfiguration.srv")],
                                 str(out), {})
sys.path.insert(0, str(out))
from _SetModelConfiguration import SetModelConfiguration
rospy.init_node("mover", disable_signals=True)
name = "/icubSim/set_model_configuration"
rospy.wait_for_service(name, timeout=30)
move = rospy.ServiceProxy(name, SetModelConfiguration)
print("wrong", move("", "", ["tail"], [1.0]).status_message, flush=True)
print("moving", move("icubSim", "", ["neck_yaw", "neck_pitch"], [0.5, -0.25]).success, flush=True)
while True:
    state = rospy.wait_for_message("/icubSim/joint_states", JointState, timeout=30)
    at = dict(zip(state.name, state.position))
    if abs(at["neck_yaw"] - 0.5) < 0.01 and abs(at["neck_pitch"] + 0.25) < 0.01:
        break
print("there", flush=True)
"""
TEXT = """\
string model_name
string urdf_param_name
string[] joint_names
float64[] joint_positions
---
bool success
string status_message
"""


@pytest.fixture(scope="module")
def graph(graph_apart: RosGraph) -> RosGraph:
    return graph_apart


@pytest.fixture
def robot() -> Iterator[Robot]:
    with Robot("/icubSim", icub_head((64, 48)), names=yarpy.LocalNames()) as found:
        yield found


def test_rospy_sees_pictures_and_joints(graph: RosGraph, robot: Robot) -> None:
    with RosRobot(robot, graph.uri), graph.python(WATCHER) as watcher:
        for side in ("left", "right"):
            watcher.wait_line(
                f"saw {side} 64 48 rgb8 True True icubSim/cam/{side}$", timeout=2 * HANG
            )
        watcher.wait_line(
            "joints neck_pitch neck_roll neck_yaw eyes_tilt eyes_version eyes_vergence 6 6 0 True"
        )
        info = graph.tool("rostopic", "info", "/icubSim/cam/left")
        assert "Type: sensor_msgs/Image" in info and "* /icubSim (http" in info
        assert "/icubSim/set_model_configuration" in graph.tool("rosservice", "list").split()
    assert "/icubSim" not in graph.tool("rosnode", "list").split()
    assert not any(camera.images.closed for camera in robot.cameras.values())


def test_rospy_moves_joints(graph: RosGraph, robot: Robot) -> None:
    with RosRobot(robot, graph.uri), graph.python(MOVER, TEXT) as mover:
        mover.wait_line("wrong there is no joint 'tail', only neck_pitch, ", timeout=2 * HANG)
        mover.wait_line("moving True", timeout=HANG)
        mover.wait_line("^there$", timeout=2 * HANG)
        board = robot.parts.boards["head"]
        assert abs(board.encoders()[2] - degrees(0.5)) < 1


def tf_echo(graph: RosGraph, frame: str) -> Process:
    """ROS's own tool, in C++."""
    return Process(["/usr/lib/tf/tf_echo", "icubSim/root_link", frame], env=graph.environment)


@pytest.mark.peer("tf_echo")
def test_tf_echo_sees_where_its_head_and_its_eyes_are(graph: RosGraph, robot: Robot) -> None:
    board = robot.parts.boards["head"]
    board.position_move([2], [30.0])  # type: ignore[attr-defined]
    wait_until(lambda: abs(board.encoders()[2] - 30.0) < 1e-3, HANG, "it looks to the left")
    with RosRobot(robot, graph.uri):
        with tf_echo(graph, "icubSim/head") as echo:
            echo.wait_line(r"Translation: \[0\.000, -?0\.000, 0\.970\]", timeout=2 * HANG)
            echo.wait_line(r"RPY \(degree\) \[-?0\.000, -?0\.000, 30\.000\]", timeout=HANG)
        with tf_echo(graph, "icubSim/cam/left") as echo:
            x, y, z = eye_pose(board.encoders(), "left").position
            echo.wait_line(rf"Translation: \[{x:.3f}, {y:.3f}, {z:.3f}\]", timeout=2 * HANG)
            # A camera: z ahead, 30 degrees to the left of forward.
            echo.wait_line(r"RPY \(degree\) \[-90\.000, -?0\.000, -60\.000\]", timeout=HANG)


def test_a_broken_address_file_is_no_master(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("YARP_CONFIG_HOME", str(tmp_path))
    for variable in ("YARP_CONF", "YARPY_SERVER", "YARP_NAMESPACE", "ROS_MASTER_URI"):
        monkeypatch.delenv(variable, raising=False)
    (tmp_path / "yarp.conf").write_text("127.0.0.1 nine yarp\n")
    assert RosRobotPublisher().find(False) == ""


def test_the_service_is_that_of_gazebo() -> None:
    kind = idl.load(SERVICE)
    assert kind.Request._md5sum == "160eae60f51fabff255480c70afa289f"


def test_what_cannot_be_done_is_said(graph: RosGraph, robot: Robot) -> None:
    service = "/icubSim/set_model_configuration"
    with RosRobot(robot, graph.uri), Node("/asker", master=graph.uri) as node:
        for arguments, problem in (
            (("gazebo", "", [], []), "there is no model 'gazebo' here, only icubSim"),
            (("", "", ["neck_yaw"], []), "1 names of joints with 0 positions"),
            (("", "", ["neck_yaw"], [float("nan")]), "neck_yaw cannot move to nan"),
        ):
            answer = node.call(service, SERVICE, *arguments)
            assert (answer.success, answer.status_message) == (False, problem)
        board = robot.parts.boards["head"]
        board.switch_control_modes([2], ["vel"])  # type: ignore[attr-defined]
        assert node.call(service, SERVICE, "", "", ["neck_yaw"], [100.0]).success
        wait_until(lambda: abs(board.encoders()[2] - 55.0) < 0.1, HANG, "at its limit")


def test_metres_and_names_that_two_parts_have(graph: RosGraph) -> None:
    slide = Axis("slide", -500.0, 500.0, kind="prismatic")
    parts = Parts({"a": Board(Body([Joint(slide, 100.0)])), "b": Board(Body([Joint(slide)]))})
    with (
        Robot("/lifts", parts, names=yarpy.LocalNames()) as robot,
        RosRobot(robot, graph.uri),
        Node("/reader", master=graph.uri) as node,
    ):
        states = node.subscriber("/lifts/joint_states", "sensor_msgs/JointState", newest=True)
        state = states.take(timeout=HANG)
        assert state.name == ["a/slide", "b/slide"]
        assert [*state.position] == [0.1, 0.0]
        service = "/lifts/set_model_configuration"
        assert node.call(service, SERVICE, "", "", ["b/slide"], [0.25]).success
        wait_until(
            lambda: abs(states.take(timeout=HANG).position[1] - 0.25) < 1e-3,
            HANG,
            "it slides",
        )


def test_another_node_of_that_name_leaves_the_ports_of_yarp_alone(
    graph: RosGraph, robot: Robot
) -> None:
    with RosRobot(robot, graph.uri) as ros:
        graph.tool("rosnode", "kill", "/icubSim")
        wait_until(lambda: not ros.node._node.members, HANG, "it left the graph")
        assert not any(camera.images.closed for camera in robot.cameras.values())


def test_a_camera_that_is_a_topic_by_its_name(
    graph: RosGraph, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("ROS_MASTER_URI", graph.uri)
    monkeypatch.setenv("YARP_RENAME_icubSim_cam_left", "/eye+@/icubSim")
    head = icub_head((64, 48))
    with Robot("/icubSim", head, names=yarpy.LocalNames()) as robot, RosRobot(robot):
        publishers, _, _ = graph.master.state()
        topics = {topic for topic, nodes in publishers if nodes == ["/icubSim"]}
    assert topics == {"/eye", "/icubSim/cam/right", "/icubSim/joint_states", "/tf"}


def test_a_camera_whose_place_nobody_knows_names_no_frame(graph: RosGraph) -> None:
    cameras = {"eye": icub_head((64, 48)).cameras["cam/left"]}
    with (
        Robot("/blind", Parts(cameras=cameras), names=yarpy.LocalNames()) as robot,
        RosRobot(robot, graph.uri),
        Node("/looks", master=graph.uri) as node,
    ):
        seen = node.subscriber("/blind/eye", "sensor_msgs/Image").take(timeout=HANG)
        assert seen.header.frame_id == ""
        assert "/tf" not in {topic for topic, nodes in graph.master.state()[0] if "/blind" in nodes}


def test_a_name_that_ros_does_not_allow(graph: RosGraph) -> None:
    robot = Robot("/two-arms", Parts(), names=yarpy.LocalNames())
    with robot, pytest.raises(AddressError, match="no names like"):
        RosRobot(robot, graph.uri)
