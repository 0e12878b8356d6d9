"""Nodes of ROS 2 itself: rclpy of Kilted over Fast DDS, beside ours, on this computer alone."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from support.rclpy_program import Rclpy
from support.wait import HANG, wait_until

import yarpy
from yarpy.peers import ros2
from yarpy.peers.ros2.dds.participant import POOL
from yarpy.peers.ros2.message.library import hash_of
from yarpy.peers.ros2.token import PUBLISHER

STRING, FLAG = "std_msgs/msg/String", "std_srvs/srv/SetBool"
PROFILES = ("default", "sensor", "latched")


@pytest.fixture
def node(here: None, own: str) -> Iterator[ros2.Node]:
    with ros2.Node(f"{own}_ours", rmw="dds") as found:
        yield found


@pytest.mark.parametrize("profile", PROFILES)
def test_it_hears_ours(rclpy: Rclpy, node: ros2.Node, topic: str, profile: str) -> None:
    writer = node.publisher(topic, STRING, qos=profile)
    if profile == "latched":  # who comes later hears the last one
        writer.write("first"), writer.write("last")
        rclpy.do("hear", topic, profile)
        wait_until(lambda: rclpy.heard(topic) == ["last"], HANG)
        return
    rclpy.do("hear", topic, profile)
    assert all_of(lambda text: writer.write(text), lambda: rclpy.heard(topic))


@pytest.mark.parametrize("profile", PROFILES)
def test_ours_hear_it(rclpy: Rclpy, node: ros2.Node, topic: str, profile: str) -> None:
    """Without a QoS: that of the publisher is taken."""
    heard: list[str] = []
    rclpy.do("publish", topic, profile)
    if profile == "latched":
        rclpy.do("say", topic, "kept")
        node.subscriber(topic, STRING, lambda message: heard.append(message.data))
        wait_until(lambda: heard == ["kept"], HANG)
        return
    node.subscriber(topic, STRING, lambda message: heard.append(message.data))
    assert all_of(lambda text: rclpy.do("say", topic, text), lambda: heard)


def all_of(say: Any, heard: Any) -> bool:
    """Say something until it is heard, then more; return whether all of that came, in order."""

    def met() -> bool:
        say("hello")
        return bool(heard())

    wait_until(met, HANG)
    texts = ["grüße", *(f"number {number}" for number in range(3))]
    for text in texts:
        say(text)
    wait_until(lambda: len(heard()) > 0 and heard()[-1] == texts[-1], HANG)
    return [text for text in heard() if text != "hello"] == texts


def test_ports(rclpy: Rclpy, topic: str) -> None:
    """A port writes, another reads: the type is the one that rclpy's side has."""
    rclpy.do("hear", f"{topic}_to", "default")
    rclpy.do("publish", f"{topic}_from", "default")
    with yarpy.Port(f"{topic}/out") as out, yarpy.BufferedPort(f"{topic}/in", strict=True) as into:
        out.connect(f"ros2+dds:/{topic}_to", timeout=HANG)
        assert all_of(out.write, lambda: rclpy.heard(f"{topic}_to"))
        into.listen_to(f"ros2+dds:/{topic}_from", timeout=HANG)
        found: list[object] = []

        def come() -> bool:
            rclpy.do("say", f"{topic}_from", "hello")
            try:
                found.append(into.read(timeout=0.1).value)
            except yarpy.Timeout:
                return False
            return True

        wait_until(come, HANG)
        assert found == ["hello"]


TYPES = {
    "geometry_msgs/msg/PoseArray": {"poses": [{"position": [1, 2, 3]}]},
    "nav_msgs/msg/Path": {"poses": [{"pose": {"position": [1, 2, 3]}}]},
    "nav_msgs/msg/OccupancyGrid": {"data": [0, 100, -1]},
    "nav_msgs/msg/Odometry": {"child_frame_id": "base"},
    "sensor_msgs/msg/Image": {"width": 2, "height": 1, "encoding": "mono8", "data": b"\x01\x02"},
    "sensor_msgs/msg/JointState": {"name": ["elbow", "wrist"], "position": [0.5, -0.5]},
    "sensor_msgs/msg/LaserScan": {"ranges": [1.0, 2.0]},
    "sensor_msgs/msg/PointCloud2": {"fields": [{"name": "x", "count": 1}], "data": b"1234"},
    "std_msgs/msg/Float64MultiArray": {"data": [1.5, 2.5]},
    "trajectory_msgs/msg/JointTrajectory": {"points": [{"positions": [1.0, 2.0]}]},
    "visualization_msgs/msg/MarkerArray": {"markers": [{"ns": "arm", "text": "grüße"}]},
}


@pytest.mark.parametrize("type_", TYPES)
def test_types_with_lists_and_arrays(rclpy: Rclpy, node: ros2.Node, topic: str, type_: str) -> None:
    """Which the library of DDS cannot compare with those of Fast DDS."""
    heard: list[Any] = []
    rclpy.do("echo", type_, f"{topic}/there", f"{topic}/back")
    node.subscriber(f"{topic}/back", type_, heard.append)
    writer = node.publisher(f"{topic}/there", type_)
    sent = writer.kind.from_bottle(TYPES[type_])

    def came() -> bool:
        writer.write(sent)
        return bool(heard)

    wait_until(came, HANG)
    if hasattr(sent, "header"):
        heard[0].header.stamp = sent.header.stamp  # the time when it was written
    assert b"".join(heard[0].to_ros()) == b"".join(sent.to_ros())


def test_a_service_is_said_to_be_out_of_reach(rclpy: Rclpy, node: ros2.Node, own: str) -> None:
    """Fast DDS says whose answer it is where the library does not let us read it."""
    rclpy.do("serve", own)

    def told() -> bool:
        with pytest.raises(yarpy.UnknownName) as caught:
            node.call(own, FLAG, True)
        return "RMW_IMPLEMENTATION=rmw_cyclonedds_cpp" in str(caught.value)

    wait_until(told, HANG)


def test_it_sees_our_node(rclpy: Rclpy, node: ros2.Node, own: str) -> None:
    writer = node.publisher(own, STRING, qos="latched")
    node.service(f"{own}/flag", FLAG, lambda asked: [True, ""])
    space, name = node.name.rsplit("/", 1)
    wait_until(lambda: node.name in rclpy.do("nodes"), HANG)
    wait_until(lambda: [own, [STRING]] in rclpy.do("topics", name, space or "/"), HANG)
    services = {
        (f"{own}/flag", FLAG),
        (f"{node.name}/get_parameters", "rcl_interfaces/srv/GetParameters"),
    }

    def serves() -> bool:
        found = rclpy.do("services", name, space or "/")
        return services <= {(each, *types) for each, types in found}

    wait_until(serves, HANG)
    wait_until(lambda: rclpy.do("publishers_of", own), HANG)
    (row,) = rclpy.do("publishers_of", own)
    assert row[1] == STRING and row[3:] == ["RELIABLE", "TRANSIENT_LOCAL"]
    assert hash_of(writer.kind) in row[2]


def test_we_see_its_node(rclpy: Rclpy, node: ros2.Node, topic: str) -> None:
    rclpy.do("publish", topic, "sensor")

    def seen() -> bool:
        part = POOL.take(0)
        try:
            found = part.seen(topic, PUBLISHER)
            return bool(found) and str(found[0].node) == rclpy.name and not found[0].qos.reliable
        finally:
            POOL.leave(part)

    wait_until(seen, HANG)
