"""The rows of devices that ship with yarpy."""

import pytest

from yarpy import registry
from yarpy.shipped_devices import DEVICES


@pytest.mark.parametrize("name", DEVICES)
def test_each_is_there(name: str) -> None:
    assert DEVICES[name].name == name
    assert callable(registry.devices.load(name))
