"""Drivers and what makes devices: found by name, added, and opened."""

import sys
from collections.abc import Iterator
from types import ModuleType
from typing import Any

import pytest

import yarp


class Battery(yarp.DeviceDriver):
    """A device of a program."""

    charge_now = 50.0

    def open(self, config: Any = None) -> bool:
        self.charge_now = config.find("charge").asFloat64()
        return self.charge_now <= 100.0

    def charge(self) -> float:
        return self.charge_now


class Batteries(yarp.DriverCreator):
    def create(self) -> Battery:
        return Battery()

    def getName(self) -> str:
        return "myBattery"

    def getWrapper(self) -> str:
        return "battery_nws_yarp"


@pytest.fixture
def factory(monkeypatch: pytest.MonkeyPatch) -> Iterator[yarp.Drivers]:
    from yarp import _poly_driver

    monkeypatch.setattr(_poly_driver, "ADDED", {})
    yield yarp.Drivers.factory()


def test_what_is_known(factory: yarp.Drivers) -> None:
    creator = factory.find("fakeBattery")
    assert creator is not None and creator.owner() is None
    assert (creator.getName(), creator.toString_c()) == ("fakeBattery", "fakeBattery")
    assert creator.getWrapper() == "battery_nws_yarp"
    assert creator.getCode() == "SimulatedBattery"
    assert factory.find("nothing") is None
    device = creator.create()
    assert device.getImplementation() is None
    assert device.open(yarp.Property()) and device.getImplementation() is not None
    driver = yarp.PolyDriver()
    assert driver.give(device) and driver.viewIBattery() is not None
    assert device.close()
    joints = factory.find("fakeMotionControl")
    assert joints is not None and joints.getWrapper() == "controlBoard_nws_yarp"
    assert joints.getCode() == ""


def test_a_type_of_ones_own(factory: yarp.Drivers) -> None:
    assert not yarp.PolyDriver("(device myBattery)").isValid()
    factory.add(Batteries())
    assert "'myBattery'" in factory.toString()
    creator = factory.find("myBattery")
    assert creator is not None and creator.getWrapper() == "battery_nws_yarp"
    driver = yarp.PolyDriver("(device myBattery) (charge 80.0)")
    view = driver.viewIBattery()
    assert view is not None and view.getBatteryCharge() == 80.0
    assert not yarp.PolyDriver("(device myBattery) (charge 101.0)").isValid()
    assert factory.remove("myBattery") and not factory.remove("myBattery")
    assert not yarp.PolyDriver("(device myBattery)").isValid()


def test_a_type_of_a_module(factory: yarp.Drivers, monkeypatch: pytest.MonkeyPatch) -> None:
    module = ModuleType("compat_devices_of_a_test")
    module.Battery = Battery  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, module.__name__, module)
    names = ("late", "battery_nws_yarp", "Battery")
    creator = yarp.StubDriverCreator(*names, module.__name__, "Battery")
    found = (creator.getName(), creator.getWrapper(), creator.getCode(), creator.toString_c())
    assert found == (*names, "late")
    assert isinstance(creator.create(), Battery)
    factory.add(yarp.StubDriverCreator("gone", "", "", "compat_devices_of_a_test", "Nothing"))
    assert not yarp.PolyDriver("(device gone)").isValid()
    factory.add(yarp.StubDriverCreator("lost", "", "", "compat_devices_of_nobody", "Nothing"))
    assert not yarp.PolyDriver("(device lost)").isValid()
    with pytest.raises(NotImplementedError, match="has to define create"):
        yarp.DriverCreator().create()


def test_yarpdev_as_a_function(capsys: pytest.CaptureFixture[str]) -> None:
    assert yarp.Drivers.yarpdev(2, ["yarpdev", "--list", "unused"]) == 0
    assert "fakeBattery" in capsys.readouterr().out
    assert yarp.Drivers.yarpdev(3, ["yarpdev", "--device", "nothingOfThatName"]) == 1
    assert "device not available" in capsys.readouterr().err


def test_registers_of_a_camera() -> None:
    class Registers:
        video_modes = 0x80000001
        video_mode = 69
        largest_window = (640, 480, 2, 2, 4, 4)
        window = (320, 240, 0, 0)
        beta_mode = True
        on: object = None

        def switch_power(self, on: bool) -> None:
            self.on = on

    class Camera:
        firewire = Registers()

    driver = yarp.PolyDriver()
    driver.give(Camera())
    view = driver.viewIFrameGrabberControlsDC1394()
    assert view is not None
    assert view.getVideoModeMaskDC1394() == 0x80000001
    assert view.setVideoModeDC1394(70) and view.getVideoModeDC1394() == 70
    places = [yarp.IVector(1) for _ in range(6)]
    assert view.getFormat7MaxWindowDC1394(*places)
    assert [place[0] for place in places] == [640, 480, 2, 2, 4, 4]
    assert view.setFormat7WindowDC1394(8, 6, 1, 2) and Camera.firewire.window == (8, 6, 1, 2)
    assert view.getOperationModeDC1394() is True and not view.getTransmissionDC1394()
    assert view.setPowerDC1394(True) and Camera.firewire.on is True
    assert not view.setResetDC1394() and view.getFPSDC1394() == 0
    bare = yarp.IFrameGrabberControlsDC1394(object())
    assert not bare.setPowerDC1394(True) and not bare.getFormat7WindowDC1394(*places[:4])


def test_memory_of_a_board() -> None:
    class Board:
        print_function: Any = None
        done: list[str] = []

        def load_boot_memory(self) -> None:
            self.done.append("load")
            self.print_function("loaded")

        def save_boot_memory(self) -> None:
            self.done.append("save")

    board, said = Board(), []
    driver = yarp.PolyDriver()
    driver.give(board)
    view = driver.viewIControlDebug()
    assert view is not None and view.setPrintFunction(said.append)
    assert view.loadBootMemory() and view.saveBootMemory()
    assert board.done == ["load", "save"] and said == ["loaded"]
    assert not yarp.IControlDebug(object()).loadBootMemory()
