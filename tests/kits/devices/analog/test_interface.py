"""The interfaces of sensors with channels."""

from yarpy.kits.devices.analog.interface import STATES, AnalogSensorLike, VirtualSensorLike
from yarpy.kits.devices.simulated.analog import SimulatedAnalogSensor
from yarpy.kits.devices.simulated.joints import SimulatedJoints


def test_simulated_devices_have_them() -> None:
    sensor: AnalogSensorLike = SimulatedAnalogSensor(2)
    assert sensor.states() == [STATES[0]] * 2
    board: VirtualSensorLike = SimulatedJoints(["a", "b"])
    board.update_measures([1.0])
