"""The simulated head as devices of a robot's file."""

import pytest

from yarpy import Property
from yarpy.kits.sim.device import HeadBoard, SimulatedEye, SimulatedInertial, simulated_head
from yarpy.kits.sim.eye import Eye
from yarpy.kits.sim.inertial import Inertial


def test_eyes_and_the_sensor_move_with_the_head() -> None:
    head = simulated_head(Property())
    assert isinstance(head, HeadBoard) and len(head.axis_names) == 6
    left = SimulatedEye(Property(side="left", width=32, height=24))
    right = SimulatedEye(Property(side="right", width=32, height=24))
    unit = SimulatedInertial(Property())
    for one in (left, right, unit):
        one.attach({"...": head})
    assert isinstance(left.served, Eye) and isinstance(right.served, Eye)
    assert left.served.resolution == (32, 24)
    assert left.served._shutter is right.served._shutter is head.shutter
    assert isinstance(unit.served, Inertial) and unit.served.gyroscopes()
    left.detach()
    with pytest.raises(ValueError, match="no head yet"):
        _ = left.served


def test_what_is_wrong_is_refused() -> None:
    for values in ({"side": "top"}, {"width": 1}, {"height": 9999}, {"width": "wide"}):
        with pytest.raises(ValueError, match=r"side"):
            SimulatedEye(Property(values))
    for devices in ({"a": object()}, {}, {"a": simulated_head(Property()), "b": object()}):
        with pytest.raises(ValueError, match="of type simulatedHead"):
            SimulatedInertial(Property()).attach(devices)
