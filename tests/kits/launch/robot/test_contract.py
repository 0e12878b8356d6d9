"""The contract of devices, kept by those that ship."""

import pytest

import yarpy
from yarpy import Property
from yarpy.kits.devices import remote
from yarpy.kits.devices.control_board.remapper import remote_remapper
from yarpy.registry import devices

#: What needs another program before it opens, and says so.
CLIENTS = (remote.remote, remote.transforms, remote_remapper)
#: What may need something that is plugged in, and says so.
HARDWARE = "yarpy.kits.devices.hardware"
WRONG = (ValueError, OSError, yarpy.YarpError)
NEEDED = {"virtualAnalogServer": {"networks": ["left"], "left": [0, 3, 0, 3]}}


@pytest.mark.parametrize("name", devices.names())
def test_what_ships_opens_and_has_methods_of_the_contract(name: str) -> None:
    options = Property(device=name, name="/device", **NEEDED.get(name, {}))
    plugin = devices.load(name)
    if plugin in CLIENTS:
        with pytest.raises(WRONG):
            plugin(options, names=yarpy.LocalNames())
        return
    try:
        device = plugin(options, names=yarpy.LocalNames())
    except WRONG:
        assert plugin.__module__.startswith(HARDWARE)
        return
    for method in ("attach", "detach", "calibrate", "park", "close"):
        assert callable(getattr(device, method, print))
    assert hasattr(device, "attach") == hasattr(device, "detach")
    getattr(device, "close", lambda: None)()
