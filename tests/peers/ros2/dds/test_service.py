"""Services over DDS, for ports and nodes, with a program of another kind."""

from __future__ import annotations

import threading
from typing import Any

import pytest
from support.dds_program import Peer
from support.wait import HANG, wait_until

import yarpy
from yarpy.errors import DecodeError, LinkClosed, UnknownName
from yarpy.peers import ros2
from yarpy.peers.ros2.dds.pair import topics
from yarpy.peers.ros2.dds.service import DdsCaller
from yarpy.peers.ros2.exchange import Question
from yarpy.peers.ros2.name import Node
from yarpy.peers.ros2.token import SUBSCRIBER

ADD = "example_interfaces/srv/AddTwoInts"


def test_a_node_is_asked(node_peer: Any, own: str) -> None:
    with ros2.Node(own, rmw="dds") as node:
        node.service(f"{own}/add", ADD, lambda request: {"sum": request.a + request.b})
        assert node_peer.do("ask", f"{own}/add", 5, 37) == 42
        assert node_peer.do("ask", f"{own}/add", -1, -2) == -3


def test_a_node_asks(node_peer: Any, own: str) -> None:
    node_peer.do("serve", own)
    with ros2.Node(f"{own}_asker", rmw="dds") as node:
        client = node.client(own, ADD)
        assert client.wait(HANG)
        futures = [client.ask([number, 1]) for number in range(8)]  # fewer than ten, which are kept
        assert [future.result(HANG).sum for future in futures] == [*range(1, 9)]
        assert node.call(own, ADD, {"a": 2, "b": 3}, timeout=HANG).sum == 5
        with pytest.raises((TypeError, ValueError, DecodeError)):
            client.ask(["x", 2])


def test_a_port_is_asked(node_peer: Any, own: str) -> None:
    def add(message: yarpy.Message) -> list[int]:
        asked = message.ros  # type: ignore[attr-defined]
        return [asked.a + asked.b]

    with yarpy.RpcServer(f"{own}/adder", add) as server:
        server.listen_to(f"ros2+dds:/{own}~{ADD}")
        assert node_peer.do("ask", own, 5, 37) == 42
        with yarpy.RpcClient(f"ros2+dds:/{own}", name=f"{own}/asker") as client:
            assert client.ask([1, 2]).ros.sum == 3  # type: ignore[union-attr, attr-defined]


def test_a_port_asks(node_peer: Any, own: str) -> None:
    node_peer.do("serve", own)
    with (
        ros2.Node(f"{own}_looks", rmw="dds") as node,  # once it is found, the port finds it
        yarpy.RpcClient(f"ros2+dds:/{own}~{ADD}", name=f"{own}/asker") as client,
    ):
        assert node.client(own, ADD).wait(HANG)
        assert client.ask([5, 37]).ros.sum == 42  # type: ignore[union-attr, attr-defined]
        assert client.ask([1, 2]).ros.sum == 3  # type: ignore[union-attr, attr-defined]


def test_nobody_serves(here: None, own: str) -> None:
    with ros2.Node(own, rmw="dds") as node, pytest.raises(UnknownName, match="nobody serves"):
        node.call(f"{own}/none", ADD, [1, 2])
    with (
        pytest.raises(UnknownName, match="name its type"),
        yarpy.RpcClient(f"ros2+dds:/{own}/none", name=f"{own}/asker"),
    ):
        pass


def test_another_type_is_named(here: None, own: str) -> None:
    with ros2.Node(own, rmw="dds") as node:
        node.service(f"{own}/x", "std_srvs/srv/Trigger", lambda request: [True, ""])
        with pytest.raises(UnknownName, match="served as std_srvs::srv::dds_::Trigger_Request_"):
            node.call(f"{own}/x", ADD, [1, 2])


def test_requests_that_may_grow_are_named(peer: Peer, own: str) -> None:
    """Those of ROS 2 do not, and the library keeps both apart."""
    with ros2.Node(own, rmw="dds") as node:
        client = node.client(f"{own}/x", ADD)
        peer.do("reader", own, f"{own}/x", "reliable", "volatile", 10, {"type": "Adding"})
        seen = client._part.endpoints
        asked, _ = topics(f"{own}/x")
        wait_until(lambda: any(one.topic_name == asked for one in seen(SUBSCRIBER)))
        with pytest.raises(UnknownName, match="type of the same name, but its fields differ, or"):
            client.call([1, 2], timeout=0)
    peer.do("close", own)


def test_who_goes_during_a_call(here: None, own: str) -> None:
    held: list[Question] = []
    server = ros2.Node(own, rmw="dds")
    server._answer(f"{own}/later", ADD, held.append, server._worker, None)
    caller = DdsCaller(Node("/", f"{own[1:]}_asker"), 0, f"{own}/later", ADD)
    assert caller.wait(HANG)
    first, second = caller.ask([1, 2]), caller.ask([3, 4])
    wait_until(lambda: len(held) == 2)
    held[1].answer([7])
    assert second.result(HANG).sum == 7
    with pytest.raises(yarpy.Timeout, match="did not answer within"):
        caller.call([1, 2], timeout=0.01)
    server.close()
    with pytest.raises(LinkClosed, match="went away"):
        first.result(HANG)
    caller.close()
    caller.close()
    with pytest.raises(UnknownName):
        caller.ask([1, 2]).result(HANG)


def test_a_server_that_comes_later_does_not_know_of_a_question(here: None, own: str) -> None:
    held: list[Question] = []
    servers = [ros2.Node(f"{own}{number}", rmw="dds") for number in range(2)]
    caller = DdsCaller(Node("/", f"{own[1:]}_asker"), 0, f"{own}/again", ADD)

    def serve(server: ros2.Node) -> None:
        server._answer(f"{own}/again", ADD, held.append, server._worker, None)

    serve(servers[0])
    assert caller.wait(HANG)
    asked = caller.ask([1, 2])
    wait_until(lambda: len(held) == 1)
    serve(servers[1])
    wait_until(lambda: len(caller._servers()) == 2)
    both = caller.ask([3, 4])
    wait_until(lambda: len(held) == 3)
    servers[0].close()
    with pytest.raises(LinkClosed, match="went away"):
        asked.result(HANG)
    held[-1 if held[-1].request.a == 3 else -2].answer([7])
    assert not both.done() or both.result(HANG).sum == 7
    servers[1].close()
    caller.close()


def test_slow_questions_are_answered_side_by_side(here: None, own: str) -> None:
    both = threading.Barrier(2)

    def meet(request: Any) -> list[int]:
        both.wait(HANG)  # for the other question
        return [request.a]

    with ros2.Node(own, rmw="dds") as node:
        node.service(f"{own}/x", ADD, meet, threads=2)
        asker = node.client(f"{own}/x", ADD)
        assert asker.wait(HANG)
        asked = [asker.ask([number, 0]) for number in range(2)]
        assert [each.result(HANG).sum for each in asked] == [0, 1]


def test_a_failure_is_logged(here: None, own: str, caplog: pytest.LogCaptureFixture) -> None:
    def fail(request: Any) -> None:
        raise ZeroDivisionError("of the test")

    with ros2.Node(own, rmw="dds") as node:
        node.service(f"{own}/x", ADD, fail)
        asker = node.client(f"{own}/x", ADD)
        assert asker.wait(HANG)
        with pytest.raises(yarpy.Timeout):
            asker.call([1, 2], timeout=0.01)
        told = "over DDS nobody is told why: ZeroDivisionError: of the test"
        wait_until(lambda: told in caplog.text, HANG, told)
