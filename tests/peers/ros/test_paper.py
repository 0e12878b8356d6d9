"""A session with ROS as it was described for YARP in 2014: the same commands, against ROS itself.

Rules: commands as users type them; ROS_MASTER_URI is known to `yarpy detect` alone. The messages of
turtlesim come from a folder here, since its package may not be installed.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest
from support.peer import brings
from support.ros_graph import RosGraph, ros_graph
from support.wait import HANG, wait_until

from yarpy import LocalNames
from yarpy.kits.sim.robot import Robot, icub_head

POSE = "float32 x\nfloat32 y\nfloat32 theta\n\nfloat32 linear_velocity\nfloat32 angular_velocity\n"
TURTLE = f"""
import rospy, sys
from genpy.dynamic import generate_dynamic
Pose = generate_dynamic("turtlesim/Pose", {POSE!r})["turtlesim/Pose"]
rospy.init_node("turtle", disable_signals=True)
publisher = rospy.Publisher("/msg", Pose, latch=True, queue_size=1)
publisher.publish(Pose(0, 5, 10, 15, 20))
rospy.spin()
"""
LISTENER = """
import rospy, sys
from std_msgs.msg import String
rospy.init_node("listener", disable_signals=True)
rospy.Subscriber("/chatter", String, lambda m: print("I heard: [%s]" % m.data, flush=True))
print("ready", flush=True)
rospy.spin()
"""


@pytest.fixture(scope="module")
@brings("ros", "rosmaster")
def robot(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RosGraph]:
    """A ROS, and the files that `yarpy detect --ros --write` leaves."""
    with ros_graph(tmp_path_factory.mktemp("ros")) as graph:
        assert graph.yarpy("namespace", "/ros").wait() == 0
        detect = graph.yarpy("detect", "--ros", "--write")
        assert detect.wait() == 0
        assert "Reachable.  Writing.\nNew configuration stored to " in detect.stdout
        assert f":{graph.port}/" in detect.stdout
        assert (graph.home / "_ros.conf").read_text() == f"127.0.0.1 {graph.port} ros\n"
        yield graph


def test_reading_a_topic(robot: RosGraph) -> None:
    """Of two types, one after the other, without a type server."""
    with robot.yarpy("read", "/msg@/test_node", ROS_MASTER_URI="") as reader:
        reader.wait_line(r"/msg-@/test_node active at tcp://")
        reader.wait_line(r"Port /test_node active at tcp://")
        wait_until(lambda: "/test_node" in robot.tool("rosnode", "list"), HANG, "listed")
        info = robot.tool("rostopic", "info", "/msg")
        assert "Type: unknown type" in info and "Publishers: None" in info
        assert "* /test_node (http://127.0.0.1:" in info
        with robot.run("rostopic", "pub", "/msg", "std_msgs/String", "hello yarp"):
            reader.wait_line('^"hello yarp"$', stream="out")
            reader.wait_line(
                r"Receiving input from /rostopic_\S+ to /msg-@/test_node using "
                r"tcpros\+role\.pub\+topic\./msg$"
            )
        reader.wait_line(r"Removing input from /rostopic_\S+ to /msg-@/test_node")
        with robot.python(TURTLE):
            reader.wait_line("^0.0 5.0 10.0 15.0 20.0$", stream="out")


def test_writing_text(robot: RosGraph) -> None:
    with (
        robot.python(LISTENER) as listener,
        robot.yarpy("write", "/chatter@/yarp_writer", ROS_MASTER_URI="") as writer,
    ):
        listener.wait_line("ready")
        writer.wait_line(r"Sending output from /chatter\+@/yarp_writer to /listener using tcpros")
        writer.write_line("hello?")
        listener.wait_line(r"I heard: \[hello\?\]")
        writer.write_line("42")
        writer.wait_line("a message is not sent to /listener: std_msgs/String is expected here")
        writer.write_line('"42"')
        listener.wait_line(r"I heard: \[42\]")
        writer.write_line("hello world")
        writer.wait_line("expected 1 elements")
        writer.write_line('"hello world"')
        listener.wait_line(r"I heard: \[hello world\]")


def test_services(robot: RosGraph) -> None:
    server = "/switch@/my_switch"
    with robot.yarpy("rpcserver", server, "--type", "std_srvs/SetBool", ROS_MASTER_URI="") as our:
        our.wait_line("Waiting for a message")
        wait_until(lambda: "/switch" in robot.tool("rosservice", "list"), HANG, "listed")
        with robot.run("rosservice", "call", "/switch", "true") as call:
            our.wait_line("Message: 1")
            our.write_line("0 stuck")
            call.wait_line("message: .stuck.")
        with robot.yarpy("rpc", "/switch", ROS_MASTER_URI="") as rpc:
            rpc.write_line("1")
            our.wait_line("Message: 1", count=2)
            our.write_line('1 "as new"')
            rpc.wait_line("Response: ")
            rpc.write_line("1 2 3")  # is not sent, and the next line is asked
            rpc.wait_line("error: std_srvs/SetBoolRequest is expected .* got 3")
            rpc.write_line("0")
            our.wait_line("Message: 0")
            our.write_line('1 "as old"')
            rpc.wait_line("Response: ", count=2)
            rpc.end_input()
            assert rpc.wait() == 0
        assert "reconnecting" not in rpc.stderr


def test_everything_is_gone_in_the_end(robot: RosGraph) -> None:
    wait_until(
        lambda: (
            not {"/test_node", "/yarp_writer", "/my_switch"}
            & set(robot.tool("rosnode", "list").split())
        ),
        HANG,
        "no node of ours is left",
    )


def test_the_camera_of_the_simulated_robot(
    robot: RosGraph, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its program is untouched: the environment gives the port its name."""
    program = """
import rospy
from sensor_msgs.msg import Image
rospy.init_node("image_view", disable_signals=True)
image = rospy.wait_for_message("/icubSim/cam/left", Image, timeout=30)
print("saw", image.width, image.height, image.encoding, len(set(image.data)) > 10, flush=True)
"""
    monkeypatch.setenv("ROS_MASTER_URI", robot.uri)
    monkeypatch.setenv("ROS_IP", "127.0.0.1")
    monkeypatch.setenv("YARP_RENAME_icubSim_cam_left", "/icubSim/cam/left+@/icubSim")
    with Robot("/icubSim", icub_head((64, 48)), names=LocalNames()):
        info = robot.tool("rostopic", "info", "/icubSim/cam/left")
        assert "Type: sensor_msgs/Image" in info and "* /icubSim (http" in info
        with robot.python(program) as view:
            view.wait_line("saw 64 48 rgb8 True", timeout=2 * HANG)


def test_names_are_listed(robot: RosGraph) -> None:
    with robot.yarpy("read", "/listed@/lister", ROS_MASTER_URI="") as reader:
        reader.wait_line("active at", count=2)
        listed = robot.yarpy("name", "list", ROS_MASTER_URI="")
        assert listed.wait() == 0
        assert 'node "/lister"' in listed.stdout and 'topic "/listed"' in listed.stdout
        found = robot.yarpy("name", "query", "/listed", ROS_MASTER_URI="")
        assert found.wait() == 1
        assert '"/listed" is a topic, not a port' in found.stderr


def test_the_folder_is_as_users_have_it(robot: RosGraph) -> None:
    assert {path.name for path in Path(robot.home).glob("*.conf")} == {
        *("_ros.conf", "yarp_namespace.conf")
    }
    assert os.environ.get("ROS_MASTER_URI") != robot.uri
