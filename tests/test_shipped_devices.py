"""The rows of devices that ship with yarpy."""

from support.table import for_each

from yarpy import registry
from yarpy.shipped_devices import DEVICES


@for_each(DEVICES)
def test_each_is_there(name: str) -> None:
    assert DEVICES[name].name == name
    assert callable(registry.devices.load(name))
