"""A MuJoCo model as the parts of a robot, on ports."""

import pytest

import yarpy
from yarpy.errors import UnknownPlugin
from yarpy.kits.devices import ControlBoard
from yarpy.kits.sim.mujoco import robot as module
from yarpy.kits.sim.mujoco.robot import mujoco_robot
from yarpy.kits.sim.robot import Robot


def test_parts(arm, clock):
    warnings = []
    name, parts = mujoco_robot(arm, (80, 60), clock, warnings.append)
    assert name == "little_arm"
    assert [*parts.boards] == ["joints"]
    assert [*parts.sensors] == ["inertial"]
    if warnings:
        assert not parts.cameras and "no cameras: " in warnings[0]
    else:
        assert [*parts.cameras] == ["cam/watching", "cam/hand"]


def test_without_pictures(arm, clock, monkeypatch):
    def blind(*arguments):
        raise UnknownPlugin("nothing can draw")

    monkeypatch.setattr(module, "Painter", blind)
    warnings = []
    _, parts = mujoco_robot(arm, (80, 60), clock, warnings.append)
    assert warnings == ["no cameras: nothing can draw"]
    assert not parts.cameras and parts.boards and parts.sensors


def test_model_of_nothing(arm, clock, tmp_path, monkeypatch):
    def blind(*arguments):
        raise UnknownPlugin("nothing can draw")

    monkeypatch.setattr(module, "Painter", blind)
    file = tmp_path / "empty.xml"
    file.write_text("<mujoco><worldbody/></mujoco>")
    with pytest.raises(ValueError, match="no joint with an actuator"):
        mujoco_robot(file, (80, 60), clock)


def test_on_ports(arm):
    name, parts = mujoco_robot(arm, (80, 60))
    with (
        yarpy.NameServer(),
        Robot(name, parts) as robot,
        ControlBoard("/little_arm/joints", "/client") as board,
    ):
        assert "/little_arm/inertial" in robot.ports
        assert list(board.axis_names) == ["shoulder", "elbow", "rail"]
        assert list(board.axis_types)[2] == "prismatic"
