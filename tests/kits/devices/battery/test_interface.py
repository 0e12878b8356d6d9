from yarpy.kits.devices.battery.client import Battery
from yarpy.kits.devices.battery.interface import BATTERY, BatteryLike


def test_a_client_is_a_whole_battery() -> None:
    members = {
        name for name in [*vars(BatteryLike), *BatteryLike.__annotations__] if name[0] != "_"
    }
    assert members == {"charge", "voltage", "current", "temperature", "status", "info"}
    assert all(hasattr(Battery, name) for name in members)
    assert BATTERY[2] == "in use"
