"""Every member of the interface, over the network."""

from support.interface import check_every_member

from yarpy.kits.devices.interfaces.localization import Localization2D
from yarpy.nameserver.local import LocalNames


def test_localization2d(names: LocalNames) -> None:
    check_every_member(Localization2D, names)
