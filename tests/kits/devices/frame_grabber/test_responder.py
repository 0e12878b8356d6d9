import threading

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.camera import FakeCamera

from yarpy.data.bottle import Bottle
from yarpy.data.sig.image import Image
from yarpy.data.value import Vocab
from yarpy.kits.devices.access import Access
from yarpy.kits.devices.frame_grabber.responder import FrameGrabberResponder
from yarpy.kits.devices.refusal import DeviceErrorLog, Refused


def responder(camera):
    part = Access(camera, 0, DeviceErrorLog("/eye"), threading.Lock())

    def grab():
        if not hasattr(camera, "image"):
            raise Refused("the camera gave no image")
        return Image(camera.image())

    return FrameGrabberResponder(part, grab, "/eye")


def answers(camera):
    it = responder(camera)
    return lambda text: it.answer(Bottle.from_text(text)).to_text()


SPEC = [
    ("[fgi] [get] [w]", "[fgi] [w] [is] 64"),
    ("[fgi] [get] [h]", "[fgi] [h] [is] 48"),
    ("fgi get h", "[fgi] [h] [is] 48"),
    ("[visr] [get] [w]", "[visr] [w] [is] 64"),
    ("[visr] [get] [h]", "[visr] [h] [is] 48"),
    ("[visr] [get] [res]", "[visr] [res] [is] 64 48"),
    ("[visr] [set] [res] 32 24", "[visr] [set] 1"),
    ("[visr] [get] [res]", "[visr] [res] [is] 32 24"),
    ("[visr] [set] [res] 0 24", "[visr] [set] 0"),
    ("[visr] [set] [res] 64 48", "[visr] [set] 1"),
    ("[visr] [get] [fov]", "[visr] [fov] [is] 1.0 2.0"),
    ("[visr] [set] [fov] 60 45", "[visr] [set] 1"),
    ("[visr] [get] [fov]", "[visr] [fov] [is] 60.0 45.0"),
    ("[visr] [get] [conf]", "[visr] [conf] [is] 2 128 128 60.0 [rgb] 256 256 30.0 [bgr]"),
    (
        "[visr] [get] [intp]",
        "[visr] [intp] [is] ((distortionModel FishEye) (focalLengthX 4.0))",
    ),
    ("[visr] [get] [mirr]", "[visr] [mirr] [is] 0"),
    ("[visr] [set] [mirr] 1", "[visr] [set] 1"),
    ("[visr] [get] [mirr]", "[visr] [mirr] [is] 1"),
    ("[visr] [get] [bogus]", "[fail]"),
    ("[visr] [set] [bogus] 1", "[fail]"),
    ("[visr] [bogus] [res]", "[fail]"),
    ("[fgc] [has] [feat] 0", "[fgc] [has] [feat] 1952540006 1"),
    ("[fgc] [has] [feat] 1", "[fgc] [has] [feat] 1952540006 0"),
    ("[fgc] [has] [auto] 8", "[fgc] [has] [feat] 1869903201 1"),
    ("[fgc] [has] [man] 8", "[fgc] [has] [feat] 7233901 1"),
    ("[fgc] [has] [onof] 12", "[fgc] [has] [feat] 1718578799 1"),
    ("[fgc] [has] [onep] 0", "[fgc] [has] [feat] 1885695599 1"),
    ("[fgc] [get] [feat] 0", "[fgc] [feat] [is] 0.5"),
    ("[fgc] [set] [feat] 0 0.25", "[nak]"),
    ("[fgc] [get] [feat] 0", "[fgc] [feat] [is] 0.25"),
    ("[fgc] [get] [fea2] 3", "[fgc] [fea2] [is] 0.25 0.75"),
    ("[fgc] [set] [fea2] 3 1 2", "[nak]"),
    ("[fgc] [get] [fea2] 3", "[fgc] [fea2] [is] 1.0 2.0"),
    ("[fgc] [get] [mode] 8", "[fgc] [mode] [is] 2"),
    ("[fgc] [set] [mode] 8 1", "[nak]"),
    ("[fgc] [get] [mode] 8", "[fgc] [mode] [is] 1"),
    ("[fgc] [get] [actv] 12", "[fgc] [actv] [is] 1"),
    ("[fgc] [set] [actv] 12 0", "[nak]"),
    ("[fgc] [get] [actv] 12", "[fgc] [actv] [is] 0"),
    ("[fgc] [set] [onep] 0", "[nak]"),
    ("[fgc] [get] [camd]", '[fgc] [camd] [is] 2 "a fake"'),
    ("help", "[nak]"),
    ("bogus", "[nak]"),
    ("", "[nak]"),
]


def test_replies():
    camera = FakeCamera()
    ask = answers(camera)
    for request, reply in SPEC:
        assert (request, ask(request)) == (request, reply)
    assert camera.pushed == ["brightness"]
    assert camera.mirror is True


