"""Which message a bare numpy array is.

    1-D float64 float32 int64 int32 int16 int8    list of that kind (a Vector, for float64)
    1-D bool uint8 uint16 uint32 float16          list of the smallest kind that holds every value
    1-D uint64                                    list of int64; OverflowError for what is beyond
    2-D float64 float32                           Matrix
    2-D uint8, uint16                             image `mono`, `mo16`
    3-D uint8 with 1, 3 or 4 channels             image `mono`, `rgb`, `rgba`
    3-D float32 with 3 channels                   image `rgb.`
    0-D                                           the number itself

Anything else is a TypeError that names the types to wrap it in. The pixels of images and the
numbers of large vectors are not copied if the memory layout allows it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from yarpy.data.value import Float32, Int8, Int16

if TYPE_CHECKING:
    from numpy.typing import NDArray

_WIDER = {
    "bool": "int8",
    "uint8": "int16",
    "uint16": "int32",
    "uint32": "int64",
    "uint64": "int64",
    "float16": "float32",
}
_SAME = ("float64", "float32", "int64", "int32", "int16", "int8")
_IMAGES = {
    ("uint8", 1): "mono",
    ("uint16", 1): "mo16",
    ("uint8", 3): "rgb",
    ("uint8", 4): "rgba",
    ("float32", 3): "rgb.",
}


def blocks(array: NDArray[Any]) -> tuple[bytes | memoryview, ...]:
    """The wire blocks of an array with at least one dimension."""
    name = array.dtype.name
    if array.ndim == 1:
        from yarpy.data.vector import Vector

        if name in _SAME:
            return Vector(array, name).to_wire()
        wider = _WIDER.get(name)
        if wider is not None:
            if name == "uint64" and array.size and int(array.max()) > 0x7FFFFFFFFFFFFFFF:
                raise OverflowError("an array of uint64 holds a value beyond 63 bits")
            return Vector(array, wider).to_wire()
    elif array.ndim == 2 and name in ("float64", "float32"):
        from yarpy.data.matrix import Matrix

        return Matrix(array).to_wire()
    elif array.ndim == 2 or array.ndim == 3:
        code = _IMAGES.get((name, 1 if array.ndim == 2 else array.shape[2]))
        if code is not None:
            from yarpy.data.image import Image

            return Image(array, code).to_wire()
    raise TypeError(
        f"no YARP type goes with an array of {name} and shape {array.shape}; say what is meant "
        "with Vector(array), Matrix(array) or Image(array, code)"
    )


def scalar(value: Any) -> int | float | bool | str | bytes:
    """What a numpy number is without numpy; the odd widths stay."""
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
    raise TypeError(f"no YARP type goes with a numpy {name}")
