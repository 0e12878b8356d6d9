"""Transforms of nodes of ROS 2."""

import pytest
from support.wait import HANG

import yarpy
from yarpy.peers import ros2


def test_from_node_to_node(names: yarpy.LocalNames) -> None:
    with ros2.Node("/tells") as teller, ros2.Node("/listens") as listener:
        tells = ros2.Transforms(teller)
        tells.send("base", "camera", (0.0, 0.0, 1.5), fixed=True)
        hears = ros2.Transforms(listener)  # late: fixed frames are kept
        assert hears.lookup("base", "camera", timeout=HANG).pose.at == (0.0, 0.0, 1.5)
        tells.send("map", "base", (2.0, 0.0, 0.0), time=10.25)
        tells.send("map", "base", (4.0, 0.0, 0.0), time=10.75)
        found = hears.lookup("map", "camera", 10.5, timeout=HANG)
        assert found.pose.at == pytest.approx((3.0, 0.0, 1.5))
