import time

import pytest
from support.board import Bare, FakeBoard

from yarpy.kits.devices.control_board.board import Board
from yarpy.kits.devices.kind import JOINT_TYPE, PAIR
from yarpy.kits.devices.refusal import Refused


def board(device):
    return Board(device, "/head")


def test_measurements_and_attributes():
    it = board(FakeBoard())
    assert it.count == 3
    assert it.values("encoders") == [0.0, 0.0, 0.0]
    assert it.values("position_limits", PAIR)[1] == (-31.0, 30.0)
    assert it.timestamps() == [0.0, 0.0, 0.0]
    assert it.values("axis_types", JOINT_TYPE) == ["revolute", "revolute", "prismatic"]


def test_the_least():
    it = board(Bare())
    assert it.values("encoders") == [1.5, -2.0]
    assert it.values("axis_types", JOINT_TYPE) == ["revolute", "revolute"]
    assert abs(it.timestamps()[0] - time.time()) < 60
    for member in ("torques", "reference_speeds", "position_targets"):
        with pytest.raises(Refused, match=f"has no {member}"):
            it.values(member)
    with pytest.raises(Refused, match="has no position_move"):
        it.apply("position_move", [0], [1.0])
    with pytest.raises(Refused, match="has no pids"):
        it.pid("pos")


@pytest.mark.parametrize("names", [[], "", "head", None])
def test_a_board_has_joints(names):
    class Empty(Bare):
        axis_names = names

    with pytest.raises(ValueError, match="axis_names"):
        board(Empty())


def test_a_device_without_names():
    with pytest.raises(ValueError, match="axis_names"):
        board(object())


def test_commands_are_remembered():
    device = FakeBoard()
    device.where = [1.0, 2.0, 3.0]
    it = board(device)
    assert it.values("position_targets") == [1.0, 2.0, 3.0]
    assert it.values("velocity_targets") == [0.0, 0.0, 0.0]
    it.apply("position_move", [1], [9.0])
    it.apply("velocity_move", [0, 2], [4.0, 5.0])
    assert it.values("position_targets") == [1.0, 9.0, 3.0]
    assert it.values("velocity_targets") == [4.0, 0.0, 5.0]
    it.apply("stop", [2], None)
    assert it.values("velocity_targets") == [4.0, 0.0, 0.0]
    it.apply("relative_move", [1, 2], [-1.0, 1.0])
    assert device.done[-1] == ("position_move", [1, 2], [8.0, 4.0])


def test_targets_of_the_device_itself_count():
    class Knowing(FakeBoard):
        def position_targets(self):
            return [7.0] * self.count

        def relative_move(self, joints, distances):
            self.note("relative_move", joints, distances)

    device = Knowing()
    it = board(device)
    it.apply("relative_move", [0], [2.0])
    assert device.done == [("relative_move", [0], [2.0])]
    assert it.values("position_targets") == [7.0, 7.0, 7.0]


def test_relative_move_of_the_device_is_remembered_too():
    class Moving(FakeBoard):
        def relative_move(self, joints, distances):
            self.note("relative_move", joints, distances)

    it = board(Moving())
    it.apply("relative_move", [2], [2.0])
    assert it.values("position_targets") == [0.0, 0.0, 2.0]
    with pytest.raises(Refused):
        it.apply("relative_move", [5], [2.0])


def test_controllers():
    device = FakeBoard()
    pids = board(device).pid("vel")
    assert pids.values("targets") == [0.0, 0.0, 0.0]
    pids.apply("targets", [1], [3.0])
    pids.apply("reset", [2], None)
    assert device.pids["vel"].targets == [0.0, 3.0, 0.0]
    assert device.pids["vel"].was_reset == [2]
    with pytest.raises(Refused, match="no bogu controllers"):
        board(device).pid("bogu")


def test_a_device_without_encoders():
    class Blind:
        axis_names = ("left",)

    with pytest.raises(ValueError, match="encoders"):
        board(Blind())
