"""Devices that only YARP 4 has, and what only its boards can: beside C++ 4.0 where it is named.

our client -> nws of C++ -> nwc of C++ -> our server
"""

from __future__ import annotations

import numpy as np
import pytest
from support.board import FakeBoard
from support.cpp import CppYarp
from support.cpp_device import between, cpp_device, device_host
from support.wait import HANG, wait_until

import yarpy
from yarpy.kits import devices
from yarpy.kits.devices.interfaces.world import Colour, Pose

pytestmark = pytest.mark.peer("g++")


@pytest.fixture
def latest(network: CppYarp) -> CppYarp:
    """C++ YARP 4.0, with devices."""
    if network.version < (4, 0):
        pytest.skip("needs C++ YARP 4.0: YARPY_CPP_YARP says where it is")
    device_host(network)
    return network


def test_a_world(latest: CppYarp) -> None:
    world = devices.SimulatedWorld()
    with (
        devices.World.serve("/ours", world),
        between(latest, "simulatedWorld_nws_yarp", "simulatedWorld_nwc_yarp"),
        devices.World.connect("/cpp") as client,
    ):
        client.make_box("box", 0.5, 0.25, 0.125, Pose(1.0, 2.0, 3.0), Colour(255, 0, 1))
        client.make_sphere("ball", 0.5, Pose(), Colour())
        assert client.objects() == world.objects() == ["box", "ball"]
        client.place("ball", Pose(0.5, 0.0, 0.0, 0.25, 0.5, 0.75))
        assert client.pose("ball") == world.pose("ball") == Pose(0.5, 0.0, 0.0, 0.25, 0.5, 0.75)
        client.rename("ball", "sun")
        client.delete("box")
        assert client.objects() == ["sun"]
        with pytest.raises(yarpy.LocalProtocolError, match='"/cpp" refuses pose'):
            client.pose("box")
        client.clear()
        assert world.objects() == []


def test_odometry(latest: CppYarp) -> None:
    base = devices.SimulatedBase("kitchen")
    base.apply_velocity(1.0, 0.0, 0.0, 60.0)
    with (
        devices.Odometry2D.serve("/ours", base, 0.01),
        between(latest, "odometry2D_nws_yarp", "odometry2D_nwc_yarp", period=0.01),
        devices.Odometry2D.connect("/cpp") as client,
    ):
        wait_until(lambda: client.odometry().odom_x > 0.05)
        base.apply_velocity(0.0, 0.0, 0.0, 60.0)
        client.reset_odometry()
        wait_until(lambda: client.odometry().odom_x == base.odometry().odom_x)


def test_a_screen_of_cpp(latest: CppYarp) -> None:
    with (
        cpp_device(
            latest, "frameWriter_nws_yarp", subdevice="fakeFrameWriter", name="/cpp"
        ) as host,
        yarpy.BufferedPort("/picture") as port,
    ):
        port.connect("/cpp")
        port.write(yarpy.Image(np.zeros((4, 8, 3), "uint8")))
        host.wait_line("Frame received: 8 4", timeout=HANG)


def test_a_screen_of_ours(latest: CppYarp) -> None:
    screen = devices.SimulatedFrameWriter()
    eye = {"subdevice": "fakeFrameGrabber", "name": "/cpp", "width": 32, "height": 16}
    with (
        devices.FrameWriterServer("/ours", screen),
        cpp_device(latest, "frameGrabber_nws_yarp", **eye),
    ):
        yarpy.connect("/cpp", "/ours")
        wait_until(lambda: screen.last is not None)


def test_brakes_and_direct_velocities(latest: CppYarp) -> None:
    device = FakeBoard(3)
    with (
        devices.ControlBoardServer("/ours", device, 0.01),
        between(
            latest, "controlBoard_nws_yarp", "controlBoard_nwc_yarp", period=0.01, name="/board"
        ),
        devices.ControlBoard("/board", timeout=HANG) as board,
    ):
        assert board.braked() == [False, True, False]
        board.apply_brakes([0, 2], [True, False])
        board.automatic_brakes = [True, False, True]
        assert [*device.automatic_brakes] == [True, False, True] == [*board.automatic_brakes]
        board.velocity_direct(range(3), [1.0, 2.0, 3.0])
        wait_until(lambda: ("velocity_direct", [0, 1, 2], [1.0, 2.0, 3.0]) in device.done)


def test_a_board_of_cpp(latest: CppYarp) -> None:
    options = {"subdevice": "fakeMotionControl", "GENERAL::Joints": 4, "name": "/motors"}
    with (
        cpp_device(latest, "controlBoard_nws_yarp", period=0.01, **options),
        devices.ControlBoard("/motors", timeout=HANG) as board,
    ):
        assert board.axes == 4
        board.position_move([1, 3], [5.0, 6.0])
        wait_until(lambda: board.encoders() == [0.0, 5.0, 0.0, 6.0])
        board.switch_control_modes([2], ["vel"])
        wait_until(lambda: board.control_modes() == ["pos", "pos", "vel", "pos"])
        assert board.position_targets()[1] == 5.0
        board.reference_speeds = [1.0, 2.0, 3.0, 4.0]
        assert board.reference_speeds == (1.0, 2.0, 3.0, 4.0)
        board.pids["pos"].targets = (1.0, 2.0, 3.0, 4.0)
