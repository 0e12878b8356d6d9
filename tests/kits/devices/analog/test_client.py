"""A remote sensor with channels, used like a local one."""

from __future__ import annotations

import pytest
from support.wait import HANG

import yarpy
from yarpy.errors import LocalProtocolError
from yarpy.kits.devices.analog.client import AnalogSensor
from yarpy.kits.devices.analog.server import AnalogSensorServer
from yarpy.kits.devices.simulated.analog import SimulatedAnalogSensor
from yarpy.nameserver.local import LocalNames


class Still(SimulatedAnalogSensor):
    def _read(self) -> list[float]:
        return [3.0, 4.0]


def test_values_and_calibration(names: LocalNames) -> None:
    device = Still(2)
    with (
        AnalogSensorServer("/force", device, 0.01, names=names),
        AnalogSensor("/force", timeout=HANG, names=names) as sensor,
    ):
        assert sensor.channels() == [3.0, 4.0]
        assert sensor.timestamp() > 1e9
        sensor.calibrate()
        assert device.channels() == [0.0, 0.0]
        sensor.calibrate([1.0, 2.0])
        assert device.channels() == [1.0, 2.0]
        sensor.calibrate_channel(0)
        sensor.calibrate_channel(1, 0.5)
        assert device.channels() == [0.0, 0.5]
        with pytest.raises(LocalProtocolError, match="not calibrated"):
            sensor.calibrate_channel(2)


def test_it_is_served_again(names: LocalNames) -> None:
    with (
        AnalogSensorServer("/force", Still(2), 0.01, names=names),
        AnalogSensor("/force", timeout=HANG, names=names) as sensor,
        AnalogSensorServer("/again", sensor, 0.01, names=names),
        AnalogSensor("/again", timeout=HANG, names=names) as far,
    ):
        assert far.channels() == [3.0, 4.0]


def test_nobody_there(names: LocalNames) -> None:
    with pytest.raises(yarpy.YarpError):
        AnalogSensor("/nobody", names=names)
    with AnalogSensorServer("/mute", Still(2), 1000.0, names=names):
        sensor = AnalogSensor("/mute", timeout=0.01, names=names)
        with sensor, pytest.raises(yarpy.Timeout, match="nothing came"):
            for _ in range(2):  # its first message may still have been in time
                sensor.channels()
                sensor._latest.renew()
