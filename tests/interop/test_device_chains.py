"""Sensors, cameras and sounds between yarpy and C++, both ways in one chain each.

our server -> client of C++ -> server of C++ -> our client
"""

from __future__ import annotations

import numpy as np
import pytest
from support.cpp import CppYarp
from support.cpp_device import MOTORS, PATIENT, between, cpp_device, device_host
from support.wait import HANG, wait_until

import yarpy
from yarpy.kits import devices
from yarpy.kits.devices.analog.virtual import PARTS, Network
from yarpy.kits.devices.interfaces.joypad import Point, Touch

pytestmark = pytest.mark.peer("g++")


def test_channels(network: CppYarp) -> None:
    device_host(network)
    sensor = Still()
    inner = {"inner": "analogsensorclient", "carrier": "tcp", "period": 10}
    with (
        devices.AnalogSensorServer("/ours", sensor, 0.01),
        between(network, "analogServer", PATIENT, **inner),
        devices.AnalogSensor("/cpp", timeout=HANG) as client,
    ):
        wait_until(lambda: client.channels() == [1.5, -2.0])
        client.calibrate()
        client.calibrate([3.0, 4.0])
        client.calibrate_channel(1, 0.5)
        client.calibrate_channel(0)
        assert sensor.done == [None, [3.0, 4.0], (1, 0.5), (0, None)]


class Still:
    def __init__(self) -> None:
        self.done: list[object] = []

    def channels(self) -> list[float]:
        return [1.5, -2.0]

    def calibrate(self, values: object) -> None:
        self.done.append(values)

    def calibrate_channel(self, channel: int, value: float | None) -> None:
        self.done.append((channel, value))


def test_a_battery(network: CppYarp) -> None:
    device_host(network)
    with (
        devices.BatteryServer("/ours", Pack(), 0.02),
        between(network, "batteryWrapper", "batteryClient", period=0.02),
        devices.Battery("/cpp", timeout=HANG) as client,
    ):
        wait_until(lambda: client.charge() == 80.5)
        assert client.voltage() == 24.5 and client.current() == 1.5
        assert client.temperature() == 20.0 and client.status() == "charging"
        assert client.info == "24 V"


class Pack:
    info = "24 V"

    def charge(self) -> float:
        return 80.5

    def voltage(self) -> float:
        return 24.5

    def current(self) -> float:
        return 1.5

    def temperature(self) -> float:
        return 20.0

    def status(self) -> str:
        return "charging"


def test_a_laser(network: CppYarp) -> None:
    device_host(network)
    laser = devices.SimulatedLaser("use_constant", distance=0.5, step=30.0)
    with (
        devices.LaserServer("/ours", laser, 0.02),
        between(network, "rangefinder2D_nws_yarp", "Rangefinder2DClient", period=0.02),
        devices.Laser("/cpp", timeout=HANG) as client,
    ):
        wait_until(lambda: [*client.scan().ranges] == [0.5] * 12)
        assert client.angles == (0.0, 360.0) and client.distances == (0.1, 3.5)
        client.distances = (1.0, 3.0)  # in between they are whole numbers
        assert laser.distances == (1.0, 3.0)


def test_a_camera_with_distances(network: CppYarp) -> None:
    device_host(network)
    camera = devices.SimulatedDepthCamera(32, 16)
    remote = {
        "localImagePort": "/between/colour",
        "localDepthPort": "/between/depth",
        "localRpcPort": "/between/rpc",
        "remoteImagePort": "/ours/rgbImage:o",
        "remoteDepthPort": "/ours/depthImage:o",
        "remoteRpcPort": "/ours/rpc:i",
    }
    with (
        devices.DepthCamera.serve("/ours", camera),
        between(network, "rgbdSensor_nws_yarp", "RGBDSensorClient", period=0.03, **remote),
        devices.DepthCamera.connect("/cpp") as client,
    ):
        colour, depth = client.colour(), client.depth()
        assert (colour.width, colour.height) == (32, 16) == (depth.width, depth.height)
        assert np.isfinite(depth.array).any()
        assert client.clip_planes() == camera.clip_planes()


@pytest.mark.parametrize("together", [False, True], ids=["each", "together"])
def test_a_joypad(network: CppYarp, together: bool) -> None:
    """`together`: over the one port for all. Without sticks beside YARP 3: its client reads beyond
    its memory for one that it has not heard of yet."""
    device_host(network)
    pad = devices.SimulatedJoypad()
    options: dict[str, object] = {"inner": "JoypadControlClient"}
    if network.version < (4, 0):
        if together:
            pytest.skip("the client of C++ YARP 3 listens to a port for each")
        pad.state.sticks.clear()
        options |= {"period": 10, "use_separate_ports": 1}  # ms
    else:
        options |= {"period": 0.01, "use_all_port": str(together).lower()}  # s
    with (
        devices.Joypad.serve("/ours", pad),
        between(network, "JoypadControlServer", PATIENT, **options),
        devices.Joypad.connect("/cpp") as client,
    ):
        assert client.button_count() == pad.button_count()
        assert client.axis_count() == pad.axis_count()
        pad.state.hats, pad.state.touches = [4], [Touch([Point(0.5, -0.5)])]
        wait_until(lambda: client.hats().value == [4])
        wait_until(lambda: client.touches().value == [Touch([Point(0.5, -0.5)])])
        if pad.state.sticks:
            pad.state.sticks[1] = Point(0.25, -0.75)
            wait_until(lambda: client.sticks().value == [Point(), Point(0.25, -0.75)])


def test_torques_that_cpp_estimates(network: CppYarp) -> None:
    """For what is called virtualAnalogServer there."""
    told: list[list[float]] = []

    class Motors:
        def update_measures(self, values: list[float]) -> None:
            told.append([*values])

    networks = {"arm": Network(0, 5, 0, 5)}
    with (
        devices.VirtualAnalogServer("/ours", {"arm": Motors()}, networks),
        network.popen("write", "/tool/cpp", "/ours") as writer,
    ):
        writer.wait_line("Port /tool/cpp active")
        yarpy.wait_for("/tool/cpp", timeout=HANG)
        wait_until(lambda: yarpy.is_connected("/tool/cpp", "/ours"))
        writer.write_line("1 0.5 1.5 2.5 3.5 4.5")
        wait_until(lambda: [0.5, 1.5, 2.5, 3.5, 4.5, 0.0] in told)


@pytest.mark.parametrize("part", PARTS)
def test_torques_for_motors_of_cpp(network: CppYarp, part: int) -> None:
    """Its server gives on what ours would, and zeros as soon as nothing comes any more."""
    device_host(network)
    places = PARTS[part]
    torques = [1.5 + place for place in range(7)]  # place 0 is that of the part
    channels = f"(0 {len(places) - 1} 0 {len(places) - 1})"
    given = {"outer": "virtualAnalogServer", "attach": MOTORS, "name": "/cpp"}
    given |= {"networks": "(inner)", "inner": channels, "robotName": "robot"}
    with (
        cpp_device(network, "attached", **given) as motors,
        yarpy.BufferedPort("/torques:o") as port,
    ):
        port.connect("/cpp")
        port.write([part, *torques])
        told = (0 if place is None else torques[place - 1] for place in places)
        motors.wait_line("^told " + " ".join(f"{torque:g}" for torque in told) + "$", stream="out")
        motors.wait_line("^told" + " 0" * len(places) + "$", stream="out")
