"""A node: how others see it, its names, and its end."""

from typing import Any

import pytest
from support.wait import HANG, wait_until

import yarpy
from yarpy.errors import AddressError, LocalProtocolError
from yarpy.peers import ros2
from yarpy.peers.ros2.name import Node
from yarpy.peers.ros2.node.node import chosen
from yarpy.peers.ros2.zenoh.participant import take_part

ADD = "example_interfaces/srv/AddTwoInts"


def test_how_others_see_it(names: yarpy.LocalNames) -> None:
    part = take_part(0)
    try:
        with ros2.Node("/robot/arm") as node:
            assert (node.name, repr(node)) == ("/robot/arm", "<Node /robot/arm>")
            wait_until(lambda: len(part.graph.nodes(Node("/robot", "arm"))) == 1)
            tokens = [token for token in part.graph.tokens if token.node == Node("/robot", "arm")]
            served = {token.key.name for token in tokens if token.key and token.kind == "SS"}
            assert "/robot/arm/get_parameters" in served and len(served) == 7
            assert part.graph.endpoints("/parameter_events", "MP")
            node.action_server("fib", "example_interfaces/action/Fibonacci", lambda goal: None)
            wait_until(lambda: part.graph.endpoints("/robot/fib/_action/cancel_goal", "SS"))
        wait_until(lambda: not part.graph.nodes(Node("/robot", "arm")))
    finally:
        part.close()


def test_names_of_topics_and_services(names: yarpy.LocalNames) -> None:
    with ros2.Node("/robot/arm") as node:
        assert node.resolve("x") == "/robot/x"
        assert node.resolve("~/x") == "/robot/arm/x"
        assert node.resolve("/x") == "/x"
        with pytest.raises(AddressError):
            node.resolve("a b")
    with pytest.raises(AddressError):
        ros2.Node("a b")


def test_services(names: yarpy.LocalNames) -> None:
    with ros2.Node("/adder") as adder, ros2.Node("/asker") as asker:
        adder.service("add", ADD, lambda request: {"sum": request.a + request.b})
        assert asker.client("/add", ADD).wait(HANG)
        for arguments in ([[5, 37]], [5, 37], [{"a": 5, "b": 37}]):
            assert asker.call("/add", ADD, *arguments).sum == 42
        with pytest.raises(TypeError, match="is asked with"):  # another type's bytes went out
            asker.call("/add", ADD, ros2.load("std_msgs/msg/String")("hi"))
        with yarpy.RpcClient(f"ros2://add~{ADD}", name="/port") as port:
            assert port.ask([1, 2]).ros.sum == 3  # type: ignore[union-attr, attr-defined]


def test_the_end(names: yarpy.LocalNames) -> None:
    node = ros2.Node("/short")
    node.close()
    node.close()
    with pytest.raises(LocalProtocolError, match="is closed"):
        node.service("/x", ADD, lambda request: None)
    node.parameters.declare("late", 1)  # which nobody is told


def test_which_layer() -> None:
    names = {said: chosen(said, {}).__name__ for said in (None, "zenoh", "dds")}
    assert names == {None: "ZenohRmw", "zenoh": "ZenohRmw", "dds": "DdsRmw"}
    for rmw, name in {"rmw_zenoh_cpp": "ZenohRmw", "rmw_cyclonedds_cpp": "DdsRmw"}.items():
        assert chosen(None, {"RMW_IMPLEMENTATION": rmw}).__name__ == name
    with pytest.raises(AddressError, match="zenoh or dds"):
        chosen("tcp", {})


def test_content_filters_are_refused(names: yarpy.LocalNames) -> None:
    with ros2.Node("/arm") as arm:
        wanted: Any = ("data = %0", ["7"])
        with pytest.raises(LocalProtocolError, match="let the callback return"):
            arm.subscriber("x", "std_msgs/msg/String", print, content_filter_options=wanted)


def test_the_command_line(names: yarpy.LocalNames) -> None:
    said = [
        "--ros-args",
        "-r",
        "__node:=left",
        "-r",
        "__ns:=/lab",
        "-r",
        "add:=sum",
        "-p",
        "gain:=3.5",
    ]
    with ros2.Node("/adder", arguments=said, parameters={"gain": 2.5}) as adder:
        assert adder.name == "/lab/left" and adder.parameters.get("gain") == 3.5
        adder.service("add", ADD, lambda request: {"sum": request.a + request.b})
        with ros2.Node("/asker") as asker:
            assert asker.client("/lab/sum", ADD).wait(HANG)
            assert asker.call("/lab/sum", ADD, [5, 37], timeout=HANG).sum == 42
    for wrong in ("gain:=3", "gain:=fast"):
        with pytest.raises(TypeError, match="gain is a double"):
            ros2.Node("/x", arguments=["--ros-args", "-p", wrong], parameters={"gain": 2.5})
    with ros2.Node("/x", arguments=["--ros-args", "--disable-rosout-logs"]) as quiet:
        assert not quiet.logger.handlers
