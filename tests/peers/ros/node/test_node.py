"""A node of a Python program among those of rospy, and under the eyes of the tools of ROS."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
from support.process import Process
from support.ros_graph import RosGraph
from support.wait import HANG, wait_until

import yarpy
import yarpy.idl
import yarpy.peers.ros
from yarpy.errors import (
    AddressError,
    LocalProtocolError,
    RemoteProtocolError,
    UnknownName,
    UnknownType,
)
from yarpy.peers.ros.node.node import Node

LISTENER = """
import rospy, sys
from std_msgs.msg import String
rospy.init_node("listener", anonymous=True, disable_signals=True)
rospy.Subscriber(sys.argv[1], String, lambda m: print("heard", m.data, flush=True))
print("ready", flush=True)
rospy.spin()
"""
TALKER = """
import rospy, sys
from std_msgs.msg import String
rospy.init_node("rospy_talker", anonymous=True, disable_signals=True)
publisher = rospy.Publisher(sys.argv[1], String, queue_size=10)
rate = rospy.Rate(20)
n = 0
while not rospy.is_shutdown():
    publisher.publish(f"number {n}")
    n += 1
    rate.sleep()
"""
SERVER = """
import rospy, sys
from std_srvs.srv import SetBool, SetBoolResponse
rospy.init_node("rospy_server", disable_signals=True)
def switch(request):
    if sys.argv[2:]:
        raise ValueError(sys.argv[2])
    return SetBoolResponse(request.data, "on" if request.data else "off")
