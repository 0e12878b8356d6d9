"""What an interface's class says of its members."""

import pytest

import yarpy
from yarpy.kits.devices.interfaces.mobile_base import MobileBase, Odometry2D
from yarpy.kits.devices.interfaces.place import Velocity
from yarpy.kits.devices.network.model import Interface, call


def test_members() -> None:
    assert [*MobileBase.members] == ["apply_velocity", "last_velocity"]
    drive = MobileBase.members["apply_velocity"]
    assert drive.function == "applyVelocityCommandRPC" and drive.cpp == "applyVelocityCommand"
    assert drive.sink == "data:i" and drive.sink_kind is Velocity and drive.results == ()
    assert drive.arguments((1.0, 2.0), {"theta": 3.0}) == (1.0, 2.0, 3.0, 0.1)
    with pytest.raises(TypeError, match="theta"):
        drive.arguments((1.0, 2.0), {})
    assert MobileBase.members["last_velocity"].results == (float, float, float)
    assert Odometry2D.members["odometry"].source == "odometry:o"


def test_arguments_that_are_taken_by_name_alone() -> None:
    class Lamp(Interface):
        @call("dim_RPC")
        def dim(self, *, level: float) -> None: ...

    dim = Lamp.members["dim"]
    assert dim.count == -1 and MobileBase.members["last_velocity"].count == 0
    assert MobileBase.members["apply_velocity"].arguments((1, 2, 3, 4), {}) == (1, 2, 3, 4)
    with pytest.raises(TypeError):
        dim.arguments((1.0,), {})


def test_members_are_inherited() -> None:
    class More(Odometry2D):
        @call("more_RPC")
        def more(self) -> int:
            raise NotImplementedError

    assert [*More.members] == [*Odometry2D.members, "more"]
    assert More.NWS == Odometry2D.NWS


def test_what_is_no_client_is_not_closed() -> None:
    with pytest.raises(yarpy.LocalProtocolError, match="no client"):
        Interface().close()
