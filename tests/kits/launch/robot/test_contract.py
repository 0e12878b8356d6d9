"""The contract of devices, kept by those that ship."""

import pytest

from yarpy import Property
from yarpy.registry import devices

PARAMETERS = {"name": "/device"}


@pytest.mark.parametrize("name", devices.names())
def test_what_ships_opens_and_has_methods_of_the_contract(name: str) -> None:
    device = devices.load(name)(Property(PARAMETERS), names=None)
    for method in ("attach", "detach", "calibrate", "park", "close"):
        assert callable(getattr(device, method, print))
    assert hasattr(device, "attach") == hasattr(device, "detach")
