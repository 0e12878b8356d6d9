"""Messages as clients get them."""

import json

import numpy as np
import pytest
from support.recordings import START, payload_of

import yarpy
from yarpy.kits.record.recorded import Recorded
from yarpy.kits.record.view.spelling import NUMBERS, TEXT, channel_of, numbers_of, picture, spelled


def recorded(value: object, envelope: str = "") -> Recorded:
    return Recorded("/a", START, START, envelope, payload_of(value))


@pytest.mark.parametrize(
    ("value", "numbers"),
    [
        ([1, 2.5], [1, 2.5]),
        (yarpy.Vector([0.5, 1.5]), [0.5, 1.5]),
        ([[1, [2]], "word"], [1, 2]),
        (["two", "words", 1], []),
        ([[["a", 1], ["b", 2]]], []),
        ([*range(200)], [*range(NUMBERS)]),
        (["word"] * 200, []),
        (yarpy.Image(np.zeros((2, 2), "u1")), []),
        ([], []),
    ],
)
def test_numbers(value: object, numbers: list[float]) -> None:
    assert numbers_of(recorded(value)) == numbers


def test_json() -> None:
    found = json.loads(spelled(recorded([float("nan"), 7], "5 1.5"), "yarp/bottle"))
    assert found["v"] == [None, 7] and found["envelope"] == "5 1.5" and found["t"] == START / 1e9
    long = json.loads(spelled(recorded(["x" * 9000]), "yarp/bottle"))
    assert "v" not in long and TEXT < len(long["text"]) < TEXT + 50
    broken = Recorded("/a", START, START, "", b"\x00\x01\x00\x00\x05\x00\x00\x00x")
    assert "cannot be read" in json.loads(spelled(broken, "yarp/bottle"))["text"]
    assert channel_of(3, "/a", "yarp/bottle").encoding == "json"
    points = json.loads(spelled(recorded(yarpy.PointCloud([[1.0, 2, 3]])), "yarp/pointcloud"))
    assert points["text"].startswith("PointCloud(") and points["cloud"]["of"] == 1


def test_pictures() -> None:
    image = recorded(yarpy.Image(np.zeros((4, 6, 3), "u1")))
    data = picture(image)
    assert data[:2] == b"\xff\xd8" and data in spelled(image, "yarp/image")
    # A port may send something else now and then.
    assert picture(recorded([1])) == b"" and spelled(recorded([1]), "yarp/image")
    assert channel_of(3, "/a", "yarp/image").schema_name == "foxglove.CompressedImage"
