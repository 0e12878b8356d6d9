"""The control board of a body: what its clients can ask and tell."""

import pytest

from yarpy.kits.devices.control_board.interface import ControlMode
from yarpy.kits.sim.board import Board
from yarpy.kits.sim.body import Body
from yarpy.kits.sim.icub import ICUB_HEAD
from yarpy.kits.sim.joint import Joint


class Clock:
    now = 50.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def board(clock: Clock) -> Board:
    return Board(Body([Joint(axis) for axis in ICUB_HEAD], clock))


def test_moving_to_positions(board: Board, clock: Clock):
    assert board.encoders() == [0.0] * 6
    board.position_move([1, 2], [45.0, -10.0])
    assert board.motion_done() == [True, False, False, True, True, True]
    assert board.position_targets() == [0.0, 45.0, -10.0, 0.0, 0.0, 0.0]
    clock.now += 0.3
    assert board.encoder_speeds()[1] > 50
    assert board.encoder_accelerations()[1] != 0
    assert board.motor_encoders() == board.encoders()
    assert board.motor_speeds() == board.encoder_speeds()
    assert board.motor_accelerations() == board.encoder_accelerations()
    assert board.timestamps() == [clock.now] * 6
    clock.now += 2.0
    assert board.encoders() == [0.0, 45.0, -10.0, 0.0, 0.0, 0.0]
    assert all(board.motion_done())
    board.relative_move([1], [-5.0])
    clock.now += 2.0
    assert board.encoders()[1] == 40.0
    board.home(range(6))
    clock.now += 2.0
    assert board.encoders() == [0.0] * 6


def test_speeds_and_stop(board: Board, clock: Clock):
    board.switch_control_modes([2], [ControlMode.VELOCITY])
    board.velocity_move([2], [20.0])
    assert board.velocity_targets()[2] == 20.0
    clock.now += 1.0
    assert 18 < board.encoders()[2] < 21
    board.stop([2])
    clock.now += 1.0
    assert board.encoder_speeds() == [0.0] * 6


def test_what_controllers_follow(board: Board, clock: Clock):
    """In reference mode iCub's Cartesian controller lives on it."""
    position, speed = board.pids["pos"], board.pids["vel"]
    board.position_move([1], [45.0])
    clock.now += 0.3
    before = position.targets[1]
    assert 1.0 < before < 45.0 and speed.targets[1] > 50
    there = board.encoders()[1] + position.errors()[1]
    assert there == pytest.approx(before) and abs(position.errors()[1]) < 1.0
    assert board.encoder_speeds()[1] + speed.errors()[1] == pytest.approx(speed.targets[1])
    assert position.outputs() == board.encoder_accelerations()
    clock.now += 2.0
    assert position.targets[1] == 45.0 and position.errors() == [0.0] * 6


def test_direct_positions(board: Board, clock: Clock):
    board.switch_control_modes([3, 4], ["posd", "posd"])
    board.position_direct([3, 4], [5.0, -5.0])
    clock.now += 0.5
    assert board.encoders() == pytest.approx([0, 0, 0, 5.0, -5.0, 0], abs=1e-3)
    assert board.direct_targets()[3:5] == [5.0, -5.0]


def test_modes(board: Board):
    assert board.control_modes() == ["pos"] * 6
    assert board.interaction_modes() == ["stif"] * 6
    with pytest.raises(ValueError, match="neck_pitch is in mode pos"):
        board.velocity_move([0], [1.0])
    with pytest.raises(ValueError, match="no mode torq"):
        board.switch_control_modes([0], ["torq"])
    with pytest.raises(ValueError, match="nonsense"):
        board.switch_control_modes([0], ["nonsense"])


def test_adjusting(board: Board, clock: Clock):
    board.reference_speeds = [10.0] * 6
    board.reference_accelerations = [500.0] * 6
    board.position_limits = [(-5.0, 5.0)] * 6
    assert board.reference_speeds == [10.0] * 6
    assert board.reference_accelerations == [500.0] * 6
    assert board.position_limits == [(-5.0, 5.0)] * 6
    assert board.velocity_limits[0] == (-300.0, 300.0)
    board.position_move([0], [30.0])
    clock.now += 0.4
    assert 0 < board.encoders()[0] < 4
    clock.now += 3.0
    assert board.encoders()[0] == 5.0
    with pytest.raises(ValueError, match="from 2 to 1"):
        board.position_limits = [(2, 1)] * 6


def test_names_and_types(board: Board):
    assert board.axis_names[1] == "neck_roll"
    assert board.axis_types == ["revolute"] * 6
