"""C++ YARP around our name server beside a ROS master: it is the registrations that are compared;
data flows in tests/nameserver, and over tcpros with C++ programs in test_tcpros.py."""

import os
import signal
import subprocess
import sys
import time

import pytest
from support.cpp import CppYarp
from support.lasted import lasted
from support.port import addresses, free_block
from support.process import Process
from support.ros_graph import RosGraph, ros_graph
from support.wait import HANG, wait_until

import yarpy
from yarpy.link.send.slow_reader import STRANGERS
from yarpy.peers.ros.node.node import Node


@pytest.mark.peer("ros", "rosmaster")
def test_topics_of_cpp_are_known_to_the_master(
    cpp: CppYarp, tmp_path_factory: pytest.TempPathFactory
) -> None:
    """`yarp read` and `yarp write` with topics: C++ leaves the calls to the name server."""
    if cpp.version >= (4, 0):
        pytest.skip("YARP 4 knows no topics of ROS any more")
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


def of_node(graph: RosGraph) -> dict[str, str]:
    """The environment of a program with a node. Where it looks for a name server is none."""
    said = {"ROS_MASTER_URI": graph.uri, "ROS_IP": "127.0.0.1"}
    return {**os.environ, **said, "YARP_PORT_RANGE": str(free_block(200))}


NODE = """
import sys, time, yarpy
from yarpy.peers.ros.node.node import Node

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
        environment = of_node(graph)
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
        environment = of_node(graph)
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


COUNTER = """
import rospy, sys
from std_msgs.msg import String
rospy.init_node(sys.argv[1], disable_signals=True)
rospy.Subscriber("/pictures", String, lambda m: print("heard", m.data.split()[0], flush=True))
rospy.spin()
"""


@pytest.mark.peer("ros", "rosmaster")
def test_who_writes_without_waiting_serves_the_other_subscribers_of_rospy(
    tmp_path_factory: pytest.TempPathFactory,
) -> None:
    """Where no messages wait for subscribers, `timeout=0` drops what one of them does not take."""
    with (
        ros_graph(tmp_path_factory.mktemp("ros")) as graph,
        Node("/eye", master=graph.uri) as eye,
        graph.python(COUNTER, "stopped") as stopped,
        graph.python(COUNTER, "other") as other,
    ):
        pictures = eye.publisher("/pictures", "std_msgs/String", queue_size=0)
        wait_until(lambda: len(pictures.outputs) == 2, HANG, "both have subscribed")
        stopped.signal(signal.SIGSTOP)
        longest = 0.0
        for number in range(60):  # 30 MB: more than any buffer of the system holds
            begun = time.monotonic()
            pictures.write([f"{number} " + "x" * 500_000], timeout=0.0)
            longest = max(longest, lasted(begun))
            other.wait_line(f"heard {number}$")
        assert longest < STRANGERS  # for so long it would wait otherwise
        drops = {link.target: link.stats.drops for link in pictures.outputs}
        assert drops["/other"] == 0 and drops["/stopped"] > 0
        stopped.signal(signal.SIGCONT)
        wait_until(
            lambda: pictures.write(["last"], timeout=0.0) and "heard last\n" in stopped.stdout,
            HANG,
            "it goes on where it was stopped",
        )


@pytest.mark.peer("ros", "rosmaster")
@pytest.mark.parametrize("bind", ["", "local"])
def test_a_topic_of_the_command_line_listens_where_it_says(
    tmp_path_factory: pytest.TempPathFactory, bind: str
) -> None:
    """`yarpy write` with a topic alone: its port and that of its node, for rospy."""
    said, where = ("this computer alone", "127.0.0.1") if bind else ("all networks", "0.0.0.0")
    with (
        ros_graph(tmp_path_factory.mktemp("ros")) as graph,
        graph.python(COUNTER.replace("/pictures", "/chatter"), "hearer") as hearer,
        graph.yarpy("write", "/chatter@/talker~std_msgs/String", YARPY_BIND=bind) as talker,
    ):
        for number in (1, 2):
            talker.wait_line(f"active at tcp://.*, open to {said}$", count=number)
        assert addresses(talker.pid, "tcp") == [where] * 2

        def heard() -> bool:
            talker.write_line("hello")
            return "heard hello\n" in hearer.stdout

        wait_until(heard, HANG, "rospy hears it")


AGAIN = """
import sys, time, yarpy
from yarpy.peers.ros.node.node import Node

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
        environment = of_node(graph)

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
