"""Every member of the interface, over the network."""

from support.interface import check_every_member

from yarpy.kits.devices.interfaces.world import Descriptions, World
from yarpy.nameserver.local import LocalNames


def test_descriptions(names: LocalNames) -> None:
    check_every_member(Descriptions, names)


def test_world(names: LocalNames) -> None:
    check_every_member(World, names)
