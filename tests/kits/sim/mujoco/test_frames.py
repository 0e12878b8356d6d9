"""Where the bodies and cameras of a MuJoCo model are."""

from math import cos, radians, sin

import pytest

from yarpy.kits.sim.mujoco.frames import ModelFrames
from yarpy.kits.sim.mujoco.model import load
from yarpy.kits.sim.mujoco.robot import mujoco_robot
from yarpy.peers.ros.transform.buffer import Buffer
from yarpy.peers.ros.transform.pose import Pose


def tree(frames) -> Buffer:
    buffer = Buffer()
    for frame in frames:
        buffer.put(frame.parent, frame.name, Pose(frame.origin, frame.orientation), 1.0)
    return buffer


def test_a_base_that_has_moved(rover, clock):
    model = load(rover, clock)
    half = radians(90) / 2
    with model.present():
        model.data.qpos[:7] = (1.0, 2.0, 0.1, cos(half), 0, 0, sin(half))
    when, frames = ModelFrames(model, {}).frames()
    assert when == clock.now
    base = next(frame for frame in frames if frame.parent == "world")
    assert base.origin == pytest.approx((1.0, 2.0, 0.1))
    assert base.orientation == pytest.approx((0, 0, sin(half), cos(half)))


def test_frames_are_where_mujoco_has_them(arm, clock):
    model = load(arm, clock)
    views = {f"cam/{model.name_of('camera', number)}": number for number in range(model.model.ncam)}
    assert views
    with model.present():
        model.data.qpos[:] = 0.3
    buffer = tree(ModelFrames(model, views).frames()[1])
    data = model.data
    for number in range(1, model.model.nbody):
        found = buffer.lookup("world", model.name_of("body", number), 1.0).pose
        assert found.at == pytest.approx(data.xpos[number].tolist())
        for axis, column in (((1, 0, 0), 0), ((0, 1, 0), 1)):
            tip = data.xpos[number] + data.xmat[number].reshape(3, 3)[:, column]
            assert found.apply(axis) == pytest.approx(tip.tolist())
    for name, number in views.items():
        found = buffer.lookup("world", name, 1.0).pose
        assert found.at == pytest.approx(data.cam_xpos[number].tolist())
        ahead = data.cam_xpos[number] - data.cam_xmat[number].reshape(3, 3)[:, 2]
        assert found.apply((0, 0, 1)) == pytest.approx(ahead.tolist())


def test_a_robot_has_them(arm, clock):
    _, parts = mujoco_robot(arm, (32, 32), clock)
    names = {frame.name for frame in parts.frames.frames()[1]}
    assert names >= {name for name in parts.cameras if name != "cam/free"}
