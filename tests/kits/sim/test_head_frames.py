"""The frames of the head are where its eyes and its inertial unit are."""

import pytest

from yarpy.kits.sim.head import IMU, SIDES, eye_pose
from yarpy.kits.sim.head_frames import ROOT, head_frames
from yarpy.kits.sim.rotation import quaternion
from yarpy.peers.ros.transform.buffer import Buffer
from yarpy.peers.ros.transform.pose import Pose

ANGLES = (20.0, -35.0, 40.0, 15.0, -25.0, 30.0)


@pytest.mark.parametrize("angles", [(0.0,) * 6, ANGLES])
def test_along_the_neck_to_the_eyes(angles):
    buffer = Buffer()
    for frame in head_frames(angles):
        buffer.put(frame.parent, frame.name, Pose(frame.origin, frame.orientation), 1.0)
    for side in SIDES:
        pose = eye_pose(angles, side)
        found = buffer.lookup(ROOT, f"cam/{side}", 1.0).pose
        assert found.at == pytest.approx(pose.position)
        same = sum(a * b for a, b in zip(found.turned, quaternion(pose.rotation), strict=True))
        assert abs(same) == pytest.approx(1.0)


def test_the_inertial_unit_is_in_the_head():
    frames = {frame.name: frame for frame in head_frames(ANGLES)}
    assert frames["head_imu"].parent == "head"
    assert frames["head_imu"].origin == IMU
