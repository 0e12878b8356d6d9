"""The types of messages, by their first bytes."""

import numpy as np
import pytest

import yarpy
from yarpy.data import codec
from yarpy.kits.record.kind import kind_of


@pytest.mark.parametrize(
    ("value", "kind"),
    [
        ([1, 2.5, "x"], "yarp/bottle"),
        ([], "yarp/bottle"),
        ("word", "yarp/bottle"),
        ([3, 2, [1, 2]], "yarp/bottle"),
        ([1, 2, 3, 4], "yarp/bottle"),
        (yarpy.Vector([1.5, 2.5]), "yarp/vector"),
        (yarpy.Vector([]), "yarp/vector"),
        (yarpy.Matrix(np.zeros((2, 3))), "yarp/matrix"),
        (yarpy.Image(np.zeros((4, 6, 3), "u1")), "yarp/image"),
        (yarpy.Sound(np.zeros((2, 10), "i2"), 8000), "yarp/sound"),
        (yarpy.Stamp(1, 2.0), "yarp/bottle"),
        (yarpy.PointCloud(np.zeros((2, 3)), "xyz"), "yarp/pointcloud"),
    ],
)
def test_types(value: object, kind: str) -> None:
    payload = b"".join(map(bytes, codec.encode(value)))
    assert kind_of(payload) == kind
    assert kind_of(memoryview(payload)) == kind


@pytest.mark.parametrize("size", range(40))
def test_what_is_cut_off_is_no_error(size: int) -> None:
    whole = b"".join(codec.encode(yarpy.Matrix(np.zeros((2, 3)))))
    assert kind_of(whole[:size]).startswith("yarp/")
    assert kind_of(b"\xff" * size) == "yarp/bottle"
