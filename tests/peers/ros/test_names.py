"""The ROS master as a name service, alone and behind a YARP server."""

import pytest
from support.ros_graph import RosGraph
from support.wait import HANG

import yarpy
from yarpy.errors import AddressError, LocalProtocolError, UnknownName
from yarpy.names.default import DefaultNames
from yarpy.names.fallback_client import SeveralNames
from yarpy.peers.ros.names import RosNames


@pytest.fixture(scope="module")
def graph(graph_apart: RosGraph) -> RosGraph:
    return graph_apart


def test_ports_find_each_other_by_a_master_alone(graph: RosGraph) -> None:
    names = RosNames(graph.master)
    with (
        yarpy.BufferedPort("/rx:i", names=names, strict=True) as receiver,
        yarpy.Port("/tx:o", names=names) as sender,
    ):
        assert [item.name for item in names.list("/rx:i")] == ["/rx:i"]
        assert "/rx__i" in graph.tool("rosnode", "list")
        sender.connect("/rx:i")
        sender.write([1, "two"])
        assert receiver.read(timeout=HANG).value == [1, "two"]
        assert names.query("/nobody") is None
    assert names.query("/rx:i") is None
    assert "/rx__i" not in graph.tool("rosnode", "list")


def test_nodes_and_services_are_found(graph: RosGraph) -> None:
    program = """
import rospy
from std_srvs.srv import Empty
rospy.init_node("helper", disable_signals=True)
rospy.Service("/rest", Empty, lambda request: ())
print("ready", flush=True)
rospy.spin()
"""
    names = RosNames(graph.master)
    with graph.python(program) as process:
        process.wait_line("ready")
        node, service = names.query("/helper"), names.query("/rest")
        assert node is not None and node.carrier == "xmlrpc" and node.port > 0
        assert service is not None and service.carrier == "rossrv+service./rest"
        master = names.query("/ros")
        assert master is not None and (master.carrier, master.port) == ("xmlrpc", graph.port)
        with yarpy.RpcClient("/ros", names=names) as client:
            client.call("setParam", "/me", "/answer", 42)
            assert client.call("getParam", "/me", "/answer")[2] == 42
        with (
            yarpy.Port("/strange", names=names) as port,
            pytest.raises(UnknownName, match=r'"/rosout" is a topic, not a port.*/rosout@/NODE'),
        ):
            port.connect("/rosout")
        with pytest.raises(LocalProtocolError, match="need a name server of YARP"):
            yarpy.connect("topic://rosout", "/strange", names=names)
        kinds = {item.name: item.carrier for item in names.list()}
        assert (kinds["/helper"], kinds["/rest"], kinds["/rosout"]) == ("xmlrpc", "rossrv", "topic")


def test_numbers_come_from_ports(graph: RosGraph) -> None:
    names = RosNames(graph.master)
    with pytest.raises(AddressError, match="no port numbers"):
        names.register("/x")
    assert names.register("...", port=4321).name == "/tmp/port/4321"
    names.unregister("/tmp/port/4321")
    assert names.set("/x", "k", 1) == names.get("/x", "k") == []
    names.announce("/x")
    names.close()


def test_the_files_of_yarp_lead_to_it(
    graph: RosGraph, tmp_path: object, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("YARPY_SERVER", "YARP_NAMESPACE"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("YARP_CONFIG_HOME", str(tmp_path))
    with open(f"{tmp_path}/yarp_namespace.conf", "w", encoding="utf-8") as file:
        file.write("/root /ros")
    with open(f"{tmp_path}/_ros.conf", "w", encoding="utf-8") as file:
        file.write(f"127.0.0.1 {graph.port} ros\n")
    with open(f"{tmp_path}/yarp.conf", "w", encoding="utf-8") as file:
        file.write("127.0.0.1 10000 yarp\n")
    found = DefaultNames().current()
    assert isinstance(found, SeveralNames)
    second = found.clients[1]
    assert isinstance(second, RosNames)
    assert second.master.uri == graph.uri
