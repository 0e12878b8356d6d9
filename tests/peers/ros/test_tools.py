"""The tools of ROS and programs of rospy before a node of ours, as people try them by hand."""

from __future__ import annotations

import signal
from pathlib import Path

import pytest
from support.ros_graph import RosGraph
from support.wait import HANG, wait_until

from yarpy.errors import Timeout
from yarpy.peers.ros.node.node import Node


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("rosservice", "args", "/lamp"), "data"),
        (("rosservice", "find", "std_srvs/SetBool"), "/lamp"),
        (("rosservice", "node", "/lamp"), "/tooled"),
        (("rosservice", "uri", "/lamp"), "rosrpc://127.0.0.1:"),
        (("rostopic", "find", "std_msgs/String"), "/words"),
        (("rosnode", "machine", "127.0.0.1"), "/tooled"),
    ],
    ids=lambda words: "-".join(words[:2]) if isinstance(words, tuple) else "",
)
def test_what_tools_ask(graph: RosGraph, words: tuple[str, ...], said: str) -> None:
    with Node("/tooled") as node:
        node.publisher("/words", "std_msgs/String")
        node.service("/lamp", "std_srvs/SetBool", lambda asked: [True, "on"])
        assert said in graph.tool(*words)


@pytest.mark.peer("rosbag", "roscpp")
def test_rosbag_records_and_plays(graph: RosGraph, tmp_path: Path) -> None:
    file = tmp_path / "words.bag"
    with Node("/told") as node, Node("/hears") as other:
        words = node.publisher("/told_words", "std_msgs/String")
        with graph.run("rosbag", "record", "-O", str(file), "/told_words") as recorder:
            assert words.wait_for_outputs(timeout=HANG)
            for number in range(5):
                words.write(f"grüße {number}")
            words.write("last", wait=True)
            wait_until(lambda: any(tmp_path.glob("words.bag*")), HANG, "it writes")
            recorder.signal(signal.SIGINT)
            recorder.wait()
        words.close()
        heard = other.subscriber("/told_words", "std_msgs/String")
        with graph.run("rosbag", "play", "--delay=0", "--wait-for-subscribers", str(file)):
            assert heard.take(HANG).data == "grüße 0"


SLOW = """
import rospy, sys, threading
from std_srvs.srv import SetBool, SetBoolResponse
rospy.init_node("slow", disable_signals=True)
go = threading.Event()
def switch(request):
    if request.data:
        go.wait()
    return SetBoolResponse(request.data, "late" if request.data else "in time")
rospy.Service("/slow_lamp", SetBool, switch)
print("ready", flush=True)
sys.stdin.readline()
go.set()
rospy.spin()
"""


def test_an_answer_that_is_late_is_not_that_of_the_next_call(graph: RosGraph) -> None:
    with Node("/hasty") as node, graph.python(SLOW) as server:
        server.wait_line("ready")
        with pytest.raises(Timeout):
            node.call("/slow_lamp", "std_srvs/SetBool", True, timeout=0.3)
        assert node.call("/slow_lamp", "std_srvs/SetBool", False, timeout=HANG).message == "in time"
        server.write_line()
        assert node.call("/slow_lamp", "std_srvs/SetBool", False, timeout=HANG).message == "in time"
        assert node.call("/slow_lamp", "std_srvs/SetBool", True, timeout=HANG).message == "late"


def test_a_handler_that_returns_nothing_answers_with_an_empty_response(graph: RosGraph) -> None:
    with Node("/silent") as node:
        node.service("/nothing", "std_srvs/SetBool", lambda asked: None)
        node.service("/empty", "std_srvs/Empty", lambda asked: None)
        assert "success: False" in graph.tool("rosservice", "call", "/nothing", "true")
        assert "ERROR" not in graph.tool("rosservice", "call", "/empty")
