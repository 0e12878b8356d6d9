"""Servers as devices of a robot's file."""

import pytest

import yarpy
from yarpy import Property
from yarpy.kits import devices
from yarpy.kits.devices import wrapper


class Joints:
    axis_names = ("a",)

    def encoders(self) -> list[float]:
        return [1.5]


class Laser:
    def ranges(self) -> list[float]:
        return [1.0]


class Camera:
    def image(self) -> yarpy.Image:
        return yarpy.Image(2, 2)


class Battery:
    def charge(self) -> float:
        return 50.0


class Sensor:
    def gyroscopes(self) -> dict[str, tuple[float, float, float]]:
        return {"g": (0.0, 0.0, 0.0)}


@pytest.mark.parametrize(
    ("kind", "device", "port"),
    [
        (wrapper.ControlBoard, Joints(), "/x/state:o"),
        (wrapper.FrameGrabber, Camera(), "/x"),
        (wrapper.Laser, Laser(), "/x"),
        (wrapper.MultiSensor, Sensor(), "/x/measures:o"),
        (wrapper.Battery, Battery(), "/x/data:o"),
        (wrapper.Analog, devices.SimulatedAnalogSensor(), "/x/rpc:i"),
        (wrapper.FrameWriter, devices.SimulatedFrameWriter(), "/x/rpc"),
    ],
)
def test_ports_are_open_while_a_device_is_attached(
    kind: type[wrapper.Wrapper], device: object, port: str
) -> None:
    names = yarpy.LocalNames()
    opened = kind(Property(name="/x", period=20), names=names)
    assert names.query(port) is None
    opened.attach({"...": device})
    assert names.query(port) is not None
    with pytest.raises(ValueError, match="already"):
        opened.attach({"...": device})
    opened.detach()
    assert names.query(port) is None
    opened.attach({"...": device})
    opened.close()
    assert names.query(port) is None


def test_what_cannot_be_served_is_refused() -> None:
    with pytest.raises(ValueError, match="needs a parameter name"):
        wrapper.Laser(Property())
    for period in (0, -1, "fast", True):
        with pytest.raises(ValueError, match="is no time"):
            wrapper.Laser(Property(name="/x", period=period))
    opened = wrapper.Laser(Property(name="/x"), names=yarpy.LocalNames())
    with pytest.raises(ValueError, match="one device, not 2"):
        opened.attach({"a": Laser(), "b": Laser()})
    with pytest.raises(ValueError, match="ranges"):
        opened.attach({"a": object()})


def test_only_that_of_sensors_counts_milliseconds() -> None:
    assert wrapper.MultiSensor(Property(name="/x", period=20))._values == {"period": 0.02}
    assert wrapper.Laser(Property(name="/x", period=20))._values == {"period": 20.0}
    assert wrapper.Laser(Property(name="/x"))._values == {}


def test_parts_of_a_sensor_with_channels() -> None:
    names = yarpy.LocalNames()
    text = "(name /skin) (period 20) (ports (hand arm)) (hand 0 1 0 1) (arm (2 3 0 1))"
    opened = wrapper.Analog(Property.from_text(text), names=names)
    assert opened._values == {"period": 0.02, "parts": {"hand": range(2), "arm": range(2, 4)}}
    opened.attach({"...": devices.SimulatedAnalogSensor(4)})
    assert names.query("/skin/hand") is not None and names.query("/skin") is None
    opened.close()
    with pytest.raises(ValueError, match="arm has not as many channels"):
        wrapper.Analog(Property.from_text("(name /skin) (ports (arm)) (arm 2 3 0 5)"))


def test_a_screen_has_a_name_without_any() -> None:
    names = yarpy.LocalNames()
    opened = wrapper.FrameWriter(Property(), names=names)
    opened.attach({"...": devices.SimulatedFrameWriter()})
    assert names.query("/writer") is not None
    opened.close()


def test_servers_of_one_class_are_told_by_their_type() -> None:
    names = yarpy.LocalNames()
    for kind, device, port in (
        ("odometry2D_nws_yarp", devices.SimulatedBase(), "/y/rpc"),
        ("JoypadControlServer", devices.SimulatedJoypad(), "/y/rpc:i"),
        ("map2D_nws_yarp", devices.MapStorage(), "/y/rpc"),
    ):
        name = "/y/rpc" if kind == "map2D_nws_yarp" else "/y"
        opened = wrapper.Served(Property(device=kind, name=name), names=names)
        opened.attach({"...": device})
        assert names.query(port) is not None, kind
        opened.detach()
        assert names.query(port) is None, kind
    with pytest.raises(LookupError):
        wrapper.Served(Property(device="none_nws_yarp", name="/y"), names=names)


def test_the_server_that_a_device_wants() -> None:
    assert wrapper.server_of(Joints()) == "controlBoard_nws_yarp"
    assert wrapper.server_of(Laser()) == "rangefinder2D_nws_yarp"
    assert wrapper.server_of(Camera()) == "frameGrabber_nws_yarp"
    assert wrapper.server_of(Battery()) == "battery_nws_yarp"
    assert wrapper.server_of(Sensor()) == "multipleanalogsensorsserver"
    assert wrapper.server_of(devices.SimulatedAnalogSensor()) == "analogServer"
    assert wrapper.server_of(devices.SimulatedFrameWriter()) == "frameWriter_nws_yarp"
    assert wrapper.server_of(devices.SimulatedJoypad()) == "JoypadControl_nws_yarp"
    # It localizes, navigates and measures: its type says what for.
    base = devices.SimulatedBase()
    assert wrapper.server_of(base, "fakeLocalizer") == "localization2D_nws_yarp"
    assert wrapper.server_of(base, "fakeOdometry2D") == "odometry2D_nws_yarp"
    assert wrapper.server_of(object()) == ""
