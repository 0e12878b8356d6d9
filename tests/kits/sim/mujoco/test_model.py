"""Joints of a MuJoCo model that follow their references, whatever drives them."""

import sys

import pytest

from yarpy.errors import UnknownPlugin
from yarpy.kits.sim.mujoco.model import LONGEST, Model, load


@pytest.fixture
def model(arm, clock) -> Model:
    return load(arm, clock)


def positions(model):
    with model.present() as joints:
        return [joint.position for joint in joints]


def run(model, clock, seconds):
    for _ in range(round(seconds / 0.02)):
        clock.now += 0.02
        positions(model)


def test_joints_with_actuators(model):
    assert model.name == "little arm"
    assert [joint.axis.name for joint in model.joints] == ["shoulder", "elbow", "rail"]
    assert [joint.axis.kind for joint in model.joints] == ["revolute", "revolute", "prismatic"]
    ranges = [(joint.axis.lowest, joint.axis.highest) for joint in model.joints]
    assert ranges == [pytest.approx(r) for r in ((-100, 100), (-10, 140), (-400, 400))]


def test_motor_servo_and_drive_go_where_they_are_sent(model, clock):
    with model.present() as joints:
        for joint, target in zip(joints, (40.0, 60.0, 200.0), strict=True):
            joint.reference.move_to(target)
    run(model, clock, 0.5)
    with model.present() as joints:
        assert not any(joint.done for joint in joints)
        assert all(joint.speed > 10 for joint in joints)
    run(model, clock, 3.0)
    with model.present() as joints:
        assert all(joint.done for joint in joints)
        shoulder, elbow, rail = (joint.position for joint in joints)
    assert shoulder == pytest.approx(40, abs=0.5)
    assert elbow == pytest.approx(60, abs=6), "a weak servo, and gravity"
    assert rail == pytest.approx(200, abs=2)


def test_speeds(model, clock):
    with model.present() as joints:
        joints[2].reference.switch("vel")
        joints[2].reference.move_at(-100.0)
    run(model, clock, 1.0)
    with model.present() as joints:
        assert joints[2].speed == pytest.approx(-100, abs=5)


def test_idle_joints_fall(model, clock):
    run(model, clock, 1.0)
    upright = positions(model)
    assert upright == pytest.approx([0, 0, 0], abs=1)
    with model.present() as joints:
        for joint in joints:
            joint.reference.switch("idl")
    with model.present():
        model.data.qvel[1] = 1.0
    run(model, clock, 3.0)
    assert max(abs(angle) for angle in positions(model)[:2]) > 60


def test_time_is_that_of_the_clock(model, clock):
    begun = model.data.time
    run(model, clock, 1.0)
    assert model.data.time - begun == pytest.approx(1.0, abs=0.01)
    begun = model.data.time
    clock.now += 1000.0
    positions(model)
    assert model.data.time - begun == pytest.approx(LONGEST, abs=0.01), "nobody waits for the past"


def test_beginning_of_a_model(arm, clock, tmp_path):
    text = arm.read_text().replace(
        "</mujoco>", '<keyframe><key qpos="0.1 0.5 -0.1 0" ctrl="0 0 0"/></keyframe></mujoco>'
    )
    file = tmp_path / "nameless.xml"
    file.write_text(text.replace(' model="little arm"', ""))
    model = load(file, clock)
    assert model.name == "nameless"
    assert positions(model) == pytest.approx([28.65, -5.73, 100], abs=0.01)
    run(model, clock, 0.5)
    assert positions(model)[0] == pytest.approx(28.65, abs=1), "it stays where it began"


def test_what_is_no_model(arm, tmp_path):
    with pytest.raises(OSError):
        load(tmp_path / "missing.xml")
    file = tmp_path / "broken.xml"
    file.write_text("<mujoco>")
    with pytest.raises(ValueError):
        load(file)


def test_no_mujoco(monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "mujoco", None)
    with pytest.raises(UnknownPlugin, match="pip install"):
        load(tmp_path / "x.xml")


def test_actuators_that_are_no_joints(arm, clock, tmp_path):
    text = arm.read_text()
    more = '<general joint="swinging" gaintype="affine" gainprm="1 1 0"/>'
    more += '<motor site="hand" gear="0 0 1 0 0 0"/><motor joint="elbow"/></actuator>'
    file = tmp_path / "more.xml"
    file.write_text(text.replace("</actuator>", more))
    assert [j.axis.name for j in load(file, clock).joints] == ["shoulder", "elbow", "rail"]
