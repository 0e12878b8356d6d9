"""Targets: what they say, and what is wrong with them."""

import pytest
from support.wait import wait_until

import yarpy
from yarpy.cli.source import Source
from yarpy.errors import AddressError, UnknownName, UnknownType
from yarpy.peers.ros2.zenoh.participant import take_part


def test_what_a_target_says(names: yarpy.LocalNames) -> None:
    target = "ros2+domain.7+node.robot/arm+qos.sensor://pose~std_msgs/msg/String"
    with yarpy.Port("/out") as port:
        port.connect(target)
        part = take_part(7)
        wait_until(lambda: len(part.graph.tokens) == 2)
        (said,) = part.graph.endpoints("/pose", "MP")
        assert (str(said.node), str(said.qos)) == ("/robot/arm", "2::,5:,:,:,,")
        assert port.disconnect(target)
        wait_until(lambda: part.graph.tokens == [])
        part.close()


def test_the_node_is_called_as_the_port(names: yarpy.LocalNames) -> None:
    with yarpy.Port("/icub/head/state:o") as port:
        port.connect("ros2://pose~std_msgs/msg/String")
        part = take_part(0)
        wait_until(lambda: part.graph.endpoints("/pose", "MP"))
        assert str(part.graph.endpoints("/pose", "MP")[0].node) == "/icub/head/state_o"
        part.close()


@pytest.mark.parametrize(
    ("target", "error", "says"),
    [
        ("ros2://a b", AddressError, "no name of ROS 2"),
        ("ros2+domain.999://a", AddressError, "no domain"),
        ("ros2+qos.fast://a", AddressError, "no QoS"),
        ("ros2+distro.jazzy://a", AddressError, "distro.humble"),
        ("ros2+node.a-b://a", AddressError, "no name of ROS 2"),
        ("ros2://a~p/msg/Nothing", UnknownType, "p/msg/Nothing"),
        ("ros2+srv://nobody", UnknownName, "nobody serves /nobody"),
    ],
)
def test_what_is_wrong(
    names: yarpy.LocalNames, target: str, error: type[Exception], says: str
) -> None:
    with yarpy.Port("/out") as port:
        with pytest.raises(error, match=says):
            port.connect(target)
        assert port.stats.outputs == []


def test_connecting_from_outside(names: yarpy.LocalNames) -> None:
    """As `yarpy connect` does: the port is asked, and the topic is an end like any other."""
    with yarpy.Port("/out") as out, yarpy.BufferedPort("/in", strict=True) as reader:
        assert yarpy.connect("ros2://outside", "/in").carrier == "ros2+sub"
        assert yarpy.connect("/out", "ros2://outside~std_msgs/msg/String").carrier == "ros2"
        wait_until(lambda: out.stats.outputs)
        for _ in range(100):
            out.write("hi")
            try:
                assert reader.read(timeout=0.1).value == "hi"
                break
            except yarpy.Timeout:
                continue
        assert yarpy.is_connected("/out", "ros2://outside")
        assert yarpy.disconnect("/out", "ros2://outside")
        assert yarpy.disconnect("ros2://outside", "/in")
        assert out.stats.outputs == []
        wait_until(lambda: reader.stats.inputs == [])


def test_servers_and_clients_speak_of_services(names: yarpy.LocalNames) -> None:
    """Nobody has to say so."""
    with yarpy.RpcServer("/server", lambda message: [1]) as server:
        yarpy.connect("ros2://count~example_interfaces/srv/AddTwoInts", "/server")
        assert "ros2+sub+srv" in [item.carrier for item in server.stats.inputs]
        with yarpy.RpcClient(name="/client") as client:
            yarpy.connect("/client", "ros2://count")
            assert client.stats.outputs[0].carrier == "ros2+srv"
            assert client.ask([1, 2]).value == 1  # type: ignore[union-attr]


def test_commands_follow_a_topic(names: yarpy.LocalNames) -> None:
    """`yarpy view --connect ros2://camera/image` and others."""
    with yarpy.BufferedPort("/in") as reader:
        source = Source(reader, "ros2://followed~std_msgs/msg/String")
        assert source.connected
        assert yarpy.disconnect("ros2://followed", "/in")
        wait_until(lambda: not source.connected)
