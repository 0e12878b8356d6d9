"""Every member of the interface, over the network."""

from support.interface import check_every_member

from yarpy.kits.devices.interfaces.mobile_base import MobileBase, Odometry2D
from yarpy.nameserver.local import LocalNames


def test_mobilebase(names: LocalNames) -> None:
    check_every_member(MobileBase, names)


def test_odometry2d(names: LocalNames) -> None:
    check_every_member(Odometry2D, names)
