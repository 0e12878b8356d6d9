"""A simulated camera with distances, at a clock of the test."""

import numpy as np
import pytest

from yarpy.kits.devices.refusal import Refused
from yarpy.kits.devices.simulated.depth_camera import BALL, WALL, SimulatedDepthCamera


def test_a_ball_in_front_of_a_wall() -> None:
    camera = SimulatedDepthCamera(64, 48, lambda: 0.0)
    depth, colour = camera.depth().array, camera.colour().array
    assert {*np.unique(depth)} == {np.float32(BALL), np.float32(WALL)}
    assert np.array_equal(depth == np.float32(BALL), colour[:, :, 0] == 200)
    camera.mirror_colour(True)
    assert np.array_equal(camera.depth().array, depth[:, ::-1])
    camera.change_clip_planes(2.0, 10.0)
    assert camera.depth().array.min() == 0.0 and camera.clip_planes() == (2.0, 10.0)


def test_settings() -> None:
    camera = SimulatedDepthCamera()
    camera.resize_depth(32, 24)
    assert camera.colour().array.shape == (24, 32, 3) and camera.depth_resolution() == (32, 24)
    camera.change_feature(0, 0.75)
    assert camera.feature(0) == 0.75 and camera.has_feature(0) and not camera.has_feature(1)
    assert camera.depth_intrinsics()["principalPointX"] == 16.0
    for fail in (
        lambda: camera.resize_colour(0, 10),
        lambda: camera.widen_colour(180.0, 10.0),
        lambda: camera.feature(1),
    ):
        with pytest.raises(Refused):
            fail()
