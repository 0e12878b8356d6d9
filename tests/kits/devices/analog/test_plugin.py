"""Estimated torques in the file of a robot."""

from __future__ import annotations

import pytest
from support.wait import wait_until

import yarpy
from yarpy import Property
from yarpy.kits.devices.analog.plugin import VirtualAnalog
from yarpy.kits.devices.simulated.joints import SimulatedJoints
from yarpy.nameserver.local import LocalNames


def test_in_the_file_of_a_robot(names: LocalNames) -> None:
    options = Property.from_text('(name /vft:i) (networks (arm)) (arm "0 5 0 5")')
    device = VirtualAnalog(options, names=names)
    joints = SimulatedJoints("abcdef")
    device.attach({"...": joints})
    with yarpy.Port("/estimates", names=names) as port:
        port.connect("/vft:i")
        port.write(yarpy.Bottle.from_text("2 1 2 3 4 5 6"))
        wait_until(lambda: joints.torques() == [1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
    with pytest.raises(ValueError, match="already"):
        device.attach({"arm": joints})
    device.detach()
    assert names.query("/vft:i") is None


@pytest.mark.parametrize(
    ("options", "why"),
    [
        ("(networks (a)) (a (0 1 0 1))", "needs a parameter name"),
        ("(name /x)", "needs a parameter networks"),
        ("(name /x) (networks (a))", "a needs four numbers"),
        ("(name /x) (networks (a)) (a (3 0 0 3))", "a needs four numbers"),
        ("(name /x) (networks (a)) (a (0 999 0 3))", "a needs four numbers"),
    ],
)
def test_parameters_that_name_no_networks(options: str, why: str) -> None:
    with pytest.raises(ValueError, match=why):
        VirtualAnalog(Property.from_text(options))
