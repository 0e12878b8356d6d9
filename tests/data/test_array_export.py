"""Every value with numbers is an array for other libraries, over its own memory."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from yarpy.data import codec
from yarpy.data.bottle import Bottle
from yarpy.data.sig.image import Image
from yarpy.data.sig.matrix import Matrix
from yarpy.data.sig.vector import Vector

VALUES = [
    Vector([1.0, 2.0]),
    Matrix(np.eye(3)),
    Image(np.arange(24, dtype="u1").reshape(2, 4, 3)),
    codec.decode(bytearray(b"".join(codec.encode(np.arange(2000, dtype="i4"))))),
]


@pytest.mark.parametrize("value", VALUES, ids=lambda value: type(value).__name__)
def test_over_the_same_memory(value: Any) -> None:
    assert np.shares_memory(np.asarray(value), value.array)
    if value.array.flags.writeable:  # numpy hands out no other memory in this way
        assert np.shares_memory(np.from_dlpack(value), value.array)
    assert value.__dlpack_device__() == (1, 0)
    assert np.asarray(value, "c16").dtype == "c16" and np.asarray(value, "f8").tolist() == (
        value.array.tolist()
    )
    assert not np.shares_memory(np.array(value), value.array)


def test_a_bottle_of_numbers() -> None:
    assert np.from_dlpack(Bottle([1, 2.5])).tolist() == [1, 2.5]


def test_what_is_no_array() -> None:
    with pytest.raises((BufferError, TypeError)):
        np.from_dlpack(Bottle(["x", "y"]))
