"""A sensor with channels, without hardware."""

import time

import pytest

from yarpy.kits.devices.simulated.analog import SimulatedAnalogSensor


def test_it_measures_the_time_on_its_first_channel() -> None:
    sensor = SimulatedAnalogSensor(3)
    before = time.time()
    first, *others = sensor.channels()
    assert before <= first <= time.time() and others == [0.0, 0.0]
    assert sensor.states() == ["ok"] * 3


def test_it_is_calibrated() -> None:
    sensor = SimulatedAnalogSensor(2)
    sensor.calibrate()
    assert 0.0 <= sensor.channels()[0] < 1000.0
    sensor.calibrate([5000.0, 1.0])
    first, second = sensor.channels()
    assert 5000.0 <= first < 6000.0 and second == 1.0
    sensor.calibrate_channel(1)
    assert sensor.channels()[1] == 0.0
    with pytest.raises(ValueError, match="1 values for 2 channels"):
        sensor.calibrate([1.0])
    with pytest.raises(ValueError, match="no channel 2"):
        sensor.calibrate_channel(2)
