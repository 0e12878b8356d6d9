"""One device with its server."""

import pytest

import yarpy
from yarpy.kits.devices.wrapper import server_of
from yarpy.kits.launch.robot.standalone import StandaloneDevice, types
from yarpy.registry import devices


class Arm:
    axis_names = ("elbow",)

    def __init__(self, log: list[str], options: yarpy.Property) -> None:
        self.log = log
        self.options = options

    def encoders(self) -> list[float]:
        return [12.5]

    def close(self) -> None:
        self.log.append("closed")


class Fixture:
    def __init__(self) -> None:
        self.log: list[str] = []
        self.names = yarpy.LocalNames()

    def plugins(self, kind: str):
        if kind == "arm":
            return lambda options, *, names=None: Arm(self.log, options)
        return devices.load(kind)

    def open(self, **options: object) -> StandaloneDevice:
        return StandaloneDevice(
            yarpy.Property(**options), self.plugins, server_of, names=self.names
        )


def test_a_device_gets_the_server_of_its_kind() -> None:
    fixture = Fixture()
    with fixture.open(device="arm") as one:
        assert (one.device, one.server) == ("arm", "controlBoard_nws_yarp")
        assert one.name == "/controlBoard_nws_yarp"
        assert fixture.names.query(f"{one.name}/state:o") is not None
    assert fixture.names.query(f"{one.name}/state:o") is None
    assert fixture.log == ["closed"]
    with fixture.open(device="fakeFrameGrabber", width=64) as one:
        assert one.name == "/grabber"
        with yarpy.devices.FrameGrabber("/grabber", names=fixture.names) as camera:
            assert camera.image(20).array.shape == (240, 64, 3)


@pytest.mark.parametrize(
    "words",
    [
        {"device": "controlBoard_nws_yarp", "subdevice": "arm"},
        {
            "device": "deviceBundler",
            "wrapper_device": "controlBoard_nws_yarp",
            "attached_device": "arm",
        },
    ],
)
def test_a_server_serves_its_subdevice(words: dict[str, str]) -> None:
    fixture = Fixture()
    with fixture.open(**words, name="/arm", period=0.05) as one:
        assert one.name == "/arm"
        with yarpy.RpcClient("/arm/rpc:i", names=fixture.names) as client:
            assert client.call(["get", "encs"])[2] == [12.5]
    assert fixture.log == ["closed"]


def test_a_client_and_what_serves_itself_are_left_alone() -> None:
    fixture = Fixture()
    with (
        fixture.open(device="arm", name="/arm"),
        fixture.open(device="remote_controlboard", remote="/arm", local="/me") as one,
    ):
        assert (one.server, one.name) == ("", "/remote_controlboard")
        # With a name of its own it passes the board on.
        with fixture.open(device="remote_controlboard", remote="/arm", name="/again") as again:
            assert again.server == "controlBoard_nws_yarp"
            with yarpy.RpcClient("/again/rpc:i", names=fixture.names) as client:
                assert client.call(["get", "axes"])[2] == 1
    with fixture.open(device="frameTransformServer") as one:
        assert one.server == ""


def test_nothing_stays_open_when_it_fails() -> None:
    fixture = Fixture()
    with pytest.raises(ValueError, match="is no time"):
        fixture.open(device="arm", period=-1)
    assert fixture.log == ["closed"]
    with pytest.raises(yarpy.LocalProtocolError, match="--subdevice"):
        fixture.open(device="controlBoard_nws_yarp", name="/x")
    with pytest.raises(yarpy.LocalProtocolError, match="fakeBattery serves no other device"):
        fixture.open(device="fakeBattery", subdevice="arm")
    assert fixture.log == ["closed", "closed"]
    with pytest.raises(yarpy.UnknownPlugin):
        fixture.open(device="nothing")


def test_the_two_spellings_of_a_bundle() -> None:
    assert types(yarpy.Property(device="a")) == ("", "a")
    assert types(yarpy.Property(device="a", subdevice="b")) == ("a", "b")
    bundle = yarpy.Property(device="deviceBundler", wrapper_device="a", attached_device="b")
    assert types(bundle) == ("a", "b")
    with pytest.raises(yarpy.LocalProtocolError, match="--attached_device"):
        types(yarpy.Property(device="deviceBundler", wrapper_device="a"))
