"""Remappers as devices of a robot's file."""

import pytest

import yarpy
from yarpy import Bottle, Property
from yarpy.kits.devices import ControlBoardServer, SimulatedBattery, SimulatedJoints
from yarpy.kits.devices.control_board.remapper import Remapper, remote_remapper


def test_joints_of_attached_boards() -> None:
    torso, head = SimulatedJoints(["yaw", "roll"]), SimulatedJoints(["pitch"])
    mapper = Remapper(Property.from_text("(axesNames (pitch yaw))"))
    with pytest.raises(ValueError, match="no joints yet"):
        _ = mapper.served
    mapper.attach({"t": torso, "h": head, "other": SimulatedBattery()})
    board = mapper.served
    assert board.axis_names == ["pitch", "yaw"]  # type: ignore[attr-defined]
    board.position_move([0, 1], [5.0, 7.0])  # type: ignore[attr-defined]
    assert (torso.encoders(), head.encoders()) == ([7.0, 0.0], [5.0])
    mapper.detach()
    with pytest.raises(ValueError, match="no joints yet"):
        _ = mapper.served


def test_without_names_it_has_all_joints() -> None:
    mapper = Remapper(Property())
    mapper.attach({"a": SimulatedJoints(["x"]), "b": SimulatedJoints(["y", "z"])})
    assert mapper.served.axis_names == ["x", "y", "z"]  # type: ignore[attr-defined]


def test_what_cannot_be_mapped_is_refused() -> None:
    with pytest.raises(ValueError, match="none of these is one"):
        Remapper(Property()).attach({"b": SimulatedBattery()})
    with pytest.raises(ValueError, match="no board has the joints knee"):
        Remapper(Property(axesNames="knee")).attach({"a": SimulatedJoints(["elbow"])})


def test_joints_of_remote_boards() -> None:
    names = yarpy.LocalNames()
    with (
        ControlBoardServer("/torso", SimulatedJoints(["yaw"]), names=names),
        ControlBoardServer("/head", SimulatedJoints(["pitch", "roll"]), names=names),
    ):
        options = Property.from_text(
            "(remoteControlBoards (/torso /head)) (axesNames (roll yaw)) (localPortPrefix /mine)"
            "(REMOTE_CONTROLBOARD_OPTIONS (carrier fast_tcp))"
        )
        board = remote_remapper(options, names=names)
        assert board.axis_names == ["roll", "yaw"]  # type: ignore[attr-defined]
        board.close()  # type: ignore[attr-defined]
    with pytest.raises(ValueError, match="parameter remoteControlBoards"):
        remote_remapper(Property(axesNames=Bottle(["a"])))
    with pytest.raises(ValueError, match="parameter axesNames"):
        remote_remapper(Property(remoteControlBoards="/torso"))
