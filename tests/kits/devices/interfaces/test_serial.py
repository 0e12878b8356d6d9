"""Every member of the interface, over the network."""

from support.interface import check_every_member

from yarpy.kits.devices.interfaces.serial import SerialPort
from yarpy.nameserver.local import LocalNames


def test_serialport(names: LocalNames) -> None:
    check_every_member(SerialPort, names)
