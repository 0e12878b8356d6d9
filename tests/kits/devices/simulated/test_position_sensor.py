"""What tells where it is, without hardware."""

import pytest

from yarpy.kits.devices.simulated.position_sensor import SimulatedPositionSensor


def test_it_moves_by_its_clock() -> None:
    now = [50.0]
    sensor = SimulatedPositionSensor("hand", "hand_frame", clock=lambda: now[0])
    assert sensor.frames == {"hand": "hand_frame"}
    assert sensor.position_sensors() == {"hand": (0.0, 0.0, 0.0)}
    now[0] += 2.0
    assert sensor.position_sensors()["hand"] == pytest.approx((0.1, 0.1, 0.1))
    assert sensor.orientations()["hand"] == pytest.approx((-0.1, -0.1, -0.1))
    assert sensor.timestamps() == {"hand": 52.0}
