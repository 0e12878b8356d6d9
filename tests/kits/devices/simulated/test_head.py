"""SimulatedHead: its geometry."""

import pytest

from yarpy.kits.devices.refusal import Refused
from yarpy.kits.devices.simulated.head import SimulatedHead


def test_directions_there_and_back():
    head = SimulatedHead()
    for point in [(-0.5, 0.1, 0.35), (-2.0, -0.5, 0.0), (-0.1, 0.0, 0.3)]:
        assert head.point_in_direction(head.direction(point)) == pytest.approx(point)
    with pytest.raises(Refused):
        head.direction((0.0, 0.0, 0.3))


def test_pixels_there_and_back():
    head = SimulatedHead()
    head.neck_time = 0.0
    head.turn_to((20.0, 10.0, 5.0))
    point = (-1.0, 0.4, 0.5)
    pixels = [head.pixel(camera, point) for camera in ("left", "right")]
    assert head.triangulate(*pixels) == pytest.approx(point)
    assert head.pixel("head", head.fixation_point()) == pytest.approx((160.0, 120.0))
    for wrong in [("nose", point), ("left", (1.0, 0.0, 0.3))]:
        with pytest.raises(Refused):
            head.pixel(*wrong)
    with pytest.raises(Refused):
        head.point_on_plane("left", (160.0, 120.0), (0.0, 0.0, 0.0, 1.0))


def test_neck_and_eyes_share_the_way():
    head = SimulatedHead()
    head.neck_time = 0.0
    head.bind_neck("yaw", -5.0, 5.0)
    head.turn_to((20.0, 0.0, 4.0))
    assert head.joints() == pytest.approx((0, 0, 0, 0, 0, -5.0, 0, 15.0, 4.0))
    head.bind_eyes(8.0)
    head.turn_to((20.0, 0.0, 4.0))
    assert head.angles()[2] == 8.0 and head.motion_done() and head.saccade_done()
