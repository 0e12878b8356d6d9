"""Values that look at memory can be copied, pickled, and sent to other processes."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable

import numpy as np
import pytest

from yarpy.data.pickling import Wired
from yarpy.data.sig.image import FlexImage, Image
from yarpy.data.sig.matrix import Matrix
from yarpy.data.sig.pointcloud import PointCloud
from yarpy.data.sig.sound import Sound
from yarpy.data.sig.vector import Vector

WAYS: list[Callable[[Wired], Wired]] = [
    copy.copy,
    copy.deepcopy,
    lambda value: pickle.loads(pickle.dumps(value)),
]
PIXELS = np.arange(5 * 7 * 3, dtype=np.uint8).reshape(5, 7, 3)
VALUES = [
    Vector([1.5, 2.0]),
    Vector([1, 2, 3], "int32"),
    Vector([]),
    Vector(np.arange(10_000.0)),
    Matrix([[1.0, 2.0], [3.0, 4.0]]),
    Image(PIXELS),
    Image(PIXELS[:, :, 0], "mono"),
    FlexImage(PIXELS),
    Sound(np.arange(20, dtype=np.int16).reshape(10, 2), 8000),
    PointCloud(np.zeros((4, 3)), "xyz", dense=False),
]


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("value", VALUES, ids=lambda value: type(value).__name__)
def test_copy_is_the_same_value(value: Wired, way: Callable[[Wired], Wired]) -> None:
    found = way(value)
    assert type(found) is type(value)
    assert b"".join(found.to_wire()) == b"".join(value.to_wire())


@pytest.mark.parametrize("way", WAYS)
def test_copy_has_memory_of_its_own(way: Callable[[Wired], Wired]) -> None:
    value = Image(PIXELS.copy())
    found = way(value)
    assert isinstance(found, Image)
    found.array[0, 0, 0] = 99
    assert value.array[0, 0, 0] == 0
