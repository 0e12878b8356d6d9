"""Joints of several boards as one, between yarpy and C++, both ways in one chain.

remap_remote (yarpy) -> controlBoard_nws_yarp -> remotecontrolboardremapper -> two boards of ours
"""

import pytest
from support.cpp import CppYarp
from support.cpp_device import cpp_device, device_host
from support.wait import HANG, wait_until

from yarpy.kits.devices import ControlBoardServer, SimulatedJoints
from yarpy.kits.devices.control_board.remap import remap_remote


@pytest.mark.peer("g++")
def test_chain(network: CppYarp) -> None:
    device_host(network)
    torso, head = SimulatedJoints(["yaw", "roll"]), SimulatedJoints(["neck", "eyes"])
    with (
        ControlBoardServer("/torso", torso, 0.005),
        ControlBoardServer("/head", head, 0.005),
        cpp_device(
            network,
            "controlBoard_nws_yarp",
            subdevice="remotecontrolboardremapper",
            remoteControlBoards="(/torso /head)",
            axesNames="(eyes yaw neck)",
            localPortPrefix="/between",
            name="/cpp",
            period=0.005,
        ) as process,
    ):
        assert "not available" not in process.stdout
        with remap_remote(["/cpp"], ["yaw", "eyes"]) as board:
            assert board.axis_names == ["yaw", "eyes"]
            board.position_move(["yaw", "eyes"], [5.0, 6.0])
            wait_until(lambda: (torso.encoders(), head.encoders()) == ([5.0, 0.0], [0.0, 6.0]))
            wait_until(lambda: board.encoders() == [5.0, 6.0], HANG)
            board.reference_speeds = [20.0, 30.0]
            wait_until(lambda: torso.reference_speeds[0] == 20.0)
            assert head.reference_speeds[1] == 30.0
