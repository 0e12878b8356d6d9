"""The camera for programs of YARP 4: what frameGrabber_nwc_yarp of C++ 4.0.0 asked it."""

import logging
import threading
from typing import Any

import numpy as np
import pytest
from support.way_back import way_back
from support.yarp4 import recorded

from yarpy.data.bottle import Bottle
from yarpy.data.sig.image import Image
from yarpy.data.yarp4 import to_yarp3
from yarpy.kits.devices.access import Access
from yarpy.kits.devices.frame_grabber.responder import FrameGrabberResponder
from yarpy.kits.devices.frame_grabber.yarp4.functions import FrameGrabberMsgs
from yarpy.kits.devices.frame_grabber.yarp4.server import Functions, blank
from yarpy.kits.devices.refusal import DeviceErrorLog
from yarpy.kits.thrift.structure import default_of
from yarpy.wire.message import CALL, Message


class Eye:
    """The camera that the C++ client was connected to."""

    resolution = (8, 6)
    resolutions = ((8, 6, 30.5, "rgb"), (160, 120, 15.0, "mono"))
    field_of_view = (60.5, 45.5)
    mirror = False
    description = ("usb", "a fake")

    def __init__(self) -> None:
        self.intrinsics = {"focalLengthX": 1.5, "distortionModel": "none"}
        self.features = {"brightness": 0.5, "white_balance": (0.1, 0.2)}
        self.feature_modes = {"gain": "auto"}
        self.feature_switches = {"trigger": True}
        self.pushed: list[str] = []

    def one_push(self, feature: str) -> None:
        self.pushed.append(feature)


def served(device: object) -> Functions:
    access = Access(device, 0, DeviceErrorLog("/eye"), threading.Lock())
    responder = FrameGrabberResponder(
        access, lambda: Image(np.full((6, 8, 3), 77, "uint8")), "/eye"
    )
    return Functions(responder, "/eye")


def ask(server: Any, request: bytes) -> bytes:
    message = Message(CALL, request)
    message.source = "/client"
    message.answer = way_back()
    return b"".join(server(message).to_wire())


def test_cpp_was_answered_like_this() -> None:
    eye = Eye()
    server = served(eye)
    for row in recorded("camera")["client"]:
        answer = ask(server, bytes.fromhex(row["request"]))
        assert answer.hex() == row["reply"], bytes.fromhex(row["request"])
    assert eye.features == {"brightness": 0.75, "white_balance": (0.25, 0.5)}
    assert eye.feature_modes == {"gain": "manual"} and eye.pushed == ["gain"]
    assert eye.feature_switches == {"trigger": False} and eye.mirror is True
    assert eye.resolution == (160, 120) and eye.field_of_view == (1.5, 2.5)


@pytest.mark.parametrize("device", [Eye(), object()], ids=["complete", "bare"])
def test_every_function_answers(device: object) -> None:
    server = served(device)
    for name, method in FrameGrabberMsgs._methods.items():
        zeros = [default_of(part.kind)() for part in method.parts]
        answer = Bottle.from_bytes(to_yarp3(ask(server, bytes(method.yarp4_ask(zeros)))))
        status = answer[0][0] if isinstance(answer[0], list) else answer[0]
        assert status in ("ok", "err2", "err5")
        assert (status == "err2") is ("DC1394" in name), name


def test_reasons_are_in_the_log(caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.INFO, "yarpy.devices")
    method = FrameGrabberMsgs._methods["setFeature1RPC"]
    answer = ask(served(Eye()), bytes(method.yarp4_ask([16, 0.5])))
    assert Bottle.from_bytes(answer) == ["err5"]
    assert "this camera has no zoom" in caplog.text
    assert blank().width == 1
