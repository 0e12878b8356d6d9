"""Joints of several boards as one."""

from types import SimpleNamespace
from typing import Any

import pytest
from support.wait import HANG

from yarpy.kits.devices import ControlBoard, ControlBoardServer
from yarpy.kits.devices.control_board.remap import remap, remap_remote
from yarpy.nameserver.local import LocalNames


class Part:
    """Joints whose positions are their numbers, and which remember what they are told."""

    def __init__(self, *axis_names: str) -> None:
        self.axis_names = [*axis_names]
        self.reference_speeds = [10.0 + joint for joint in range(len(axis_names))]
        self.told: list[tuple[Any, ...]] = []
        pids = SimpleNamespace(targets=[1.0] * len(axis_names), reset=self._reset)
        self.pids = {"pos": pids, axis_names[0]: pids}

    def encoders(self) -> list[float]:
        return [float(joint) for joint in range(len(self.axis_names))]

    def position_move(self, joints: list[int], positions: list[float]) -> None:
        self.told.append(("move", joints, positions))

    def stop(self, joints: list[int]) -> None:
        self.told.append(("stop", joints))

    def calibration_done(self, joint: int) -> bool:
        return joint == 1

    def _reset(self, joints: list[int]) -> None:
        self.told.append(("reset", joints))


class Torso(Part):
    def torques(self) -> list[float]:
        return [1.0] * 3


def test_members() -> None:
    torso, head = Torso("yaw", "roll", "pitch"), Part("neck", "eyes")
    board = remap([torso, head], ["eyes", "pitch", "yaw"])
    assert board.axis_names == ["eyes", "pitch", "yaw"] and "eyes" in repr(board)
    assert board.encoders() == [1.0, 2.0, 0.0]
    board.position_move([0, 1, 2], [5.0, 6.0, 7.0])
    assert head.told == [("move", [1], [5.0])]
    assert torso.told == [("move", [2, 0], [6.0, 7.0])]
    board.position_move("pitch", 8.0)
    board.stop()
    assert torso.told[1:] == [("move", [2], [8.0]), ("stop", [2, 0])]
    assert head.told[1:] == [("stop", [1])]
    assert board.reference_speeds == (11.0, 12.0, 10.0)
    board.reference_speeds = [1.0, 2.0, 3.0]
    assert torso.reference_speeds == [3.0, 11.0, 2.0] and head.reference_speeds == [10.0, 1.0]
    assert board.calibration_done("eyes") and not board.calibration_done("yaw")
    assert not hasattr(board, "torques") and hasattr(remap([torso], ["yaw"]), "torques")
    assert [*board.pids] == ["pos"] and board.pids["pos"].targets == (1.0, 1.0, 1.0)
    board.pids["pos"].reset([0])
    assert head.told[-1] == ("reset", [1])


def test_what_cannot_be() -> None:
    part = Part("a", "b")
    with pytest.raises(ValueError, match="no board has the joints c; there are a, b"):
        remap([part], ["a", "c"])
    with pytest.raises(ValueError, match="two boards"):
        remap([part, Part("a")], ["a"])
    with pytest.raises(ValueError, match="named twice"):
        remap([part], ["a", "a"])
    with pytest.raises(ValueError, match="no board has"):
        remap([part], [])
    with pytest.raises(ValueError, match="names of the boards"):
        remap_remote([], ["a"])
    board = remap([part], ["a"])
    with pytest.raises(LookupError, match='no joint "x"'):
        board.position_move("x", 1.0)
    with pytest.raises(IndexError, match="no joint 1"):
        board.position_move(1, 1.0)
    with pytest.raises(ValueError, match="2 values for 1"):
        board.position_move([0], [1.0, 2.0])
    with pytest.raises(ValueError, match="2 values for 1"):
        board.reference_speeds = [1.0, 2.0]


def test_remote_boards(names: LocalNames) -> None:
    torso, head = Part("yaw", "roll"), Part("neck", "eyes")
    with (
        ControlBoardServer("/torso", torso, names=names),
        ControlBoardServer("/head", head, names=names),
        remap_remote(["/torso", "/head"], ["eyes", "yaw"], "/mine", names=names) as board,
        ControlBoardServer("/both", board, names=names),
        ControlBoard("/both", timeout=HANG, names=names) as both,
    ):
        assert both.axis_names == ["eyes", "yaw"] and both.encoders() == [1.0, 0.0]
        both.position_move("eyes", 4.5)
        assert head.told == [("move", [1], [4.5])] and torso.told == []
        both.reference_speeds = [1.0, 2.0]
        assert torso.reference_speeds == [2.0, 11.0]
