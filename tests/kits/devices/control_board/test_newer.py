"""Brakes, and velocities at once: what only YARP 4 has."""

import pytest
from support.wait import HANG, wait_until

import yarpy
from yarpy.kits.devices.control_board.client import ControlBoard
from yarpy.kits.devices.control_board.newer import Second
from yarpy.kits.devices.control_board.remap import remap
from yarpy.kits.devices.control_board.server import ControlBoardServer
from yarpy.kits.devices.simulated.joints import SimulatedJoints


class Older:
    newer = False
    axes = 2


class Newer:
    newer = True
    axes = 2


def test_they_go_over_a_connection_of_their_own_where_words_are_of_yarp_3() -> None:
    names = yarpy.LocalNames()
    joints = SimulatedJoints(["yaw", "roll"])
    with (
        ControlBoardServer("/arm", joints, names=names),
        ControlBoard("/arm", "/me", timeout=HANG, names=names) as arm,
    ):
        assert names.query("/me/nwc/rpc:o") is None
        assert arm.braked() == [False, False]
        assert names.query("/me/nwc/rpc:o") is not None
        arm.apply_brakes("roll", True)
        assert arm.braked() == [False, True]
        arm.position_move([0, 1], [5.0, 5.0])
        assert joints.encoders() == [5.0, 0.0]
        arm.apply_brakes([0, 1], [True, False])
        assert joints.braked() == [True, False]
        arm.automatic_brakes = [False, True]
        assert arm.automatic_brakes == (False, True) and joints.automatic_brakes == [False, True]
        arm.velocity_direct(1, 3.0)
        wait_until(lambda: arm.direct_velocity_targets() == [0.0, 3.0])
        with pytest.raises(ValueError, match="1 values for 2 joints"):
            arm.apply_brakes([0, 1], [True])
        with pytest.raises(ValueError, match="3 values for 2 joints"):
            arm.automatic_brakes = [True] * 3
    assert names.query("/me/nwc/rpc:o") is None


def test_a_board_of_yarp_3_has_none() -> None:
    with (
        Second(Older(), "/old", "/me", yarpy.LocalNames()) as second,  # type: ignore[arg-type]
        pytest.raises(yarpy.LocalProtocolError, match='"/old" is a board of YARP 3: brakes and'),
    ):
        second.asks()


def test_a_board_of_yarp_4_is_asked_as_always() -> None:
    first = Newer()
    with Second(first, "/new", "/me", None) as second:  # type: ignore[arg-type]
        assert second.asks() is first


def test_joints_of_several_boards_have_brakes() -> None:
    left, right = SimulatedJoints(["left"]), SimulatedJoints(["right"])
    both = remap([left, right], ["right", "left"])
    both.apply_brakes("right", [True])
    assert both.braked() == [True, False] and right.braked() == [True]
