"""Which message a bare numpy array is.

    1-D float64 float32 int64 int32 int16 int8    list of that kind (a Vector, for float64)
    1-D bool uint8 uint16 uint32 float16          list of the smallest kind that holds every value
    1-D uint64                                    list of int64; OverflowError for larger values
    2-D float64 float32                           Matrix
    2-D uint8, uint16                             image `mono`, `mo16`
    3-D uint8 with 1, 3 or 4 channels             image `mono`, `rgb`, `rgba`
    3-D float32 with 3 channels                   image `rgb.`
    0-D                                           the number itself

Anything else is a TypeError that names the types to wrap it in. The pixels of images and the
numbers of large vectors are not copied if the memory layout allows it.
"""

from __future__ import annotations

from struct import Struct
from typing import TYPE_CHECKING, Any, Final

from yarpy.data.image import image_blocks
from yarpy.data.pixel import pixel_of
from yarpy.data.value import (
    BIG,
    FLOAT32,
    FLOAT64,
    INT8,
    INT16,
    INT32,
    INT64,
    LIST,
    Blocks,
    Float32,
    Int8,
    Int16,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

#: numpy's name of a little-endian type -> tag of the list
_LISTS: Final = {
    "<f8": FLOAT64,
    "<f4": FLOAT32,
    "<i8": INT64,
    "<i4": INT32,
    "<i2": INT16,
    "|i1": INT8,
}
_WIDER: Final = {
    "|b1": "<i1",
    "|u1": "<i2",
    "<u2": "<i4",
    "<u4": "<i8",
    "<u8": "<i8",
    "<f2": "<f4",
}
_IMAGES: Final = {
    ("|u1", 1): "mono",
    ("<u2", 1): "mo16",
    ("|u1", 3): "rgb",
    ("|u1", 4): "rgba",
    ("<f4", 3): "rgb.",
}

_HEAD = Struct("<ii")


def blocks(array: NDArray[Any]) -> Blocks:
    """The wire blocks of an array with at least one dimension."""
    kind = array.dtype.str
    if kind[0] == ">":
        return blocks(array.astype(array.dtype.newbyteorder("<")))
    if array.ndim == 1:
        if kind in _WIDER:
            if kind == "<u8" and array.size and int(array.max()) > 0x7FFFFFFFFFFFFFFF:
                raise OverflowError("an array of uint64 holds a value beyond 63 bits")
            array = array.astype(_WIDER[kind])
            kind = array.dtype.str
        tag = _LISTS.get(kind)
        if tag is not None:
            head = _HEAD.pack(LIST + tag, len(array))
            if array.nbytes < BIG or not array.flags.c_contiguous:
                return (head + array.tobytes(),)
            return head, array.data.cast("B")
    elif array.ndim == 2 and kind in ("<f8", "<f4"):
        from yarpy.data.matrix import Matrix

        return Matrix(array).to_wire()
    elif array.ndim == 2 or array.ndim == 3:
        code = _IMAGES.get((kind, 1 if array.ndim == 2 else array.shape[2]))
        if code is not None:
            return image_blocks(array, pixel_of(code))
    raise TypeError(
        f"no YARP type fits an array of {array.dtype} and shape {array.shape}; say what is "
        "meant with Vector(array), Matrix(array) or Image(array, code)"
    )


def scalar(value: Any) -> int | float | bool | str | bytes:
    """A numpy number as a plain Python one; the odd widths are kept."""
    name = value.dtype.name
    plain = value.item()
    if name == "int8":
        return Int8(plain)
    if name == "int16":
        return Int16(plain)
    if name == "float32" or name == "float16":
        return Float32(plain)
    if isinstance(plain, (int, float, bool, str, bytes)):
        return plain
    raise TypeError(f"no YARP type fits a numpy {name}")
