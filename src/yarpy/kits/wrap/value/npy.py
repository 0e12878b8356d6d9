"""The .npy format: an array as bytes, as `numpy.save` writes it and Wrapyfi sends it.

Rules: arrays of Python objects are refused on both sides, since reading them runs code. The size
that a header announces is compared with the bytes that are there before memory is taken; an array
that was read is a view of them.
"""

from __future__ import annotations

import io
from tokenize import TokenError
from typing import TYPE_CHECKING, Any, Final

from yarpy.errors import DecodeError, Truncated

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


#: what numpy raises for headers that are none
_WRONG: Final = (
    *(ValueError, TypeError, SyntaxError, KeyError, OverflowError, RecursionError, MemoryError),
    TokenError,
)


def to_npy(array: NDArray[Any]) -> bytes:
    """The array with its header. Raises TypeError for an array of objects."""
    import numpy as np

    if array.dtype.hasobject:
        raise TypeError(f"an array of {array.dtype} holds Python objects, which cannot be sent")
    out = io.BytesIO()
    np.lib.format.write_array(out, array, allow_pickle=False)
    return out.getvalue()


def from_npy(data: bytes) -> NDArray[Any]:
    """The array over `data`, read-only. Raises DecodeError, Truncated."""
    import numpy as np

    source = io.BytesIO(data)
    try:
        version = np.lib.format.read_magic(source)
        read = {
            (1, 0): np.lib.format.read_array_header_1_0,
            (2, 0): np.lib.format.read_array_header_2_0,
        }.get(version)
        if read is None:
            raise DecodeError(f"an array in version {version} of .npy: 1.0 and 2.0 are read")
        shape, fortran, dtype = read(source)
    except DecodeError:
        raise
    except _WRONG as error:
        raise DecodeError(f"not an array in the .npy format: {error}") from error
    if dtype.hasobject:
        raise DecodeError("an array of Python objects: reading it would run code of its sender")
    start = source.tell()
    count = counted(shape, dtype)
    size = count * dtype.itemsize
    if len(data) - start < size:
        raise Truncated(f"the array takes {size} bytes, here are {len(data) - start}", start + size)
    try:
        flat = np.frombuffer(data, dtype, count, start) if size else np.empty(count, dtype)
        return flat.reshape(shape, order="F" if fortran else "C")
    except _WRONG as error:
        raise DecodeError(f"not an array: {error}") from error


def counted(shape: Any, dtype: np.dtype[Any]) -> int:
    """The elements of an array of this shape. DecodeError for a shape that there is none of, and
    for elements without a size: numpy gives them one, so that their memory has no limit."""
    count = 1
    for length in shape:
        if type(length) is not int or length < 0:
            raise DecodeError(f"an array of the shape {shape!s:.200}")
        count *= length
    if count and not dtype.itemsize:
        raise DecodeError(f"{count} elements of the type {dtype.str}, which has no size")
    return count