def test_images_as_lists():
    ask = responder(FakeCamera(6, 3)).answer
    reply = ask(Bottle.from_text("[fgi] [get] [imgr]"))
    assert reply[:3] == ["fgi", "imgr", "is"]
    assert reply[3][:3] == ["mat", "rgb", [3, 72, 8, 6, 3]]
    assert len(reply[3][3]) == 72
    image = Image.from_wire(reply[3].to_bytes())
    assert image.array[0, 5].tolist() == [255, 255, 255]


def test_rectangles_contain_their_corners():
    ask = responder(FakeCamera()).answer
    for corners in ("62 0 63 9", "63 9 62 0"):
        reply = ask(Bottle.from_text(f"[fgi] [get] [crop] 0 ({corners})"))
        image = Image.from_wire(reply[3].to_bytes())
        assert image.array.shape == (10, 2, 3)
        assert image.array[:, 1].min() == 255 and image.array[:, 0].max() < 255
    for bad in ("0 (1 2)", "1 (0 0 1 1)", "0 (0 0 64 1)", "0 (-1 0 1 1)", "0 (a b c d)", "0", ""):
        assert ask(Bottle.from_text(f"[fgi] [get] [crop] {bad}"))[0] == "fail"


def test_grey_cameras_give_raw_images():
    class Grey:
        def image(self):
            return np.full((4, 8), 7, "uint8")

    ask = responder(Grey()).answer
    assert ask(Bottle.from_text("[fgir] [get] [imgr]"))[3][1:3] == ["mono", [1, 32, 8, 8, 4]]
    assert ask(Bottle.from_text("[fgi] [get] [imgr]"))[3][1:3] == ["rgb", [3, 96, 8, 8, 4]]
    assert ask(Bottle.from_text("[fgir] [get] [w]")).to_text() == "[fgir] [w] [is] 8"
    colour = responder(FakeCamera()).answer(Bottle.from_text("[fgir] [get] [imgr]"))
    assert colour[0] == "fail" and "no raw" in colour[1]


def test_the_least():
    class Bare:
        def image(self):
            return np.zeros((2, 4, 3), "uint8")

    ask = answers(Bare())
    assert ask("[visr] [get] [res]") == "[visr] [res] [is] 4 2"
    assert ask("[visr] [set] [res] 8 4") == "[visr] [set] 0"
    assert ask("[visr] [get] [fov]") == "[fail]"
    assert ask("[fgc] [has] [feat] 0") == "[fgc] [has] [feat] 1952540006 0"
    assert ask("[fgc] [get] [feat] 0").startswith("[fail]")
    assert ask("[fgc] [set] [feat] 0 1").startswith("[fail]")
    assert ask("[fgc] [get] [camd]").startswith("[fail]")


BAD = [
    "[fgi]", "[fgi] [get]", "[fgi] [get] [bogus]", "[fgi] [set] [w] 5", "[visr]", "[visr] [get]",
    "[visr] [set] [res]", "[visr] [set] [res] x y", "[visr] [set] [fov] 1", "[visr] [set] [mirr]",
    "[visr] [set] [mirr] x", "[visr] [set] [fov] nan 1", "[fgc]", "[fgc] [set]",
    "[fgc] [set] [feat]", "[fgc] [set] [feat] 0", "[fgc] [set] [feat] 0 x",
    "[fgc] [set] [feat] 1 0.5", "[fgc] [set] [feat] 99 0.5", "[fgc] [set] [feat] -1 0.5",
    "[fgc] [set] [feat] 0 inf", "[fgc] [set] [fea2] 3 1", "[fgc] [set] [mode] 8 0",
    "[fgc] [set] [mode] 8 3",
    "[fgc] [set] [mode] 0 1", "[fgc] [set] [bogus] 0 1", "[fgc] [get] [bogus] 0",
    "[fgc] [get] [feat] 3", "[fgc] [get] [fea2] 0", "[fgc] [has] [bogus] 0", "[fgc] [bogus] x 0",
]  # fmt: skip


@pytest.mark.parametrize("request_", BAD)
def test_bad_input_leaves_the_camera_alone(request_):
    camera = FakeCamera()
    before = repr(vars(camera))
    assert answers(camera)(request_).startswith("[fail]")
    assert repr(vars(camera)) == before


words = st.sampled_from(
    sorted({word.strip("[]") for text, _ in SPEC for word in text.split() if word[0] == "["})
)
elements = st.one_of(
    words, words.map(Vocab), st.integers(-2, 30), st.floats(), st.text(max_size=4), st.booleans(),
    st.lists(st.integers(-2, 70), max_size=5), st.none(), st.binary(max_size=3),
)  # fmt: skip


@settings(max_examples=300)
@given(st.lists(elements, max_size=6))
def test_whatever_is_asked_there_is_a_reply(request_):
    reply = responder(FakeCamera(8, 8)).answer(request_)
    assert reply[0] in ("nak", "fail", "fgi", "fgir", "visr", "fgc")
    assert reply.to_bytes()
