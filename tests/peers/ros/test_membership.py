"""Publishers that do not answer as they should; what works is tested in test_node.py."""

import signal
import socket
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from types import SimpleNamespace
from typing import Any
from xmlrpc.server import SimpleXMLRPCServer

import pytest
from support.port import free_port
from support.ros_graph import RosGraph
from support.wait import HANG, wait_until

import yarpy
from yarpy.errors import AddressError
from yarpy.names.node_name import NodeName
from yarpy.peers.ros import membership
from yarpy.peers.ros.membership import OF_HOST, PUBLISHERS, Membership
from yarpy.peers.ros.node.node import Node


@contextmanager
def publisher(answer: Any) -> Iterator[str]:
    """A node that answers any requestTopic so."""
    with SimpleXMLRPCServer(("127.0.0.1", 0), logRequests=False, allow_none=True) as server:
        server.register_function(lambda *_: answer, "requestTopic")
        thread = threading.Thread(target=server.serve_forever, daemon=True)
        thread.start()
        yield f"http://127.0.0.1:{server.server_address[1]}/"
        server.shutdown()
        thread.join()


@pytest.mark.parametrize(
    ("answer", "problem"),
    [
        ([1, "", ["TCPROS", "127.0.0.1", 0]], "offers no TCPROS connection"),
        ([1, "", ["UDPROS", "127.0.0.1", 1]], "offers no TCPROS connection"),
        ([1, "", 7], "offers no TCPROS connection"),
        ([0, "unknown topic", 0], "refuses requestTopic: unknown topic"),
        ("hello", "is no part of ROS"),
    ],
)
def test_a_publisher_that_lies_costs_a_warning(
    graph: RosGraph, caplog: pytest.LogCaptureFixture, answer: object, problem: str
) -> None:
    with Node("/patient") as node, publisher(answer) as uri:
        words = node.subscriber("/lies", "std_msgs/String")
        graph.master.call("registerPublisher", "/liar", "/lies", "std_msgs/String", uri)
        wait_until(lambda: problem in caplog.text, HANG, problem)
        graph.master.call("unregisterPublisher", "/liar", "/lies", uri)
        truth = node.publisher("/lies", "std_msgs/String")
        assert truth.wait_for_outputs(timeout=HANG)
        truth.write("the truth")
        assert words.take(timeout=HANG).data == "the truth"


def test_a_publisher_that_is_gone_is_tried_again(graph: RosGraph) -> None:
    port = free_port()
    uri = f"http://127.0.0.1:{port}/"
    with Node("/waiting") as node:
        words = node.subscriber("/later", "std_msgs/String")
        graph.master.call("registerPublisher", "/gone", "/later", "std_msgs/String", uri)
        with yarpy.ros.Node("/coming") as other:
            coming = other.publisher("/elsewhere", "std_msgs/String")
            with SimpleXMLRPCServer(("127.0.0.1", port), logRequests=False) as server:
                where = [1, "", ["TCPROS", "127.0.0.1", coming.contact.port]]
                server.register_function(lambda *_: where, "requestTopic")
                thread = threading.Thread(target=server.serve_forever, daemon=True)
                thread.start()
                # It refuses: another topic is published there. What matters is that we came.
                wait_until(lambda: words.inputs or thread.is_alive(), HANG, "dialled")
                server.shutdown()
                thread.join()
        graph.master.call("unregisterPublisher", "/gone", "/later", uri)


def test_a_goodbye_is_no_trouble(
    graph: RosGraph, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Programs of rospy hang up first, and tell the master a moment later."""
    soon = 1
    monkeypatch.setattr(membership, "SOON", soon)
    with Node("/host") as node:
        words = node.subscriber("/visit", "std_msgs/String")
        for _ in range(2):
            with graph.run("rostopic", "pub", "/visit", "std_msgs/String", "hello") as guest:
                assert words.take(timeout=HANG).data == "hello"
                time.sleep(1.2 * soon)  # a connection that is new is not dialled again at once
                guest.signal(signal.SIGTERM)
                wait_until(lambda: not words.inputs, HANG, "it hung up")
                guest.wait()
    assert "no connection to the publisher" not in caplog.text


def test_a_stranger_who_names_many_publishers_starts_few_threads(
    graph: RosGraph, caplog: pytest.LogCaptureFixture
) -> None:
    silent = [socket.create_server(("127.0.0.1", 0)) for _ in range(32)]
    uris = [f"http://127.0.0.1:{each.getsockname()[1]}/" for each in silent]
    wait_until(lambda: not _dialling())  # of tests before
    with Node("/popular") as node:
        node.subscriber("/many", "std_msgs/String")
        (membership,) = node._node.members
        many = [f"{uri}{count}" for count in range(PUBLISHERS) for uri in uris]
        membership.update(many)
        membership.look()
        wait_until(lambda: _dialling() == OF_HOST)  # the node's thread may be starting some
        membership.update([uri + "others" for uri in uris])  # those before are under way still
        assert _dialling() == OF_HOST
    assert "32000 publishers are named; the first 1000 are dialled" in caplog.text
    for each in silent:
        each.close()


def test_a_stranger_who_names_another_host_has_it_dialled_rarely() -> None:
    """One call used to make 2505 connections to it in six seconds."""
    came = 0
    ended = threading.Event()

    def refuse(server: socket.socket) -> None:
        nonlocal came
        while not ended.is_set():
            try:
                server.accept()[0].close()
            except OSError:
                return
            came += 1

    with socket.create_server(("127.0.0.1", 0)) as server:
        threading.Thread(target=refuse, args=(server,), daemon=True).start()
        member = Membership(NodeName("/popular", "/many", "-"))
        registration = SimpleNamespace(declared=member.declared)
        member.hub = SimpleNamespace(  # type: ignore[assignment]
            name="/popular",
            life=SimpleNamespace(closing=False),
            inputs=SimpleNamespace(links=()),
            registration=registration,
            limit=1000,
        )
        uri = f"http://127.0.0.1:{server.getsockname()[1]}/"
        member.update([f"{uri}{count}" for count in range(PUBLISHERS)])
        until = time.monotonic() + 2.0
        while time.monotonic() < until:
            time.sleep(0.01)  # as the node's thread has it, or more often
            member.look()
        member._closed = True
        ended.set()
        with suppress(OSError):  # where one that listens cannot, closing it is enough
            server.shutdown(socket.SHUT_RDWR)
    assert 1 <= came <= 40
    wait_until(lambda: not _dialling())


def _dialling() -> int:
    return sum(thread.name.startswith("yarpy dial ") for thread in threading.enumerate())


def test_a_client_finds_a_service_that_comes_later(graph: RosGraph) -> None:
    with (
        yarpy.RpcClient(name="/later_service+1@/asker~std_srvs/Trigger") as client,
        Node("/late_server") as node,
    ):
        node.service("/later_service", "std_srvs/Trigger", lambda asked: [True, "here"])
        assert client.wait_for_outputs(timeout=HANG)
        assert client.call([]) == [1, "here"]


def test_names_that_ros_cannot_spell() -> None:
    with pytest.raises(AddressError, match="no names like"):
        Membership(NodeName("/n", "/a-b", "+"))
    member = Membership(NodeName("/n:x", "/a:b", "+"), "yarp/vector")
    assert (member.topic, member.node, member.shown_type) == ("/a__b", "/n__x", "yarp/vector")
