"""C++ YARP around our name server beside a ROS master: it is the registrations that are compared;
data flows in tests/nameserver, and over tcpros with C++ programs in test_tcpros.py."""

import os
import signal
import subprocess
import sys

import pytest
from support.cpp import CppYarp
from support.process import Process
from support.ros_graph import ros_graph
from support.wait import HANG, wait_until

import yarpy
from yarpy.peers.ros.node import Node


@pytest.mark.peer("ros", "rosmaster")
def test_topics_of_cpp_are_known_to_the_master(
    cpp: CppYarp, tmp_path_factory: pytest.TempPathFactory
) -> None:
    """`yarp read` and `yarp write` with topics: C++ leaves the calls to the name server."""
    with (
        ros_graph(tmp_path_factory.mktemp("ros")) as graph,
        yarpy.NameServer(beside={"ros": graph.uri}) as server,
        cpp.at("127.0.0.1", server.port, ROS_MASTER_URI=graph.uri) as peer,
    ):
        with peer.popen("read", "/msg@/cpp_reader"), peer.popen("write", "/chatter@/cpp_writer"):
            for node in ("/cpp_reader", "/cpp_writer"):
                wait_until(lambda node=node: graph.master.node(node), HANG, node)
            publishers, subscribers, _ = graph.master.state()
            assert ["/chatter", ["/cpp_writer"]] in publishers
            assert ["/msg", ["/cpp_reader"]] in subscribers
            where = graph.master.node("/cpp_reader")
            known = server.client.query("/cpp_reader")
            assert where is not None and known is not None and where.port == known.port
        for node in ("/cpp_reader", "/cpp_writer"):
            wait_until(lambda node=node: graph.master.node(node) is None, HANG, node)


NODE = """
import sys, time, yarpy
from yarpy.peers.ros.node import Node

node = Node("/ending")
chatter = node.publisher("/chatter", "std_msgs/String")
heard = node.subscriber("/news", "std_msgs/String")
service = node.service("/empty", "std_srvs/Empty", lambda asked: None)
print("open", flush=True)
time.sleep(60)
"""


@pytest.mark.peer("ros", "rosmaster")
@pytest.mark.parametrize("how", [signal.SIGTERM, signal.SIGINT])
def test_a_node_that_is_told_to_end_leaves_nothing_at_the_master(
    how: signal.Signals, tmp_path_factory: pytest.TempPathFactory
) -> None:
    """As roslaunch and systemd do it; its program closes nothing."""
    with ros_graph(tmp_path_factory.mktemp("ros")) as graph:
        environment = {**os.environ, "ROS_MASTER_URI": graph.uri, "ROS_IP": "127.0.0.1"}
        with subprocess.Popen(
            [sys.executable, "-c", NODE], env=environment, stdout=subprocess.PIPE, text=True
        ) as program:
            assert program.stdout is not None
            assert program.stdout.readline() == "open\n"
            assert "/ending" in str(graph.master.state())
            program.send_signal(how)
            assert program.wait(HANG) == -how
        assert "/ending" not in str(graph.master.state())


@pytest.mark.peer("ros", "rosmaster")
def test_a_stopped_subscriber_holds_up_nobody(tmp_path_factory: pytest.TempPathFactory) -> None:
    stopped = NODE.replace("/ending", "/stopped").replace("/news", "/pictures")
    with ros_graph(tmp_path_factory.mktemp("ros")) as graph:
        environment = {**os.environ, "ROS_MASTER_URI": graph.uri, "ROS_IP": "127.0.0.1"}
        with (
            Node("/eye", master=graph.uri) as eye,
            Node("/other", master=graph.uri) as other,
            subprocess.Popen(
                [sys.executable, "-c", stopped], env=environment, stdout=subprocess.PIPE, text=True
            ) as program,
        ):
            try:
                assert program.stdout is not None
                assert program.stdout.readline() == "open\n"
                pictures = eye.publisher("/pictures", "std_msgs/String", queue_size=3)
                reader = other.subscriber("/pictures", "std_msgs/String")
                wait_until(lambda: len(pictures.outputs) == 2, HANG, "both have subscribed")
                program.send_signal(signal.SIGSTOP)
                for number in range(60):  # 60 MB: more than any buffer of the system holds
                    assert pictures.write([f"{number} " + "x" * 1_000_000]) == 2
                    assert reader.take(HANG).data.startswith(f"{number} ")
                behind = [link.stats.replaced for link in pictures.outputs]
                assert min(behind) == 0 and max(behind) > 0
            finally:
                program.kill()


AGAIN = """
import sys, time, yarpy
from yarpy.peers.ros.node import Node

node = Node("/again")
node.publisher("/map", "std_msgs/String", latch=True).write(sys.argv[1])
node.service("/who", "std_srvs/Trigger", lambda asked: [True, sys.argv[1]])
print("open", flush=True)
time.sleep(60)
"""
ROSPY = """
import rospy, sys
from std_msgs.msg import String
from std_srvs.srv import Trigger
rospy.init_node("keeper", disable_signals=True)
rospy.Subscriber("/map", String, lambda m: print("map", m.data, flush=True))
rospy.wait_for_service("/who")
proxy = rospy.ServiceProxy("/who", Trigger)
for line in sys.stdin:
    try:
        print("answer", proxy().message, flush=True)
    except Exception:  # rospy lets those of its sockets through
        print("no answer", flush=True)
"""


@pytest.mark.peer("ros", "rosmaster")
def test_a_node_that_was_killed_is_found_again_by_rospy(
    tmp_path_factory: pytest.TempPathFactory,
) -> None:
    """Its program takes nothing back at the master, and has its name again."""
    with ros_graph(tmp_path_factory.mktemp("ros")) as graph:
        environment = {**os.environ, "ROS_MASTER_URI": graph.uri, "ROS_IP": "127.0.0.1"}

        def node(word: str) -> Process:
            return Process([sys.executable, "-c", AGAIN, word], env=environment)

        def answers(word: str) -> bool:
            keeper.write_line("?")
            return f"answer {word}\n" in keeper.stdout

        with node("first") as first, graph.python(ROSPY) as keeper:
            first.wait_line("open")
            keeper.wait_line("map first")
            wait_until(lambda: answers("first"), HANG, "the first one answers")
            first.kill()
            with node("second") as second:
                second.wait_line("open")
                keeper.wait_line("map second")
                wait_until(lambda: answers("second"), HANG, "the second one answers")
