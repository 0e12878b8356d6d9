"""CartesianController against a CartesianServer with a SimulatedArm."""

import math

import pytest
from support.wait import HANG, wait_until

from yarpy.errors import LocalProtocolError, YarpError
from yarpy.kits.devices import CartesianController, CartesianServer, SimulatedArm


@pytest.fixture
def arm(names):
    with (
        CartesianServer("/robot/arm", SimulatedArm(), 0.01, names=names),
        CartesianController("/robot/arm", timeout=HANG, names=names) as client,
    ):
        yield client


def near(found, wanted, by=1e-3):
    return all(abs(a - b) < by for a, b in zip(found, wanted, strict=True))


def test_a_hand_goes_where_it_is_sent(arm):
    assert arm.is_on() and arm.info()["server_version"] == "2.0"
    start = arm.pose()
    assert len(start.orientation) == 4 and start.time > 0
    goal = (0.15, 0.05, -0.3)
    arm.go_to(goal, seconds=0.05, confirmed=True)
    wait_until(arm.motion_done)
    wait_until(lambda: near(arm.pose().position, goal))
    assert near(arm.desired().position, goal)
    assert near(arm.pose(6).position, goal) and not near(arm.pose(2).position, goal)
    assert arm.joint_velocities() == (0.0,) * 7
    assert arm.task_velocities()[0] == (0.0, 0.0, 0.0)


def test_commands_without_an_answer(arm):
    arm.go_to((0.1, 0.0, -0.3), seconds=0.01)
    wait_until(lambda: near(arm.pose().position, (0.1, 0.0, -0.3)))
    before = arm.pose().position
    arm.move((0.1, 0.0, 0.0), (0.0,) * 4)
    wait_until(lambda: arm.pose().position[0] > before[0] + 0.01)
    arm.stop()
    assert arm.motion_done()


def test_a_hand_turns(arm):
    turned = (0.0, -1.0, 0.0, math.radians(45))
    found = arm.solve((0.2, 0.0, -0.25), turned)
    assert near(found.position, (0.2, 0.0, -0.25)) and near(found.orientation, turned, 0.01)
    assert len(found.joints) == 7
    arm.go_to((0.2, 0.0, -0.25), turned, seconds=0.01, confirmed=True)
    wait_until(lambda: near(arm.pose().orientation, turned, 0.02))
    far = arm.solve((5.0, 0.0, 0.0), start=(0.0, 0.0, 0.0, -60.0, 0.0, 0.0, 0.0))
    assert math.dist(far.position, (0, 0, 0)) < 0.5


def test_settings_and_contexts(arm):
    kept = arm.store_context()
    arm.trajectory_time, arm.tolerance = 2.5, 0.01
    arm.tracking, arm.reference_mode, arm.priority = True, False, "orientation"
    arm.dof = (1, 1, 2, 0)
    assert arm.dof == (1.0, 1.0, 1.0, 0.0, 1.0, 1.0, 1.0)
    arm.rest_position, arm.rest_weights = [1.0] * 7, [2.0] * 7
    arm.change_limits(3, -90.0, 0.0)
    arm.tip = ((0.0, 0.0, -0.1), (0.0, 0.0, 1.0, 0.0))
    assert (arm.trajectory_time, arm.tolerance, arm.priority) == (2.5, 0.01, "orientation")
    assert arm.tracking and not arm.reference_mode and arm.limits(3) == (-90.0, 0.0)
    assert arm.rest_position[0] == 1.0 and arm.rest_weights[6] == 2.0
    assert arm.tip[0] == (0.0, 0.0, -0.1)
    arm.restore_context(kept)
    assert arm.trajectory_time == 1.0 and not arm.tracking and arm.tip[0] == (0.0, 0.0, 0.0)
    arm.delete_context(kept)
    with pytest.raises(LocalProtocolError, match="refuses"):
        arm.restore_context(kept)


def test_events(arm):
    heard, half = [], []
    arm.on_event("*", heard.append)
    arm.on_event("motion-ongoing", half.append, 0.5)
    # Connections into the port of events are made by its server, a moment later.
    wait_until(lambda: _told(arm, heard))
    wait_until(lambda: "motion-done" in [each.kind for each in heard])
    wait_until(lambda: bool(half))
    assert half[0].share == 0.5 and heard[0].time > 0
    arm.off_event("motion-ongoing", 0.5)


def _told(arm, heard):
    arm.go_to((0.1, 0.0, -0.3), seconds=0.05, confirmed=True)
    wait_until(arm.motion_done)
    return "motion-onset" in [each.kind for each in heard]


def test_what_is_refused(arm, names):
    with pytest.raises(LocalProtocolError, match="lim"):
        arm.limits(9)
    with pytest.raises(LocalProtocolError):
        arm.change_limits(1, 5.0, -5.0)
    with pytest.raises(LocalProtocolError):
        arm.rest_position = (1.0,)
    with pytest.raises(ValueError, match="3 numbers"):
        arm.go_to((1.0, 2.0))
    with pytest.raises(LocalProtocolError):
        arm.ask("nonsense")
    with pytest.raises(YarpError):
        CartesianController("/robot/nobody", names=names)
