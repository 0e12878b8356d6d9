"""Calls of the ROS master: against one, and against what is none."""

import doctest
import socket
import threading
from pathlib import Path
from xmlrpc.server import SimpleXMLRPCServer

import pytest
from support.port import free_port
from support.ros_graph import RosGraph

from yarpy.errors import (
    AddressError,
    LinkClosed,
    LocalProtocolError,
    NoNameServer,
    RemoteProtocolError,
)
from yarpy.peers.ros import master as ros_master
from yarpy.peers.ros.master import RosMaster, Uri, advertised_host, parse_uri


@pytest.fixture(scope="module")
def graph(graph_apart: RosGraph) -> RosGraph:
    return graph_apart


def test_what_is_registered_is_found(graph: RosGraph) -> None:
    master = RosMaster(graph.uri)
    assert master.answers()
    uri = "http://127.0.0.1:4321/"
    found = master.call("registerSubscriber", "/me", "/chatter", "std_msgs/String", uri)
    assert found == []
    master.call("registerService", "/me", "/sum", "rosrpc://127.0.0.1:4322", uri)
    assert master.node("/me") == Uri("127.0.0.1", 4321, "/")
    assert master.service("/sum") == Uri("127.0.0.1", 4322, "/")
    _, subscribers, services = master.state()
    assert ["/chatter", ["/me"]] in subscribers
    assert ["/sum", ["/me"]] in services
    assert master.call("unregisterSubscriber", "/me", "/chatter", uri) == 1
    master.call("unregisterService", "/me", "/sum", "rosrpc://127.0.0.1:4322")
    assert master.node("/nobody") is None and master.service("/nobody") is None


def test_parameters_of_every_kind_return(graph: RosGraph) -> None:
    value = {"a": [1, 2.5, True, "[x]", [[1, 2], [3, 4]], []], "dict": {"b": "<&>"}}
    graph.master.call("setParam", "/me", "/p", value)
    assert graph.master.call("getParam", "/me", "/p") == value


def test_a_refusal_says_why(graph: RosGraph) -> None:
    with pytest.raises(LocalProtocolError, match=r"refuses getParam: Parameter \[/no\]"):
        graph.master.call("getParam", "/me", "/no")


def test_nobody_there_is_an_error_that_says_what_to_do() -> None:
    with pytest.raises(NoNameServer, match="roscore"):
        RosMaster(f"http://127.0.0.1:{free_port()}/").state()


def test_a_silent_master_has_its_time() -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        port = listener.getsockname()[1]
        master = RosMaster(f"http://127.0.0.1:{port}", timeout=0.2)
        with pytest.raises(NoNameServer, match=r"did not answer within 0\.2 s"):
            master.call("getPid", "/me")
        assert not master.answers()


@pytest.mark.parametrize(
    "answer", [17, [1, "", 5], [1, ""], [1, "", [[1, 2], [], []]], "no", [1, "", [[], []]]]
)
def test_a_lying_master_is_found_out(answer: object) -> None:
    with SimpleXMLRPCServer(("127.0.0.1", 0), logRequests=False) as server:
        server.register_function(lambda *_: answer, "getSystemState")
        threading.Thread(target=server.handle_request, daemon=True).start()
        master = RosMaster(f"http://127.0.0.1:{server.server_address[1]}/")
        with pytest.raises(RemoteProtocolError, match="is no") as caught:
            master.state()
        assert f"{master.uri} " in str(caught.value) and "unpack" not in str(caught.value)


def test_another_server_is_found_out() -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:

        def answer() -> None:
            sock, _ = listener.accept()
            with sock:
                sock.recv(1000)
                sock.sendall(b"SSH-2.0-OpenSSH\r\n")

        threading.Thread(target=answer, daemon=True).start()
        uri = f"http://127.0.0.1:{listener.getsockname()[1]}/"
        with pytest.raises((RemoteProtocolError, LinkClosed, NoNameServer), match=uri):
            RosMaster(uri).state()


@pytest.mark.parametrize(
    "text", ["", "localhost:11311", "http://:1/", "http://a/", "http://a:70000"]
)
def test_addresses_that_are_none(text: str) -> None:
    with pytest.raises(AddressError, match="no address like http://host:port/"):
        parse_uri(text)


def test_the_advertised_host(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("YARPY_BIND", raising=False)
    assert advertised_host({"ROS_HOSTNAME": "robot", "ROS_IP": "10.0.0.1"}) == "robot"
    assert advertised_host({"ROS_IP": "10.0.0.1"}) == "10.0.0.1"
    assert advertised_host({"YARP_IP": "10.0.0.2"}) == "10.0.0.2"
    assert advertised_host({})
    monkeypatch.setenv("YARPY_BIND", "local")
    assert advertised_host({"ROS_HOSTNAME": "robot", "ROS_IP": "10.0.0.1"}) == "127.0.0.1"
    monkeypatch.setenv("YARPY_BIND", "10.0.0.7")
    assert advertised_host({"ROS_HOSTNAME": "robot"}) == "robot"
    assert advertised_host({}) == "10.0.0.7"


def test_examples() -> None:
    assert doctest.testmod(ros_master).failed == 0


def test_names_are_shown(tmp_path: Path) -> None:
    assert repr(RosMaster("http://a:1")) == "RosMaster('http://a:1/')"
