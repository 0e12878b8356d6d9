"""Nodes of this process, and masters that come late, restart, or shut us down."""

import logging
import os
import signal
import subprocess
import sys
import time

import pytest
from support.ros_graph import RosGraph
from support.wait import HANG, wait_until

import yarpy
from yarpy.errors import AddressError
from yarpy.peers.ros.graph import GRAPH, SOON
from yarpy.peers.ros.membership import Membership
from yarpy.peers.ros.names import RosNames
from yarpy.peers.ros.node.node import Node

#: how often programs are killed; 10 where there is time
ROUNDS = int(os.environ.get("YARPY_ROS_ROUNDS", "3"))


def registered(graph: RosGraph, node: str) -> bool:
    return graph.master.node(node) is not None


def test_a_node_bundles_the_ports_of_its_name(graph: RosGraph) -> None:
    with (
        yarpy.BufferedPort("/words-@/bundle~std_msgs/String", strict=True) as reader,
        yarpy.Port("/bundle=+/words", port_type="std_msgs/String") as writer,
    ):
        assert (reader.name, writer.name) == ("/words-@/bundle", "/words+@/bundle")
        assert writer.wait_for_outputs(timeout=HANG)
        writer.write("to myself")
        message = reader.read(timeout=HANG)
        assert message.value == "to myself" and message.source == "/bundle"
        publishers, subscribers, _ = graph.master.state()
        assert ["/words", ["/bundle"]] in publishers and ["/words", ["/bundle"]] in subscribers
    assert not registered(graph, "/bundle")


def test_a_restarted_master_is_told_again_and_data_flows(graph: RosGraph) -> None:
    with Node("/left") as left, Node("/right") as right:
        out = left.publisher("/flow", "std_msgs/Int32")
        into = right.subscriber("/flow", "std_msgs/Int32")
        left.service("/served", "std_srvs/Trigger", lambda asked: [True, ""])
        assert out.wait_for_outputs(timeout=HANG)
        for number in range(ROUNDS):
            graph.core.kill()
            out.write(number)
            assert into.take(timeout=HANG).data == number
            graph.start()
            for node in ("/left", "/right"):
                wait_until(lambda node=node: registered(graph, node), HANG, node)
            wait_until(lambda: graph.master.service("/served"), HANG, "the service")
            out.write(-number)
            assert into.take(timeout=HANG).data == -number
            assert len(into.inputs) == 1
        late = right.subscriber("/flow", "std_msgs/Int32")
        wait_until(lambda: late.inputs, HANG, "a late joiner is connected")


def test_a_node_may_come_before_its_master(
    graph: RosGraph, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.INFO, "yarpy.ros")
    graph.core.kill()
    with Node("/unheard") as node:
        node.publisher("/unheard_words", "std_msgs/String")
        node.publisher("/other_words", "std_msgs/String")
    assert len([each for each in caplog.records if each.name == "yarpy.ros"]) == 1, caplog.text
    with Node("/early") as node:
        node.publisher("/early_words", "std_msgs/String")
        names = RosNames(graph.master)  # as `yarpy detect --ros` stores it, and no other
        with yarpy.BufferedPort("/early_words-@/earlier", names=names):
            graph.start()
            for name in ("/early", "/earlier"):
                wait_until(lambda name=name: registered(graph, name), HANG, name)


