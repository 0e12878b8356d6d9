import pytest
from support.camera import FakeCamera
from support.wait import HANG, wait_until

import yarpy
from yarpy import Bottle
from yarpy.errors import LocalProtocolError, RemoteProtocolError, Timeout, UnknownName
from yarpy.kits.devices.frame_grabber.client import FrameGrabber
from yarpy.kits.devices.frame_grabber.interface import FrameGrabberLike
from yarpy.kits.devices.frame_grabber.server import FrameGrabberServer


@pytest.fixture
def camera():
    return FakeCamera()


@pytest.fixture
def near(camera, names):
    with (
        FrameGrabberServer("/eye", camera, 0.005, names=names),
        FrameGrabber("/eye", names=names) as client,
    ):
        yield client


@pytest.fixture
def relayed(near, names):
    with (
        FrameGrabberServer("/relay", near, 0.005, names=names),
        FrameGrabber("/relay", names=names) as client,
    ):
        yield client


@pytest.fixture(params=["near", "relayed"])
def eye(request):
    return request.getfixturevalue(request.param)


def test_it_is_a_whole_camera():
    members = {*vars(FrameGrabberLike), *FrameGrabberLike.__annotations__, "image"}
    assert {n for n in members if not n.startswith("_")} - {*dir(FrameGrabber)} == set()


def test_images(eye, camera):
    camera.timestamp = lambda: 12.5
    wait_until(lambda: eye.image(HANG).width == 64 and eye.timestamp() == 12.5)
    first, second = eye.image(HANG), eye.image(HANG)
    assert first.array.shape == (48, 64, 3)
    assert first.array[0, 0, 0] != second.array[0, 0, 0]
    assert eye.stamp.time == 12.5
    for image, _ in zip(eye, range(2), strict=False):
        assert image.width == 64
    part = eye.crop(60, 0, 63, 9)
    assert part.array.shape == (10, 4, 3) and part.array[:, -1].min() == 255


def test_the_camera_works_only_when_it_is_asked(near, camera):
    assert near.resolution == (64, 48)
    assert camera.taken == 0


def test_lens(eye, camera):
    assert eye.resolution == (64, 48)
    eye.resolution = (32, 24)
    assert camera.resolution == (32, 24)
    assert eye.field_of_view == (1.0, 2.0)
    eye.field_of_view = (60, 45)
    assert camera.field_of_view == (60.0, 45.0)
    assert eye.resolutions == [(128, 128, 60.0, "rgb"), (256, 256, 30.0, "bgr")]
    assert eye.intrinsics == {"focalLengthX": 4.0, "distortionModel": "FishEye"}
    assert eye.mirror is False
    eye.mirror = True
    assert camera.mirror is True
    assert eye.description == ("usb", "a fake")


def test_features(eye, camera):
    assert dict(eye.features) == {"brightness": 0.5, "white_balance": (0.25, 0.75)}
    eye.features["brightness"] = 0.75
    eye.features["white_balance"] = (1, 2)
    assert camera.features == {"brightness": 0.75, "white_balance": (1.0, 2.0)}
    assert dict(eye.feature_modes) == {"gain": "auto"}
    eye.feature_modes["gain"] = "manual"
    assert camera.feature_modes == {"gain": "manual"}
    assert dict(eye.feature_switches) == {"trigger": True}
    eye.feature_switches["trigger"] = False
    assert camera.feature_switches == {"trigger": False}
    eye.one_push("gain")
    assert camera.pushed == ["gain"]
    assert len(eye.features) == 2


def test_what_a_camera_does_not_do(near, camera):
    with pytest.raises(KeyError, match=rf'"{near.remote}" has no zoom: iterate'):
        near.features["zoom"]
    with pytest.raises(LocalProtocolError, match="no zoom"):
        near.features["zoom"] = 1.0
    with pytest.raises(KeyError, match="not one of brightness"):
        near.features["shine"] = 1.0
    with pytest.raises(TypeError):
        del near.features["brightness"]
    with pytest.raises(ValueError):
        near.feature_modes["gain"] = "loud"
    with pytest.raises(LocalProtocolError, match="does not accept res 0 0"):
        near.resolution = (0, 0)
    with pytest.raises(LocalProtocolError, match="not within"):
        near.crop(0, 0, 64, 48)
    del camera.field_of_view
    with pytest.raises(LocalProtocolError, match="refuses"):
        print(near.field_of_view)


def test_nobody_sends(names):
    with (
        yarpy.Port("/eye", names=names),
        yarpy.RpcServer("/eye/rpc", lambda message: Bottle(["x"]), names=names),
        FrameGrabber("/eye", names=names) as eye,
    ):
        with pytest.raises(Timeout, match="is the camera on"):
            eye.image(timeout=0.05)
        with pytest.raises(RemoteProtocolError, match="answers x"):
            print(eye.resolution)
    with pytest.raises(UnknownName):
        FrameGrabber("/eye", names=names)
