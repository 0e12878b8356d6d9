"""Clients of interfaces: what they return, and what they raise."""

import pytest
from support.wait import wait_until

import yarpy
from yarpy.kits.devices.interfaces.mobile_base import MobileBase, Odometry2D
from yarpy.kits.devices.interfaces.place import Odometry, Velocity
from yarpy.kits.devices.network.model import Interface, call, taken
from yarpy.nameserver.local import LocalNames


class Lamp(Interface):
    """One with everything that the others have not."""

    @taken("flash:i", Velocity)
    def flash(self, one: float, two: float, three: float) -> None: ...

    @call("flush", status=False)
    def flush(self) -> int:
        raise NotImplementedError

    @call("set_on", boxed=True)
    def switch(self, on: bool) -> None: ...


class Device:
    def __init__(self) -> None:
        self.told: list[object] = []

    def flash(self, one: float, two: float, three: float) -> None:
        self.told.append((one, two, three))

    def flush(self) -> int:
        return 7

    def switch(self, on: bool) -> None:
        self.told.append(on)

    def last_velocity(self) -> tuple[float, float, float]:
        return 1.0, 2.0, 3.0

    def odometry(self) -> Odometry:
        return Odometry(1.0)

    def reset_odometry(self) -> None:
        raise RuntimeError("stuck")


def test_calls(names: LocalNames) -> None:
    device = Device()
    with Lamp.serve("/lamp", device, names=names), Lamp.connect("/lamp", names=names) as lamp:
        assert repr(lamp) == "<Lamp /lamp>" and isinstance(lamp, Lamp)
        assert lamp.flush() == 7
        lamp.switch(on=True)
        lamp.flash(1.0, 2.0, 3.0)
        wait_until(lambda: device.told == [True, (1.0, 2.0, 3.0)])
        lamp.close()


def test_several_results_and_what_is_refused(names: LocalNames) -> None:
    with (
        MobileBase.serve("/base", Device(), names=names),
        MobileBase.connect("/base", names=names) as base,
    ):
        assert base.last_velocity() == (1.0, 2.0, 3.0)
        with pytest.raises(yarpy.LocalProtocolError, match='"/base" refuses apply_velocity'):
            base.apply_velocity(1.0, 2.0, 3.0)


def test_what_is_published(names: LocalNames) -> None:
    with (
        Odometry2D.serve("/base", Device(), 0.01, names=names),
        Odometry2D.connect("/base", "/mine", names=names) as base,
    ):
        assert base.odometry() == Odometry(1.0)
        with pytest.raises(yarpy.LocalProtocolError, match='"/base" refuses reset_odometry'):
            base.reset_odometry()
        assert names.query("/mine/odometry:i") is not None


def test_a_client_is_a_device(names: LocalNames) -> None:
    with (
        MobileBase.serve("/one", Device(), names=names),
        MobileBase.connect("/one", names=names) as one,
        MobileBase.serve("/two", one, names=names),
        MobileBase.connect("/two", names=names) as two,
    ):
        assert two.last_velocity() == (1.0, 2.0, 3.0)


def test_nobody_is_there(names: LocalNames) -> None:
    with pytest.raises(yarpy.UnknownName):
        MobileBase.connect("/nowhere", names=names)
