"""What access.toml says counts for ROS too, and refusals are told in ROS's own way."""

from __future__ import annotations

from pathlib import Path
from xmlrpc.client import ServerProxy

import pytest
from support.access import allow
from support.ros_graph import RosGraph
from support.wait import HANG, wait_until

from yarpy.errors import RemoteProtocolError
from yarpy.peers.ros.master import RosMaster
from yarpy.peers.ros.node.node import Node

CALLER = """
import rospy
from std_srvs.srv import Trigger
rospy.init_node("caller", disable_signals=True)
try:
    print("answer", rospy.ServiceProxy("/guarded_service", Trigger)().message, flush=True)
except rospy.ServiceException as error:
    print("refused", error, flush=True)
"""
LISTENER = """
import logging, sys
import rospy
from std_msgs.msg import String
rospy.init_node("listener", disable_signals=True, log_level=rospy.DEBUG)
for name in ("rospy.internal", "rosout"):
    logging.getLogger(name).addHandler(logging.StreamHandler(sys.stdout))
rospy.Subscriber("/guarded", String, lambda message: print("heard", message.data, flush=True))
rospy.spin()
"""


@pytest.mark.parametrize("may", ["read", "write"])
def test_subscribers_read_and_clients_write(
    graph: RosGraph, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, may: str
) -> None:
    allow(tmp_path, monkeypatch, may)
    with Node("/guarded_node") as node:
        out = node.publisher("/guarded", "std_msgs/String", latch=True)
        out.write("the map")
        node.service("/guarded_service", "std_srvs/Trigger", lambda asked: [True, "served"])
        with graph.python(CALLER) as caller:
            if may == "write":
                caller.wait_line("answer served", timeout=HANG)
            else:
                caller.wait_line("refused .*access.toml", timeout=HANG)
        with graph.python(LISTENER) as listener:
            if may == "read":
                listener.wait_line("heard the map", timeout=HANG)
            else:
                listener.wait_line("access.toml", timeout=HANG)
                assert not out.outputs


def test_tools_may_ask_and_not_shut_down(
    graph: RosGraph, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    allow(tmp_path, monkeypatch, "read")
    with Node("/guarded_node") as node:
        out = node.publisher("/guarded", "std_msgs/String")
        assert "Pid: " in graph.tool("rosnode", "info", "/guarded_node")
        with ServerProxy(node.uri) as proxy:
            for call in (
                lambda: proxy.shutdown("/me", "I say so"),
                lambda: proxy.publisherUpdate("/me", "/x", ["http://127.0.0.1:1/"]),
                lambda: proxy.rpup("/me", "/x", ["http://127.0.0.1:1/"]),
            ):
                code, text, value = call()  # type: ignore[misc]
                assert (code, value) == (-1, 0)
                assert "access.toml" in str(text)
        assert not out.closed


def test_others_than_the_master_may_be_kept_from_telling_of_publishers(
    graph: RosGraph, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    allow(tmp_path, monkeypatch, "read administer")
    with Node("/guarded_node") as node, Node("/late_node") as other:
        into = node.subscriber("/late", "std_msgs/String")
        out = other.publisher("/late", "std_msgs/String")
        assert out.wait_for_outputs(timeout=HANG)  # the master told, and may
        out.write("hello")
        assert into.take(timeout=HANG).data == "hello"


def test_our_client_is_told_by_our_server(
    graph: RosGraph, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    allow(tmp_path, monkeypatch, "read")
    with Node("/guarded_node") as node, Node("/asking") as other:
        node.service("/guarded_service", "std_srvs/Trigger", lambda asked: [True, "served"])
        with pytest.raises(RemoteProtocolError, match=r"the service refuses .*access\.toml"):
            other.call("/guarded_service", "std_srvs/Trigger")
    wait_until(lambda: RosMaster(graph.uri).node("/asking") is None, HANG, "gone")
