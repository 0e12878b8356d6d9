"""Every member of the interface, over the network."""

from support.interface import check_every_member

from yarpy.kits.devices.interfaces.map2d import Map2D
from yarpy.nameserver.local import LocalNames


def test_map2d(names: LocalNames) -> None:
    check_every_member(Map2D, names)


def test_its_functions() -> None:
    members = Map2D.members
    assert members["rename_area"].function == "rename_area_RPC"
    assert len({each.function for each in members.values()}) == len(members) == 44
