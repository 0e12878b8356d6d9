"""Requests to a camera of YARP 4: what frameGrabber_nws_yarp of C++ 4.0.0 answered."""

from typing import Any

import pytest
from support.yarp4 import Replay

from yarpy.data.bottle import Bottle
from yarpy.errors import LocalProtocolError
from yarpy.kits.devices.frame_grabber.client import FrameGrabber
from yarpy.kits.devices.frame_grabber.yarp4.requests import FunctionRequests


@pytest.fixture
def eye(monkeypatch: pytest.MonkeyPatch) -> FrameGrabber:
    """A client whose server is the recording."""
    port: Any = Replay("camera")
    made = FrameGrabber.__new__(FrameGrabber)
    made.remote, made._rpc, made._functions, made._newer = "/eye", port, None, False
    return made


def test_what_is_asked_and_answered(eye: FrameGrabber) -> None:
    assert eye.resolution == (64, 48)
    assert eye._newer is True
    assert eye.field_of_view == (1.0, 2.0)
    assert eye.resolutions[1] == (256, 256, 30.0, "bgr")
    assert eye.intrinsics["focalLengthX"] == 4.0 and len(eye.intrinsics["rectificationMatrix"]) == 9
    assert eye.mirror is False
    assert eye.description == ("unknown", "")
    assert eye.crop(1, 1, 4, 3).array.shape == (3, 4, 3)
    eye.mirror = True
    assert eye.mirror is True
    eye.resolution = (128, 128)
    assert eye.resolution == (128, 128)
    assert "brightness" not in eye.features


def test_refusals(eye: FrameGrabber) -> None:
    eye.features["brightness"] = 0.75
    failed = ["00010000010000000900000065727235"]  # [err5]
    for replies in eye._rpc.answers.values():  # type: ignore[attr-defined]
        replies[:] = failed
    with pytest.raises(LocalProtocolError, match=r'"/eye" refuses setFeature1\(0, 0\.75\): it'):
        eye.features["brightness"] = 0.75
    functions = FunctionRequests("/eye", eye._rpc, 1.0)
    with pytest.raises(LocalProtocolError, match=r"does not know \[fgir\] \[get\] \[imgr\]"):
        functions.request(Bottle.from_text("[fgir] [get] [imgr]"))