rospy.Service(sys.argv[1], SetBool, switch)
print("ready", flush=True)
rospy.spin()
"""


def test_rospy_hears_what_we_publish(graph: RosGraph) -> None:
    with Node("/talker") as node, graph.python(LISTENER, "/chatter") as listener:
        chatter = node.publisher("chatter", "std_msgs/String")
        listener.wait_line("ready")
        assert chatter.wait_for_outputs(timeout=HANG)
        assert chatter.outputs[0].target.startswith("/listener")
        assert chatter.write("hello") == 1
        chatter.write({"data": "from a dict"})
        chatter.write(yarpy.idl.load("std_msgs/String")(data="an object"))
        for words in ("hello", "from a dict", "an object"):
            listener.wait_line(f"heard {words}$")
        with pytest.raises(ValueError, match="std_msgs/String"):
            chatter.write([1, 2])
        with pytest.raises(TypeError, match="takes std_msgs/String, not std_msgs/Bool"):
            chatter.write(yarpy.idl.load("std_msgs/Bool")(True))


def test_we_hear_what_rospy_publishes_also_later(graph: RosGraph) -> None:
    with Node("/hearer") as node:
        said = node.subscriber("/news")
        heard: list[str] = []
        node.subscriber("/news", "std_msgs/String", lambda message: heard.append(message.data))
        with graph.python(TALKER, "/news"):
            first = said.take(timeout=HANG)
            assert first.data.startswith("number ")
            wait_until(lambda: len(heard) > 2, HANG, "the callback is called")
            assert said.inputs[0].carrier == "tcpros+role.pub+topic./news"
        wait_until(lambda: not said.inputs, HANG, "the publisher has gone")


def test_the_tools_of_ros_see_a_native(graph: RosGraph) -> None:
    with Node("/native") as node:
        node.publisher("/numbers", "std_msgs/Float64")
        node.publisher("/words", "std_msgs/String")
        node.subscriber("/words", "std_msgs/String")
        node.service("/switch", "std_srvs/SetBool", lambda asked: [asked.data, ""])
        assert "/native" in graph.tool("rosnode", "list").split()
        info = graph.tool("rosnode", "info", "/native")
        for line in ("* /numbers [std_msgs/Float64]", "* /words [std_msgs/String]", "* /switch"):
            assert line in info
        assert "Pid: " in info
        assert "xmlrpc reply from" in graph.tool("rosnode", "ping", "-c", "1", "/native")
        assert "/numbers" in graph.tool("rostopic", "list").split()
        assert "std_srvs/SetBool" in graph.tool("rosservice", "info", "/switch")
        assert graph.tool("rostopic", "type", "/words").strip() == "std_msgs/String"
    assert "/native" not in graph.tool("rosnode", "list").split()
    assert "/switch" not in graph.tool("rosservice", "list").split()


def test_rates_are_measured_as_of_a_native(graph: RosGraph) -> None:
    with Node("/ticker") as node:
        ticks = node.publisher("/ticks", "std_msgs/String")
        for tool, unit in (("hz", "average rate: "), ("bw", "B/s")):
            with graph.run("rostopic", tool, "/ticks") as measuring:
                assert ticks.wait_for_outputs(timeout=HANG)

                def printed(measuring: Process = measuring, unit: str = unit) -> bool:
                    ticks.write("x" * 100)
                    return any(unit in line for _, line in measuring.lines)

                wait_until(printed, HANG, tool)
            wait_until(lambda: not ticks.outputs, HANG, "it has gone")


def test_rospy_calls_our_service(graph: RosGraph) -> None:
    def switch(asked: object) -> object:
        if asked.data:  # type: ignore[attr-defined]
            raise RuntimeError("too warm")
        return {"success": True, "message": "off"}

    with Node("/server") as node:
        node.service("/switch_it", "std_srvs/SetBool", switch)
        said = graph.tool("rosservice", "call", "/switch_it", "false")
        assert "success: True" in said and 'message: "off"' in said
        assert "too warm" in graph.tool("rosservice", "call", "/switch_it", "true")


def test_we_call_services_of_rospy(graph: RosGraph) -> None:
    with (
        Node("/caller") as node,
        graph.python(SERVER, "/lamp") as server,
    ):
        assert not node.wait_for_service("/nobody", timeout=0)
        assert node.wait_for_service("/lamp", timeout=HANG)
        server.wait_line("ready")
        assert node.call("/lamp", "std_srvs/SetBool", True).message == "on"
        assert node.call("/lamp", "std_srvs/SetBool", {"data": False}).message == "off"
        switch = yarpy.idl.load("std_srvs/SetBool")
        assert node.call("/lamp", switch, switch.Request(True)).success
        with pytest.raises(TypeError, match="is asked with std_srvs/SetBoolRequest"):
            node.call("/lamp", switch, switch.Response())
        with pytest.raises(RemoteProtocolError, match="md5sum"):
            node.call("/lamp", "std_srvs/Trigger")
        with pytest.raises(UnknownName, match='nobody serves "/nobody"'):
            node.call("/nobody", switch, True)


def test_the_failure_of_a_service_is_an_error(graph: RosGraph) -> None:
    with Node("/caller") as node, graph.python(SERVER, "/broken", "no bulb") as server:
        server.wait_line("ready")
        for _ in range(2):  # the connection survives it
            with pytest.raises(RemoteProtocolError, match=r"/broken failed: .*no bulb"):
                node.call("/broken", "std_srvs/SetBool", True)


def test_nodes_call_each_other(graph: RosGraph) -> None:
    with Node("/a") as one, Node("/b") as two:
        one.service("~sum", "std_srvs/Trigger", lambda asked: [True, "done"])
        assert two.call("/a/sum", "std_srvs/Trigger").message == "done"
        shouts = one.subscriber("shouts", "std_msgs/String")
        shout = two.publisher("shouts", "std_msgs/String")
        assert shout.wait_for_outputs(timeout=HANG)
        shout.write("hoy")
        assert shouts.take(timeout=HANG).data == "hoy"
        shout.write("hey")
        assert next(shouts.messages()).data == "hey"


def test_parameters(graph: RosGraph) -> None:
    with Node("/configured") as node:
        assert node.get_param("~gain", 1.5) == 1.5
        with pytest.raises(UnknownName, match="/configured/gain"):
            node.get_param("~gain")
        node.set_param("~gain", {"p": [1.0, 2], "on": True})
        assert node.get_param("~gain/p") == [1.0, 2]
        assert node.has_param("~gain")
        assert graph.tool("rosparam", "get", "/configured/gain/on").strip() == "true"
        node.delete_param("~gain")
        with pytest.raises(UnknownName):
            node.delete_param("~gain")


def test_simulated_time_is_that_of_the_clock(graph: RosGraph) -> None:
    with Node("/before") as before:
        assert before.now() > 1e9
        before.set_param("/use_sim_time", True)
        try:
            clock = before.publisher("/clock", "rosgraph_msgs/Clock", latch=True)
            with Node("/simulated") as node:
                assert node.now() == 0.0
                clock.write({"clock": (12, 500_000_000)})
                wait_until(lambda: node.now() == 12.5, HANG, "the clock is heard")
                images = before.subscriber("/sim_camera", "sensor_msgs/Image")
                camera = node.publisher("/sim_camera", "sensor_msgs/Image")
                assert camera.wait_for_outputs(timeout=HANG)
                camera.write(yarpy.Image(np.zeros((2, 3), "u1")))
                assert images.take(timeout=HANG).header.stamp == (12, 500_000_000)
        finally:
            before.delete_param("/use_sim_time")


def test_names(graph: RosGraph) -> None:
    with Node("robot/arm", master=graph.uri) as node:
        assert node.name == "/robot/arm"
        assert node.resolve("state") == "/robot/state"
        assert node.resolve("~state") == "/robot/arm/state"
        assert node.resolve("/state:o") == "/state__o"
        assert node.uri.startswith("http://127.0.0.1:")
        assert repr(node) == f"<Node /robot/arm at {node.uri}>"
        with pytest.raises(UnknownType, match="nothing/Known"):
            node.publisher("/x", "nothing/Known")
    with pytest.raises(AddressError, match="no names like"):
        Node("/no-name")
    with pytest.raises(LocalProtocolError, match="is closed"):
        node.publisher("/x", "std_msgs/String")
    node.close()


def test_a_picture_arrives_as_it_was(graph: RosGraph) -> None:
    program = """
