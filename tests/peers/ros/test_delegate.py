"""A name server beside a ROS master: C++ programs leave the calls to it, ours make them."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from support.listener import listening
from support.port import free_port
from support.ros_graph import RosGraph
from support.wait import HANG, wait_until

import yarpy
from yarpy.peers.ros.delegate import CALLER
from yarpy.peers.ros.node.node import Node


@pytest.fixture(scope="module")
def graph(graph_apart: RosGraph) -> RosGraph:
    return graph_apart


@pytest.fixture
def server(graph: RosGraph) -> Iterator[yarpy.NameServer]:
    with yarpy.NameServer(beside={"ros": graph.uri}) as found:
        yield found


class Foreign:
    """A port as C++ opens it: registered and announced with the name server alone. It notes the
    administrative messages that it gets."""

    def __init__(self, server: yarpy.NameServer, name: str, type_: str = "") -> None:
        self.name, self.told = name, []
        self._client = server.client
        names = yarpy.LocalNames()
        self._port = yarpy.Port(f"/tmp/{free_port()}", names=names)
        self._port._hub.callbacks.node = self._slave
        number = self._port.contact.port
        self._client.register(name, "tcp", "127.0.0.1", number, type_ or None)
        self.number = number

    def _slave(self, words: yarpy.Bottle) -> yarpy.Bottle | None:
        if words and words[0] == "publisherUpdate":
            self.told.append([*words])
            return yarpy.Bottle([1, "ok"])
        return None

    def announce(self) -> None:
        self._client.announce(self.name)

    def close(self) -> None:
        self._client.unregister(self.name)
        self._port.close()


def test_the_master_has_a_name(server: yarpy.NameServer, graph: RosGraph) -> None:
    found = server.client.query("/ros")
    assert found is not None
    assert (found.carrier, found.host, found.port) == ("xmlrpc", "127.0.0.1", graph.port)
    server.client.unregister("/ros")
    wait_until(lambda: server.client.query("/ros"), HANG, "it has its name again")


def test_topics_of_others_are_registered_once_their_node_is_there(
    server: yarpy.NameServer, graph: RosGraph
) -> None:
    topic = Foreign(server, "/msg-@/cpp_node", "std_msgs/String")
    node = Foreign(server, "/cpp_node")
    topic.announce()
    assert server.client.query("/msg-@/cpp_node") is not None
    assert graph.master.node("/cpp_node") is None
    node.announce()
    wait_until(lambda: graph.master.node("/cpp_node"), HANG, "registered")
    found = graph.master.node("/cpp_node")
    assert found is not None and found.port == node.number
    assert "std_msgs/String" in graph.tool("rostopic", "type", "/msg")
    with Node("/teller", master=graph.uri) as teller:
        teller.publisher("/late", "std_msgs/String")
        second = Foreign(server, "/late-@/cpp_node")
        second.announce()
        wait_until(lambda: second.told, HANG, "it is told of the publishers")
        assert second.told[0][:3] == ["publisherUpdate", CALLER, "/late"]
        assert [*second.told[0][3]] == [teller.uri]
        second.close()
    topic.close()
    wait_until(lambda: graph.master.node("/cpp_node") is None, HANG, "unregistered")
    node.close()


def test_publishers_services_and_odd_names(server: yarpy.NameServer, graph: RosGraph) -> None:
    ports = [
        Foreign(server, name)
        for name in ("/odd", "/a:b+@/odd", "/odd=-1/srv", "/x+1@/odd", "/q@/odd")
    ]
    for port in ports:
        port.announce()

    def of_odd() -> list[list[str]]:
        """The topics that it publishes, that it subscribes to, and its services."""
        state = graph.master.state()
        return [[name for name, nodes in kind if "/odd" in nodes] for kind in state]

    wait_until(lambda: of_odd() == [["/a__b"], [], ["/srv"]], HANG, "registered")
    where = graph.master.service("/srv")
    assert where is not None and where.port == ports[2].number
    ports[0].close()  # without its node nobody can ask for its topics
    wait_until(lambda: of_odd() == [[], [], []], HANG, "unregistered")
    assert graph.master.service("/srv") is None
    for port in ports[1:]:
        port.close()


def test_names_that_ros_has_are_found(server: yarpy.NameServer, graph: RosGraph) -> None:
    with Node("/native", master=graph.uri) as node:
        node.service("/native_service", "std_srvs/Trigger", lambda asked: [True, "done"])
        found = server.client.query("/native")
        assert found is not None and found.carrier == "xmlrpc"
        found = server.client.query("/native_service")
        assert found is not None and found.carrier == "rossrv+service./native_service"
        assert server.client.query("/nobody") is None
        with yarpy.RpcClient("/native_service", names=server.client) as client:
            assert client.call([]) == [1, "done"]


def test_our_ports_call_the_master_themselves(server: yarpy.NameServer, graph: RosGraph) -> None:
    """They learn of it by the server."""
    with (
        yarpy.BufferedPort("/ours-@/our_node~std_msgs/String", strict=True) as reader,
        Node("/other", master=graph.uri) as node,
    ):
        where = graph.master.node("/our_node")
        known = server.client.query("/our_node")
        assert where is not None and known is not None and where.port == known.port
        assert server.client.get("/ours-@/our_node", "ros") == ["own"]
        out = node.publisher("/ours", "std_msgs/String")
        assert out.wait_for_outputs(timeout=HANG)
        out.write("hello")
        assert reader.read(timeout=HANG).value == "hello"
        assert len(reader.inputs) == 1
    wait_until(lambda: graph.master.node("/our_node") is None, HANG, "unregistered")


def test_a_restarted_master_is_told_again(
    server: yarpy.NameServer, graph: RosGraph, monkeypatch: pytest.MonkeyPatch
) -> None:
    ports = [Foreign(server, "/stay+@/staying"), Foreign(server, "/staying")]
    for port in ports:
        port.announce()
    wait_until(lambda: graph.master.node("/staying"), HANG, "registered")
    graph.core.kill()
    assert server.client.query("/nobody") is None  # the master is away: that is no error
    graph.start()
    wait_until(lambda: graph.master.node("/staying"), HANG, "registered again")
    for port in ports:
        port.close()


def test_the_end_of_the_server_unregisters(graph: RosGraph) -> None:
    with yarpy.NameServer(beside={"ros": graph.uri}) as server:
        ports = [Foreign(server, "/left+@/leaving"), Foreign(server, "/leaving")]
        for port in ports:
            port.announce()
        wait_until(lambda: graph.master.node("/leaving"), HANG, "registered")
    assert graph.master.node("/leaving") is None
    for port in ports:
        port._port.close()


def test_a_silent_master_is_not_asked_for_every_name() -> None:
    with listening() as (port, asked):
        with yarpy.NameServer(beside={"ros": f"http://127.0.0.1:{port}/"}) as server:
            for number in range(20):
                assert server.client.query(f"/unknown{number}") is None
        assert len(asked) < 10


def test_the_command(graph: RosGraph, tmp_path: Path) -> None:
    port = free_port()
    words = ("server", "--ip", "127.0.0.1", "--socket", str(port), "--ros")
    with graph.yarpy(*words, YARP_CONFIG_HOME=str(tmp_path)) as process:
        process.wait_line(f"Using ROS with ROS_MASTER_URI={graph.uri}")
        process.wait_line("Ok. Ready!")
        reader = graph.yarpy(
            *("read", "/heard@/a_reader"), ROS_MASTER_URI="", YARPY_SERVER=f"127.0.0.1:{port}"
        )
        with reader:
            wait_until(lambda: graph.master.node("/a_reader"), HANG, "registered")
            with graph.run("rostopic", "pub", "/heard", "std_msgs/String", "hello yarp"):
                reader.wait_line('^"hello yarp"$', stream="out", timeout=HANG)
    words = ("server", "--ip", "127.0.0.1", "--socket", str(free_port()), "--ros")
    with graph.yarpy(*words, ROS_MASTER_URI="", YARP_CONFIG_HOME=str(tmp_path / "2")) as process:
        assert process.wait(HANG) == 1
        assert "--ros needs ROS_MASTER_URI" in process.stderr
