"""Cameras at FireWire: registers, in the words of YARP 3, as functions of YARP 4, and remotely."""

import threading
from typing import Any

import pytest
from support.camera import FakeCamera
from support.way_back import way_back

from yarpy.data.bottle import Bottle
from yarpy.data.sig.image import Image
from yarpy.errors import LocalProtocolError, RemoteProtocolError
from yarpy.kits.devices.access import Access
from yarpy.kits.devices.frame_grabber.client import FrameGrabber
from yarpy.kits.devices.frame_grabber.firewire import (
    BY_WORD,
    FUNCTIONS,
    Registers,
    RemoteRegisters,
    apply,
)
from yarpy.kits.devices.frame_grabber.responder import FrameGrabberResponder
from yarpy.kits.devices.frame_grabber.yarp4.functions import FrameGrabberMsgs
from yarpy.kits.devices.frame_grabber.yarp4.requests import FunctionRequests
from yarpy.kits.devices.frame_grabber.yarp4.server import Functions
from yarpy.kits.devices.refusal import DeviceErrorLog, Refused
from yarpy.wire.message import CALL, Message


class Eye:
    """The registers of a camera that has all of them."""

    video_modes = 0x80000021
    video_mode = 69
    frame_rates = 6
    frame_rate = 34
    iso_speed = 2
    color_coding = 352
    window = (320, 240, 0, 0)
    largest_window = (640, 480, 2, 2, 4, 4)
    beta_mode = False
    transmission = True
    bytes_per_packet = 1024

    def __init__(self) -> None:
        self.done: list[object] = []

    def color_codings(self, video_mode: int) -> int:
        return video_mode + 1

    def switch_broadcast(self, on: bool) -> None:
        self.done.append(("broadcast", on))

    def switch_power(self, on: bool) -> None:
        self.done.append(("power", on))

    def switch_capture(self, on: bool) -> None:
        self.done.append(("capture", on))

    def restore(self) -> None:
        self.done.append("restored")

    def reset(self) -> None:
        self.done.append("reset")


def responder(registers: object | None) -> FrameGrabberResponder:
    camera: Any = FakeCamera()
    if registers is not None:
        camera.firewire = registers
    access = Access(camera, 0, DeviceErrorLog("/eye"), threading.Lock())
    return FrameGrabberResponder(access, lambda: Image(camera.image()), "/eye")


class Words:
    """A port to a camera of YARP 3."""

    def __init__(self, server: FrameGrabberResponder) -> None:
        self._server = server

    def call(self, request: Bottle, timeout: float | None = None) -> Any:
        reply = self._server.answer(request)
        return reply[0] if len(reply) == 1 else reply


class Calls:
    """A port to a camera of YARP 4."""

    def __init__(self, server: FrameGrabberResponder) -> None:
        self._server: Any = Functions(server, "/eye")

    def ask(self, request: Any, timeout: float | None = None) -> Message:
        message = Message(CALL, b"".join(request.to_wire()))
        message.source = "/client"
        message.answer = way_back()
        return Message("D", b"".join(self._server(message).to_wire()))


def near(registers: object | None, newer: bool) -> RemoteRegisters:
    """A client of a camera, without ports."""
    made = FrameGrabber.__new__(FrameGrabber)
    server = responder(registers)
    port: Any = Calls(server) if newer else Words(server)
    made.remote, made._rpc, made._newer = "/eye", port, newer
    made._functions = FunctionRequests("/eye", port, 1.0)
    return made.firewire


@pytest.fixture(params=["words", "functions"])
def newer(request: pytest.FixtureRequest) -> bool:
    return bool(request.param == "functions")


