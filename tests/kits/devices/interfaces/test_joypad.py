"""Every member of the interface, over the network."""

from support.interface import check_every_member

from yarpy.kits.devices.interfaces.joypad import Joypad
from yarpy.nameserver.local import LocalNames


def test_joypad(names: LocalNames) -> None:
    check_every_member(Joypad, names)