def test_what_the_master_refuses_is_said_once_and_keeps_nothing_else_out(
    graph: RosGraph, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    caplog.set_level(logging.INFO, "yarpy.ros")
    monkeypatch.setattr(Membership, "shown_type", property(lambda self: self.type))
    with yarpy.Port("/first+@/mixed~a/b/c"), yarpy.Port("/second+@/mixed~std_msgs/String"):
        graph.core.kill()
        graph.start()
        wait_until(lambda: ["/second", ["/mixed"]] in graph.master.state()[0], HANG, "it")
        time.sleep(3 * SOON)
        said = [each for each in caplog.records if "refuses registerPublisher" in each.message]
        assert "is registered with" not in caplog.text
        # As it opens, by the first master when it is asked again, and by the new one.
        assert len(said) <= 3, caplog.text


def test_rosnode_kill_closes_the_ports(graph: RosGraph) -> None:
    with yarpy.BufferedPort("/mortal-@/mortal", strict=True) as port:
        assert "killed" in graph.tool("rosnode", "kill", "/mortal")
        wait_until(lambda: port.closed, HANG, "closed")
        wait_until(lambda: not registered(graph, "/mortal"), HANG, "unregistered")


def test_the_end_of_a_program_unregisters_what_it_left_open(graph: RosGraph) -> None:
    program = (
        "import yarpy; port = yarpy.Port('/open+@/careless~std_msgs/String'); print(port.name)"
    )
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run(
        [sys.executable, "-c", program], env=environment, capture_output=True, text=True, timeout=60
    )
    assert done.stdout == "/open+@/careless\n", done.stderr
    assert not registered(graph, "/careless")


def test_a_peer_that_is_killed_leaves_the_others_alone(graph: RosGraph) -> None:
    """`kill -9` of rospy; its successor is heard."""
    talker = """
import rospy, sys
from std_msgs.msg import String
rospy.init_node("killed", disable_signals=True)
publisher = rospy.Publisher("/cries", String, queue_size=10)
rate = rospy.Rate(50)
while not rospy.is_shutdown():
    publisher.publish(sys.argv[1])
    rate.sleep()
"""
    with Node("/survivor") as node:
        cries = node.subscriber("/cries", "std_msgs/String", newest=True)
        for number in range(ROUNDS):
            process = graph.python(talker, f"cry {number}")
            wait_until(
                lambda number=number: cries.take(HANG).data == f"cry {number}",
                HANG,
                "it is heard",
            )
            process.signal(signal.SIGKILL)
            wait_until(lambda: not cries.inputs, HANG, "its end is noticed")
            process.stop()


def test_two_programs_cannot_be_the_same_node(graph: RosGraph) -> None:
    """The later one wins, as in ROS, and the earlier one leaves."""
    with graph.yarpy("read", "/same@/same") as first:
        first.wait_line("active at", count=2)
        wait_until(lambda: registered(graph, "/same"), HANG, "the first one")
        with graph.yarpy("read", "/same@/same") as second:
            second.wait_line("active at", count=2)
            first.wait_line("is shut down")
            first.wait(timeout=HANG)


def test_one_port_of_a_node_publishes_a_topic(graph: RosGraph) -> None:
    with Node("/single") as node:
        node.publisher("/once", "std_msgs/String")
        with pytest.raises(AddressError, match="publishes /once already"):
            node.publisher("/once", "std_msgs/String")
        node.publisher("/twice", "std_msgs/String")
    assert not registered(graph, "/single")


def test_nodes_end_with_their_last_port(graph: RosGraph) -> None:
    before = len(GRAPH._nodes)
    with Node("/ends"):
        assert len(GRAPH._nodes) == before + 1
    assert len(GRAPH._nodes) == before
    with pytest.raises(AddressError, match="no names like"):
        yarpy.Port("/a-b+@/n")


OURS = """
import sys, time, yarpy
node = yarpy.ros.Node("/mortal_talker")
words = node.publisher("/last_words", "std_msgs/String")
node.service("/mortal_service", "std_srvs/Trigger", lambda asked: [True, sys.argv[1]])
while True:
    words.write(sys.argv[1])
    time.sleep(0.02)
"""
THEIRS = """
import rospy
from std_msgs.msg import String
rospy.init_node("mourner", disable_signals=True)
last = [""]
def hear(message):
    if message.data != last[0]:
        last[0] = message.data
        print("heard", message.data, flush=True)
rospy.Subscriber("/last_words", String, hear)
print("ready", flush=True)
rospy.spin()
"""


def test_our_program_is_killed_and_its_successor_heard(graph: RosGraph) -> None:
    """`kill -9` leaves a registration behind, which the successor takes over."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    with graph.python(THEIRS) as mourner, Node("/heir") as node:
        mourner.wait_line("ready")
        for number in range(ROUNDS):
            with subprocess.Popen(
                [sys.executable, "-c", OURS, f"life {number}"], env=environment
            ) as process:
                try:
                    mourner.wait_line(f"heard life {number}$", timeout=HANG)
                    answer = node.call("/mortal_service", "std_srvs/Trigger")
                    assert answer.message == f"life {number}"
                finally:
                    process.kill()


def test_a_yarp_server_is_told_too(graph: RosGraph, monkeypatch: pytest.MonkeyPatch) -> None:
    # On a busy machine a second, which closing has, may be over before both servers have answered.
    monkeypatch.setenv("YARPY_LINGER", str(HANG))
    ours = ["/known", "/heard+@/known", "/listener", "/heard-@/listener"]
    with yarpy.NameServer():
        with (
            Node("/known") as node,
            yarpy.BufferedPort("/heard-@/listener~std_msgs/String", strict=True) as reader,
        ):
            out = node.publisher("/heard", "std_msgs/String")
            assert all(map(yarpy.query, ours))
            assert out.wait_for_outputs(timeout=HANG)
            out.write("by both")
            assert reader.read(timeout=HANG).value == "by both"
            assert len(reader.inputs) == 1
        assert not any(map(yarpy.query, ours))
    assert not registered(graph, "/known") and not registered(graph, "/listener")


def test_a_node_with_nothing_to_do_sleeps(graph: RosGraph, monkeypatch: pytest.MonkeyPatch) -> None:
    with Node("/calm_talker") as talker, Node("/calm") as node:
        out = talker.publisher("/calm_words", "std_msgs/String")
        into = node.subscriber("/calm_words", "std_msgs/String")
        assert out.wait_for_outputs(timeout=HANG)
        (member,) = node._node.members
        looks: list[bool] = []
        monkeypatch.setattr(member, "look", lambda: looks.append(True))

        def calm() -> bool:
            looks.clear()
            time.sleep(1.5)
            return len(looks) < 3

        wait_until(calm)  # once what that caused is over
        monkeypatch.undo()
        out.close()
        wait_until(lambda: not into.inputs, HANG, "its end is noticed")
        again = talker.publisher("/calm_words", "std_msgs/String")
        assert again.wait_for_outputs(timeout=HANG)