def test_every_function_is_one_of_yarp4() -> None:
    known = {name.removesuffix("RPC") for name in FrameGrabberMsgs._methods}
    assert {name for name in known if "DC1394" in name} == FUNCTIONS.keys()
    assert len(BY_WORD) == len(FUNCTIONS)
    members = {*vars(Registers), *Registers.__annotations__}
    wanted = {name for name in members if not name.startswith("_")}
    assert wanted == {each.member for each in FUNCTIONS.values()}
    assert wanted <= {*dir(RemoteRegisters)} and wanted <= {*dir(Eye)}


def test_what_is_read_and_set(newer: bool) -> None:
    eye = Eye()
    there = near(eye, newer)
    for member in sorted({each.member for each in FUNCTIONS.values() if each.does == "get"}):
        assert getattr(there, member) == getattr(eye, member), member
    assert there.color_codings(5) == 6
    there.video_mode, there.frame_rate, there.iso_speed, there.color_coding = 70, 33, 3, 353
    there.window, there.bytes_per_packet = (100, 50, -1, 4), 512
    there.beta_mode, there.transmission = True, False
    assert (eye.video_mode, eye.frame_rate, eye.iso_speed, eye.color_coding) == (70, 33, 3, 353)
    assert (eye.window, eye.bytes_per_packet) == ((100, 50, -1, 4), 512)
    assert (eye.beta_mode, eye.transmission) == (True, False)
    there.switch_broadcast(True)
    there.switch_power(False)
    there.switch_capture(True)
    there.restore()
    there.reset()
    switched = [("broadcast", True), ("power", False), ("capture", True)]
    assert eye.done == [*switched, "restored", "reset"]
    with pytest.raises(AttributeError, match="only be read"):
        there.video_modes = 1


def test_a_camera_without(newer: bool) -> None:
    there = near(None, newer)
    with pytest.raises(LocalProtocolError, match=r"is no camera at FireWire|refuses getFPSDC1394"):
        assert there.frame_rate
    poor = near(object(), newer)
    with pytest.raises(LocalProtocolError, match=r"has no frame_rate|refuses getFPSDC1394"):
        assert poor.frame_rate
    with pytest.raises(LocalProtocolError, match=r"does not accept|refuses setFPSDC1394"):
        poor.frame_rate = 3


@pytest.mark.parametrize(
    ("request_", "reply"),
    [
        ("[fgfw] [DR2n]", "69"),
        ("[fgfw] [DR2m]", "-2147483615"),
        ("[fgfw] [DR2o] 70", "1"),
        ("[fgfw] [DR2o] 1.5", "0"),
        ("[fgfw] [DR2o]", "0"),
        ("[fgfw] [DR2z]", "640 480 2 2 4 4"),
        ("[fgfw] [DR2J]", "1"),
        ("[fgfw] [DR2u] 5", "6"),
        ("[fgfw] [DR2a]", '[fail] "it is no function of cameras at FireWire"'),
        ("[fgfw]", '[fail] "it is no function of cameras at FireWire"'),
    ],
)
def test_words_of_yarp3(request_: str, reply: str) -> None:
    assert responder(Eye()).answer(Bottle.from_text(request_)).to_text() == reply
    assert responder(None).answer(Bottle.from_text(request_)).to_text() == "[nak]"


def test_what_is_no_register() -> None:
    class Odd:
        largest_window = (640, 480)

    with pytest.raises(ValueError, match="2 numbers, not 6"):
        apply(Odd(), FUNCTIONS["getFormat7MaxWindowDC1394"], [])
    with pytest.raises(Refused, match="incomplete"):
        apply(Eye(), FUNCTIONS["setFormat7WindowDC1394"], [1, 2])


def test_a_camera_that_answers_something_else() -> None:
    made = FrameGrabber.__new__(FrameGrabber)
    port: Any = type("Port", (), {"call": lambda self, request, timeout: ["a", "b"]})()
    made.remote, made._rpc, made._newer = "/eye", port, False
    made._functions = FunctionRequests("/eye", port, 1.0)
    with pytest.raises(RemoteProtocolError, match=r'"/eye" answers a b'):
        assert made.firewire.frame_rate
