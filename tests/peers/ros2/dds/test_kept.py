"""What a port keeps for readers of ROS 2 that come late, and what a late port gets itself."""

from __future__ import annotations

import pytest
from support.rclpy_program import Rclpy
from support.wait import HANG, wait_until

import yarpy

TYPE = "~std_msgs/msg/String"


@pytest.mark.parametrize(
    ("qos", "late", "kept"),
    [
        ("+qos.latched", "latched", ["4"]),
        ("+qos.latched", "kept", ["4"]),
        ("+qos.latched+depth.3", "kept", ["2", "3", "4"]),
        ("+qos.latched+depth.3", "latched", ["4"]),
        ("+qos.default+durability.transient_local", "kept", ["0", "1", "2", "3", "4"]),
        ("+qos.all+durability.transient_local", "kept", ["0", "1", "2", "3", "4"]),
    ],
)
def test_a_late_reader_hears_what_a_port_has_kept(
    rclpy: Rclpy, topic: str, qos: str, late: str, kept: list[str]
) -> None:
    """`ros2 topic echo --qos-durability transient_local --qos-reliability reliable`."""
    with yarpy.Port(f"{topic}/out") as out:
        out.connect(f"ros2+dds{qos}:/{topic}{TYPE}")
        for number in range(5):
            out.write(str(number))
        rclpy.do("hear", topic, late)
        wait_until(lambda: rclpy.heard(topic)[: len(kept)] == kept, HANG)

        def live() -> bool:
            out.write("live")
            return "live" in rclpy.heard(topic)

        wait_until(live, HANG)
        assert rclpy.heard(topic)[: len(kept) + 1] == [*kept, "live"]


@pytest.mark.parametrize("qos", ["", "+qos.latched"])
def test_one_that_asks_for_what_is_kept_without_being_reliable(
    rclpy: Rclpy, topic: str, qos: str
) -> None:
    """`ros2 topic echo --qos-durability transient_local` alone, which DDS sends nothing of before,
    but what comes."""
    with yarpy.Port(f"{topic}/out") as out:
        out.connect(f"ros2+dds{qos}:/{topic}{TYPE}")
        rclpy.do("hear", topic, "echo")

        def live() -> bool:
            out.write("live")
            return "live" in rclpy.heard(topic)

        wait_until(live, HANG)


@pytest.mark.parametrize("qos", ["", "+qos.latched+depth.10"])
def test_a_late_port_hears_what_a_node_has_kept(rclpy: Rclpy, topic: str, qos: str) -> None:
    rclpy.do("publish", topic, "kept")
    for number in range(5):
        rclpy.do("say", topic, str(number))
    with yarpy.BufferedPort(f"{topic}/in", strict=True) as reader:
        reader.listen_to(f"ros2+dds{qos}:/{topic}", timeout=HANG)
        rclpy.do("say", topic, "live")
        found = [reader.read(timeout=HANG).value for _ in range(6)]
        assert found == ["0", "1", "2", "3", "4", "live"]


def test_a_port_without_a_qos_keeps_once_it_is_asked(rclpy: Rclpy, topic: str) -> None:
    """As a publisher of ROS 2 that keeps nothing, it has nothing for the first who asks; but that
    one hears what comes, and the next one what was kept for it."""
    with yarpy.Port(f"{topic}/out") as out:
        out.connect(f"ros2+dds:/{topic}{TYPE}")
        out.write("lost")
        rclpy.do("hear", topic, "kept")

        def live() -> bool:
            out.write("live")
            return "live" in rclpy.heard(topic)

        wait_until(live, HANG)
        for number in range(5):
            out.write(str(number))
        wait_until(lambda: rclpy.heard(topic)[-1:] == ["4"], HANG)
        assert "lost" not in rclpy.heard(topic)
        before = len(rclpy.heard(topic))
        rclpy.do("hear", topic, "kept")
        wait_until(lambda: rclpy.heard(topic)[before:][-5:] == ["0", "1", "2", "3", "4"], HANG)
