"""GazeController against a GazeServer with a SimulatedHead."""

import pytest
from support.wait import HANG, wait_until

from yarpy.data.bottle import Bottle
from yarpy.errors import LocalProtocolError
from yarpy.kits.devices import GazeController, GazeServer, SimulatedHead


@pytest.fixture
def gaze(names):
    with (
        GazeServer("/gaze", SimulatedHead(), 0.01, names=names),
        GazeController("/gaze", timeout=HANG, names=names) as client,
    ):
        client.neck_time = 0.02
        yield client


def near(found, wanted, by=1e-3):
    return all(abs(a - b) < by for a, b in zip(found, wanted, strict=True))


def test_it_looks_at_a_point(gaze):
    point = (-0.5, 0.1, 0.35)
    gaze.look_at(point, confirmed=True)
    assert gaze.wait_motion_done(0.01)
    wait_until(lambda: near(gaze.fixation_point(), point))
    wait_until(lambda: near(gaze.direction(point), gaze.angles(), 0.01))
    gaze.look_at((-1.0, 0.0, 0.3))
    wait_until(lambda: near(gaze.fixation_point(), (-1.0, 0.0, 0.3)))
    assert gaze.wait_saccade_done(0.01) and gaze.state_time("x") > 0


def test_it_turns(gaze):
    gaze.turn_to((10.0, -5.0, 4.0))
    wait_until(lambda: near(gaze.angles(), (10.0, -5.0, 4.0)))
    assert gaze.wait_motion_done(0.01)  # a turn further begins where it is
    gaze.turn_to((5.0, 5.0, 0.0), relative=True, confirmed=True)
    wait_until(lambda: near(gaze.angles(), (15.0, 0.0, 4.0)))
    assert near(gaze.desired_joints(), (0.0, 0.0, -15.0, 0.0, 0.0, 4.0))
    wait_until(lambda: near(gaze.joints(), (0, 0, 0, 0, 0, -15, 0, 0, 4)))
    wait_until(lambda: near(gaze.joint_velocities(), (0.0,) * 6))


def test_pixels(gaze):
    gaze.turn_to((0.0, 0.0, 4.0), confirmed=True)
    gaze.wait_motion_done(0.01)
    point = (-1.0, 0.2, 0.4)
    left, right = gaze.pixel("left", point), gaze.pixel("right", point)
    assert left[0] > right[0] > 160 and left[1] < 120
    assert near(gaze.triangulate(left, right), point)
    assert near(gaze.point("left", left, 1.0), point)
    assert near(gaze.point_on_plane("left", left, (1.0, 0.0, 0.0, 1.0)), point)
    there = gaze.point_in_direction(gaze.direction(point))
    assert near(there, point)
    assert gaze.pose("left").position[1] < gaze.pose("head").position[1]
    gaze.look_at_pixels(left, right, confirmed=True)
    wait_until(lambda: near(gaze.fixation_point(), point))
    gaze.turn_to((0.0, 0.0, 4.0), confirmed=True)
    gaze.wait_motion_done(0.01)
    gaze.look_at_pixel("left", left, 1.0)
    wait_until(lambda: near(gaze.fixation_point(), point))
    gaze.look_at_pixel("left", (160.0, 120.0), vergence=8.0, confirmed=True)
    gaze.wait_motion_done(0.01)


def test_settings(gaze):
    for name in ("eyes_time", "vor_gain", "ocr_gain", "saccade_inhibition", "saccade_angle"):
        setattr(gaze, name, 0.5)
        assert getattr(gaze, name) == 0.5, name
    gaze.neck_tolerance = 3.0
    for name in ("tracking", "stabilization", "saccades"):
        setattr(gaze, name, True)
        assert getattr(gaze, name) is True, name
        setattr(gaze, name, False)
        assert getattr(gaze, name) is False, name
    gaze.bind_neck("pitch", -10.0, 20.0)
    assert gaze.neck_range("pitch") == (-10.0, 20.0)
    gaze.bind_neck("yaw")
    assert gaze.neck_range("yaw")[0] == gaze.neck_range("yaw")[1]
    gaze.free("pitch")
    assert gaze.neck_range("pitch") == (-40.0, 30.0)
    gaze.bind_eyes(4.0)
    assert gaze.bound_vergence() == 4.0
    gaze.free("eyes")
    assert gaze.bound_vergence() < 0
    gaze.bind_eyes()
    gaze.change_stereo_options(Bottle([Bottle(["Kp", 0.5])]))
    assert gaze.stereo_options().to_text() == "(Kp 0.5)"
    assert gaze.tweaks().to_text() == ""


def test_contexts_and_what_is_refused(gaze):
    kept = gaze.store_context()
    gaze.neck_time = 3.0
    gaze.restore_context(kept)
    assert gaze.neck_time == 0.02
    gaze.restore_context(0)
    assert gaze.neck_time == 0.75
    with pytest.raises(LocalProtocolError, match="refuses get pose"):
        gaze.pose("nose")
    with pytest.raises(LocalProtocolError):
        gaze.tweak(Bottle([Bottle(["a", 1])]))
    with pytest.raises(ValueError, match="2 numbers"):
        gaze.point("left", (1.0,), 1.0)


def test_events(gaze):
    heard = []
    gaze.on_event("motion-done", heard.append)

    def looked():
        gaze.look_at((-1.0, 0.1, 0.3), confirmed=True)
        return gaze.wait_motion_done(0.01) and bool(heard)

    wait_until(looked)
    assert heard[0].kind == "motion-done" and heard[0].share is None
    gaze.off_event("motion-done")
