"""Messages as lines for people."""

import numpy as np

import yarpy
from yarpy.cli.shown import is_described, summary, text_of
from yarpy.data.codec import encode
from yarpy.wire.message import DATA, Message


def message(value: object) -> Message:
    return Message(DATA, b"".join(encode(value)))


def line(value: object) -> str:
    came = message(value)
    return text_of(came, came.as_(yarpy.Bottle))


def test_lists_are_bottle_text() -> None:
    assert line(["a b", 1, [2.5, yarpy.Vocab("ok")]]) == '"a b" 1 (2.5 [ok])'
    assert line({"a": 1}) == "(a 1)"


def test_descriptions_are_left_out() -> None:
    assert is_described(message([None]).as_(yarpy.Bottle))
    assert not is_described(message([1]).as_(yarpy.Bottle))
    assert line([None, (1, 2), 1j]) == "() (1 2) (0.0 1.0)"
    assert line(np.array([[1, 2], [3, 4]], "i8")) == "((1 2) (3 4))"
    assert line([np.zeros((40, 2), "u1")]) == '"<array uint8 40x2>"'


def test_large_things_are_told_in_short() -> None:
    assert line(np.zeros((3, 7), "i8")) == "<array int64 3x7>"
    assert line(yarpy.Image(np.zeros((4, 5, 3), "u1"))) == "<image rgb 5x4, 124 bytes>"
    assert summary(yarpy.Sound([1, 2], 8000)) == "<sound 8000 Hz, 1 channel, 2 samples>"


def test_clouds() -> None:
    cloud = message(yarpy.PointCloud(np.zeros((2, 3)))).value
    assert summary(cloud) == "<pointcloud xyz 2x1, 2 points>"
