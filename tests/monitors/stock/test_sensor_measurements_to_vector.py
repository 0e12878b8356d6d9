"""sensorMeasurements_to_vector: a pose out of ten lists of sensors."""

from __future__ import annotations

import pytest
from support.monitor import received

from yarpy import Bottle, Vector
from yarpy.errors import DecodeError
from yarpy.monitors.stock.sensor_measurements_to_vector import SensorPose


def measured(orientation: object, position: object) -> bytes:
    kinds: list[object] = [[] for _ in range(10)]
    kinds[3], kinds[9] = orientation, position
    return Bottle(kinds).to_bytes()


def test_position_then_orientation() -> None:
    data = measured([[[10.0, 20.0, 30.0], 5.5]], [[[1.0, 2.0, 3.0], 5.5]])
    value = received(SensorPose, data).value
    assert isinstance(value, Vector)
    assert value.tolist() == [1, 2, 3, 10, 20, 30]


ONE = [[[1.0, 2.0, 3.0], 5.5]]


@pytest.mark.parametrize(
    "data",
    [
        measured([], ONE),
        measured(ONE, []),
        measured(ONE * 2, ONE),
        measured(ONE, [[[1.0, 2.0], 5.5]]),
        measured(ONE, [[["x", "y", "z"], 5.5]]),
        measured(ONE, "text"),
        Bottle([[], [], []]).to_bytes(),
        b"",
    ],
)
def test_other_sensors_are_refused(data: bytes) -> None:
    with pytest.raises(DecodeError):
        received(SensorPose, data)
