"""A battery that is used evenly."""

from yarpy.kits.devices.battery.interface import BATTERY
from yarpy.kits.devices.simulated.battery import LASTS, SimulatedBattery


def test_it_becomes_empty() -> None:
    now = [0.0]
    battery = SimulatedBattery(lambda: now[0])
    assert (battery.charge(), battery.voltage(), battery.status()) == (100.0, 24.0, "in use")
    now[0] = 0.9 * LASTS
    assert battery.status() == "low" and battery.current() == 2.0
    now[0] = 2 * LASTS
    assert (battery.charge(), battery.voltage(), battery.status()) == (0.0, 20.0, "critical")
    assert battery.status() in BATTERY and battery.temperature() == 25.0 and battery.info
