"""Cameras between yarpy and C++: our server behind the client of C++, our client before its server.

FrameGrabber (yarpy) -> frameGrabber_nws_yarp -> frameGrabber_nwc_yarp -> FrameGrabberServer
"""

import pytest
from support.camera import FakeCamera
from support.cpp import CppYarp
from support.cpp_device import cpp_device, device_host
from support.peer import brings
from support.wait import HANG, wait_until

from yarpy.errors import LocalProtocolError
from yarpy.kits.devices import FrameGrabber, FrameGrabberServer


@pytest.fixture(autouse=True)
@brings("g++")
def devices(network: CppYarp) -> None:
    device_host(network)


def test_chain(network: CppYarp) -> None:
    camera = FakeCamera()
    with (
        FrameGrabberServer("/ours", camera, 0.01),
        cpp_device(
            network,
            "frameGrabber_nws_yarp",
            subdevice="frameGrabber_nwc_yarp",
            remote="/ours",
            local="/between",
            name="/cpp",
            period=0.01,
        ),
        FrameGrabber("/cpp") as eye,
    ):
        wait_until(lambda: eye.image(HANG).width == 64)
        image = eye.image(HANG)
        assert image.code == "rgb" and image.array.shape == (48, 64, 3)
        assert image.array[:, -1].min() == 255
        wait_until(lambda: eye.image(HANG).array[0, 0, 0] != image.array[0, 0, 0])
        part = eye.crop(60, 0, 63, 9)
        assert part.array.shape == (10, 4, 3) and part.array[:, -1].min() == 255
        assert eye.resolution == (64, 48)
        assert eye.field_of_view == (1.0, 2.0)
        eye.field_of_view = (60.0, 45.0)
        assert camera.field_of_view == (60.0, 45.0)
        assert eye.resolutions == [(128, 128, 60.0, "rgb"), (256, 256, 30.0, "bgr")]
        assert eye.intrinsics["distortionModel"] == "FishEye"
        eye.mirror = True
        assert camera.mirror is True and eye.mirror is True
        assert eye.description == ("usb", "a fake")
        assert eye.features["brightness"] == 0.5
        eye.features["brightness"] = 0.75
        eye.features["white_balance"] = (1.0, 2.0)
        assert camera.features == {"brightness": 0.75, "white_balance": (1.0, 2.0)}
        assert eye.feature_switches["trigger"] is True
        eye.feature_modes["gain"] = "manual"
        assert camera.feature_modes == {"gain": "manual"}
        eye.one_push("gain")
        assert camera.pushed == ["gain"]


def test_camera_of_cpp(network: CppYarp) -> None:
    with (
        cpp_device(
            network,
            "frameGrabber_nws_yarp",
            subdevice="fakeFrameGrabber",
            name="/cpp",
            width=32,
            height=16,
            period=0.01,
        ),
        FrameGrabber("/cpp", carrier="fast_tcp") as eye,
    ):
        image = eye.image(HANG)
        assert (image.width, image.height, image.code) == (32, 16, "rgb")
        assert eye.stamp.valid and eye.timestamp() > 1e9
        assert eye.resolution == (32, 16)
        assert eye.crop(0, 0, 3, 1).array.shape == (2, 4, 3)
        assert "brightness" not in eye.features  # the fake has no knobs
        with pytest.raises(LocalProtocolError):
            eye.crop(0, 0, 99, 99)


class Firewire:
    """The registers of a camera at FireWire that C++ can be told and asked of."""

    video_modes, video_mode, frame_rates, frame_rate = 0x80000021, 69, 6, 34
    iso_speed, color_coding, bytes_per_packet = 2, 352, 1024
    window, largest_window = (320, 240, 0, 0), (640, 480, 2, 2, 4, 4)
    beta_mode, transmission = False, True

    def __init__(self) -> None:
        self.done: list[object] = []

    def switch_power(self, on: bool) -> None:
        self.done.append(on)

    def reset(self) -> None:
        self.done.append("reset")


def test_registers_of_firewire(network: CppYarp) -> None:
    camera, registers = FakeCamera(), Firewire()
    camera.firewire = registers  # type: ignore[attr-defined]
    options = {"remote": "/ours", "local": "/between", "name": "/cpp", "period": 0.01}
    with (
        FrameGrabberServer("/ours", camera, 0.01),
        cpp_device(network, "frameGrabber_nws_yarp", subdevice="frameGrabber_nwc_yarp", **options),
        FrameGrabber("/cpp") as eye,
    ):
        there = eye.firewire
        for name in vars(Firewire):
            if not (name.startswith("_") or callable(getattr(Firewire, name))):
                assert getattr(there, name) == getattr(registers, name), name
        there.switch_power(True)
        there.reset()
        assert registers.done == [True, "reset"]
        if network.version < (4, 0):
            return  # its server takes its own word for the value of whatever is set
        there.video_mode, there.iso_speed, there.window = 70, 3, (1, 2, 3, 4)
        there.transmission = False
        assert (registers.video_mode, registers.iso_speed) == (70, 3)
        assert (registers.window, registers.transmission) == ((1, 2, 3, 4), False)