import rospy, sys
from sensor_msgs.msg import Image
rospy.init_node("watcher", disable_signals=True)
print("ready", flush=True)
image = rospy.wait_for_message("/camera", Image, timeout=20)
starts = [at * image.step for at in range(image.height)]
rows = [image.data[start : start + 3 * image.width] for start in starts]
print("saw", image.width, image.height, image.encoding, image.header.stamp.to_nsec() > 1e18,
      sum(map(sum, rows)), flush=True)
"""
    pixels = np.arange(5 * 7 * 3, dtype="u1").reshape(5, 7, 3)
    with Node("/grabber") as node, graph.python(program) as watcher:
        camera = node.publisher("/camera", "sensor_msgs/Image")
        own = node.subscriber("/camera", "sensor_msgs/Image", newest=True)
        watcher.wait_line("ready")
        wait_until(lambda: len(camera.outputs) == 2, HANG, "both watch")
        camera.write(yarpy.Image(pixels))
        assert watcher.wait_line("saw .*")[0] == f"saw 7 5 rgb8 True {pixels.sum()}"
        message = own.read(timeout=HANG)
        assert (message.as_(yarpy.Image).array == pixels).all()
        stamp = message.stamp
        assert stamp is not None and stamp.time > 1e9


def test_found_without_more_imports() -> None:
    program = "import yarpy; print(yarpy.ros.Node.__name__, yarpy.idl.load.__name__)"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert done.stdout == "Node load\n", done.stderr


def test_a_port_of_yarp_is_a_topic_too(graph: RosGraph) -> None:
    names = yarpy.LocalNames()
    with (
        yarpy.Port("/eye", names=names) as port,
        yarpy.BufferedPort("/viewer", names=names, strict=True) as viewer,
        Node("/watcher") as watcher,
    ):
        port.connect("/viewer")
        pixels = np.arange(12, dtype="u1").reshape(3, 4)
        with Node("/eyes") as node:
            node.attach(port, "~left", "sensor_msgs/Image")
            with pytest.raises(AddressError, match="/eye is a topic or a service of a node"):
                node.attach(port, "~right", "sensor_msgs/Image")
            with (
                yarpy.Port("/other", names=names) as other,
                pytest.raises(AddressError, match="publishes /eyes/left already"),
            ):
                node.attach(other, "~left", "sensor_msgs/Image")
            images = watcher.subscriber("/eyes/left", "sensor_msgs/Image")
            wait_until(lambda: len(port.outputs) == 2, HANG, "the subscriber has come")
            port.write(yarpy.Image(pixels), yarpy.Stamp(3, 12.5))
            image = images.take(timeout=HANG)
            assert (image.encoding, image.header.seq) == ("mono8", 3)
            assert image.header.stamp == (12, 500_000_000)
            assert (viewer.read(timeout=HANG).as_(yarpy.Image).array == pixels).all()
        assert "Publishers: None" in graph.tool("rostopic", "info", "/eyes/left")
        port.write("still a port")
        assert viewer.read(timeout=HANG).value == "still a port"
        with Node("/others") as node:
            node.attach(port, "/again", "std_msgs/String")
            port.close()
            assert "/others" not in graph.tool("rosnode", "list").split()
