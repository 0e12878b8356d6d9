"""A MuJoCo model as the parts of a robot, on ports."""

import pytest
from support.wait import HANG

import yarpy
from yarpy.errors import UnknownPlugin
from yarpy.kits.devices import ControlBoard, Laser, Localization2D, MultiSensor, Odometry2D
from yarpy.kits.sim.mujoco import robot as module
from yarpy.kits.sim.mujoco.robot import mujoco_robot, scene_in
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


def test_a_folder_of_menagerie(arm, rover, tmp_path, clock):
    """Its scene includes the robot, which lies beside it."""
    (tmp_path / "rover.xml").write_text(rover.read_text())
    assert scene_in(tmp_path) == tmp_path / "rover.xml"
    (tmp_path / "scene.xml").write_text(
        '<mujoco model="rover scene"><include file="rover.xml"/></mujoco>'
    )
    name, parts = mujoco_robot(tmp_path, (80, 60), clock)
    assert name == "rover_scene" or name == "rover"
    assert [*parts.lasers] == ["laser_front"] and parts.base is not None
    assert scene_in(arm) == arm
    (tmp_path / "scene.xml").rename(tmp_path / "other.xml")
    with pytest.raises(ValueError, match=r"no scene.xml; models: other.xml, rover.xml"):
        scene_in(tmp_path)


def test_what_moves_freely_is_on_ports(rover):
    names = yarpy.LocalNames()
    name, parts = mujoco_robot(rover, (80, 60))
    with (
        Robot(name, parts, names=names) as robot,
        Laser("/rover/laser_front", timeout=HANG, names=names) as laser,
        Odometry2D.connect("/rover/odometry", names=names) as odometry,
        Localization2D.connect("/rover/localization", names=names) as localization,
        MultiSensor("/rover/inertial", timeout=HANG, names=names) as sensors,
    ):
        assert {"/rover/laser_front", "/rover/odometry", "/rover/localization"} <= {*robot.ports}
        assert laser.scan().ranges[0] == pytest.approx(2.0, abs=0.2)
        assert abs(odometry.odometry().odom_x) < 0.2
        assert abs(localization.position().x) < 0.2
        assert len(sensors.force_torques()["shoulder_ft"]) == 6
