"""Every member of the interface, over the network."""

from support.interface import check_every_member

from yarpy.kits.devices import SimulatedWorld
from yarpy.kits.devices.interfaces.world import Descriptions, World
from yarpy.nameserver.local import LocalNames
from yarpy.port.rpc import RpcClient


def test_descriptions(names: LocalNames) -> None:
    check_every_member(Descriptions, names)


def test_world(names: LocalNames) -> None:
    check_every_member(World, names)


def test_who_does_not_say_that_it_is_of_yarp_4(names: LocalNames) -> None:
    """Its client in C++, `simulatedWorld_nwc_yarp`, does not ask for the version."""
    with (
        World.serve("/ours", SimulatedWorld(), names=names),
        RpcClient("/ours/rpc:i", names=names) as client,
    ):
        assert client.call("getList") == [["ok"], []]
