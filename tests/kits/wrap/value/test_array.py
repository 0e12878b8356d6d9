"""Arrays and pictures: what YARP brings back equal, and which pixels a picture has."""

from __future__ import annotations

from typing import Annotated, Any

import numpy as np
import pytest
from numpy.typing import NDArray
from support.table import for_each

import yarpy
from yarpy.kits.wrap.value.array import Image
from yarpy.kits.wrap.value.hint import shape_of
from yarpy.kits.wrap.value.native import NOT_NATIVE
from yarpy.wire.message import DATA, Message, Packet

PICTURE = np.arange(18, dtype="u1").reshape(2, 3, 3)


def through(hint: Any, value: object) -> object:
    """What YARP brings back."""
    shape = shape_of(hint)
    native = shape.native(shape.dump(value))
    assert native is not NOT_NATIVE
    message = Message(DATA, b"".join(Packet(native).blocks))
    return shape.load(shape.read(message))


@for_each(
    ["f8", "f4", "i8", "i4", "i2", "i1", "u1", "u2", "f2", ">f8", "?"],
    [(3,), (4,), (2, 3), (2, 3, 3), (2, 3, 4), (2, 3, 1), (0,), (2, 2, 2, 2)],
)
def test_arrays_keep_type_and_shape(kind: str, shape: tuple[int, ...]) -> None:
    """Whatever is native comes back with both."""
    array = np.ones(shape, kind)
    found = shape_of(NDArray[Any])
    native = found.native(found.dump(array))
    if native is NOT_NATIVE:
        assert (kind, len(shape)) not in {("f8", 1), ("f8", 2), ("f4", 1), ("u1", 2)} or 0 in shape
        return
    back = through(np.ndarray, array)
    assert isinstance(back, np.ndarray)
    assert back.dtype == array.dtype and np.array_equal(back, array) and back.shape == shape


def test_pictures_have_the_pixels_of_their_hint() -> None:
    bgr = shape_of(Annotated[np.ndarray, Image("bgr")])
    image = bgr.dump(PICTURE)
    assert str(image.code) == "bgr"
    wide = np.zeros((2, 8, 3), "u1")  # rows without padding are not copied
    assert np.shares_memory(bgr.dump(wide).array, wide)
    assert np.array_equal(bgr.load(yarpy.Image(PICTURE)), PICTURE[..., ::-1])
    assert np.array_equal(bgr.load(PICTURE), PICTURE)
    with pytest.raises(TypeError, match="picture"):
        bgr.dump(np.zeros((2, 3, 5), "u1"))
    with pytest.raises(ValueError, match="1 to 100"):
        Image("rgb", jpeg=0)
    with pytest.raises(ValueError, match="nonsense"):
        Image("nonsense")
