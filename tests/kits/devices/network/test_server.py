"""A device behind an interface's server, asked as programs of C++ ask."""

import pytest
from support.wait import HANG, wait_until

import yarpy
from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.kits.devices.interfaces.mobile_base import MobileBase, Odometry2D
from yarpy.kits.devices.interfaces.place import Odometry, Velocity
from yarpy.kits.devices.network.functions import functions_of
from yarpy.kits.thrift.client import client_class
from yarpy.nameserver.local import LocalNames


class Base:
    """Remembers what it was told."""

    def __init__(self) -> None:
        self.told: list[tuple[float, ...]] = []

    def apply_velocity(self, x: float, y: float, theta: float, timeout: float = 0.1) -> None:
        if x > 1.0:
            raise ValueError("too fast")
        self.told.append((x, y, theta, timeout))

    def odometry(self) -> Odometry:
        return Odometry(1.0, 2.0, 3.0)


DRIVE = "applyVelocityCommandRPC"


def test_calls(names: LocalNames) -> None:
    base = Base()
    with (
        MobileBase.serve("/base", base, names=names) as server,
        yarpy.RpcClient("/base/rpc:i", names=names) as port,
    ):
        assert repr(server) == "<server of MobileBase /base>" and server.device is base
        assert port.call(Bottle([DRIVE, 0.5, 0.0, 9.0, 0.2])) == Vocab("ok")
        assert base.told == [(0.5, 0.0, 9.0, 0.2)]
        assert port.call(Bottle([DRIVE, 2.0, 0.0, 9.0, 0.2])) == Vocab("fail")
        missing = port.call(Bottle(["getLastVelocityCommandRPC"]))
        assert missing == [Vocab("fail"), 0.0, 0.0, 0.0]


def test_calls_of_3_12(names: LocalNames) -> None:
    with (
        MobileBase.serve("/base", Base(), newer=True, names=names),
        yarpy.RpcClient("/base/rpc:i", names=names) as port,
    ):
        assert port.call(Bottle(["getLastVelocityCommandRPC"])) == [2, 0.0, 0.0, 0.0]
        functions = client_class(functions_of(MobileBase))(port, 10.0)
        functions._yarp4 = False  # it does not ask for the version, as programs of 3.12 do not
        assert functions.applyVelocityCommandRPC(0.5, 0.0, 9.0, 0.2).code == "ok"
        assert functions.applyVelocityCommandRPC(2.0, 0.0, 9.0, 0.2).code == "err5"


def test_who_asks_for_the_version_is_of_yarp_4(names: LocalNames) -> None:
    with (
        MobileBase.serve("/base", Base(), names=names),
        yarpy.RpcClient("/base/rpc:i", names=names) as port,
    ):
        assert client_class(functions_of(MobileBase))(port, 10.0).remote_version()
        message = port.ask(Bottle(["getLastVelocityCommandRPC"]), 10.0)
        assert message is not None
        data = message.to_bytes()
        assert data[:28] == bytes.fromhex(
            "0001000004000000 00010000010000000900000065727232 14000000"
        )


def test_what_a_port_takes(names: LocalNames) -> None:
    base = Base()
    with MobileBase.serve("/base", base, names=names), yarpy.Port("/out", names=names) as out:
        out.connect("/base/data:i")
        out.write(Bottle(["nonsense"]))
        out.write(Velocity(0.5, 0.25, 9.0))
        wait_until(lambda: base.told == [(0.5, 0.25, 9.0, 0.1)])


def test_what_a_port_sends(names: LocalNames) -> None:
    with (
        Odometry2D.serve("/base", Base(), 0.01, names=names),
        yarpy.BufferedPort("/in", names=names) as port,
    ):
        port.listen_to("/base/odometry:o")
        message = port.read(timeout=HANG)
        assert message.as_(Odometry) == Odometry(1.0, 2.0, 3.0) and message.stamp is not None


def test_a_device_without_any_member(names: LocalNames) -> None:
    with pytest.raises(ValueError, match="has none of odometry, reset_odometry"):
        Odometry2D.serve("/base", object(), names=names)
