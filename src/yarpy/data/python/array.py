"""The message that a bare numpy array becomes, or an array of a library that shares memory with it.

    1-D float64 float32 int64 int32 int16 int8    list of that kind (a Vector, for floats)
    2-D float64                                   Matrix
    2-D and 3-D of the pixels in `NATURAL`        Image
    0-D                                           the number itself
    bool, complex, every other type and shape     a blob, described: {...} (array "<f2" 2 3 4)

Rules: nothing is copied if the memory is in C's order, and nothing is converted. Arrays of texts,
dates and objects are a TypeError: they hold no numbers.
"""

from __future__ import annotations

from struct import Struct
from typing import TYPE_CHECKING, Any, Final, TypeGuard

from yarpy.data.numbers import DTYPES
from yarpy.data.python import description
from yarpy.data.python.loaded import loaded
from yarpy.data.sig.image import QUANTUM, image_blocks
from yarpy.data.sig.pixel import NATURAL, pixel_of
from yarpy.data.value import BIG, BLOB, LIST, Blocks, Float32, Int8, Int16
from yarpy.limit import ARRAY_DIMENSIONS

if TYPE_CHECKING:
    from numpy.typing import NDArray

#: numpy's name of a little-endian type -> tag of the list
LISTS: Final = {dtype: tag for tag, dtype in DTYPES.items()}
#: the types whose numbers travel as they lie in memory
NUMBERS: Final = frozenset(
    [
        "|b1",
        "|i1",
        "|u1",
        "<i2",
        "<u2",
        "<i4",
        "<u4",
        "<i8",
        "<u8",
        "<f2",
        "<f4",
        "<f8",
        "<c8",
        "<c16",
    ]
)

_HEAD = Struct("<ii")
_INT32: Final = 0x7FFFFFFF
_TABLE: Final = 64  # bytes of a row; those of pictures are longer


def blocks(array: NDArray[Any]) -> Blocks:
    """The message of an array with at least one dimension."""
    array = little(array)
    found = natural(array)
    if found is not None:
        return found
    data = memory(array)
    head = _HEAD.pack(LIST, 2) + _HEAD.pack(BLOB, len(data))
    tail = description.described(description.of_array(array.dtype.str, array.shape))
    if len(data) < BIG:
        return (head + data + tail,)
    return head, data, tail


def natural(array: NDArray[Any]) -> Blocks | None:
    """The message of YARP's own type for a little-endian array; None if there is no such type."""
    kind = array.dtype.str
    if array.ndim == 1:
        tag = LISTS.get(kind)
        if tag is None or array.size > _INT32:
            return None
        head = _HEAD.pack(LIST + tag, len(array))
        if array.nbytes < BIG or not array.flags.c_contiguous:
            return (head + array.tobytes(),)
        return head, array.data.cast("B")
    if array.ndim == 2 and kind == "<f8":
        from yarpy.data.sig.matrix import Matrix

        return Matrix(array).to_wire() if max(array.size, *array.shape) <= _INT32 else None
    if (array.ndim == 2 or array.ndim == 3) and 0 < array.nbytes <= _INT32 - (1 << 20):
        code = NATURAL.get((kind[1:], 1 if array.ndim == 2 else array.shape[2]))
        if code is not None:
            pixel = pixel_of(code)
            return image_blocks(array, pixel, _quantum(array.shape[1] * pixel.stride))
    return None


def _quantum(row: int) -> int:
    """Return the multiple that rows of so many bytes are padded to: as in C++, unless they are
    those of a table, of which the padding would be a large part."""
    return QUANTUM if row % QUANTUM == 0 or row > _TABLE else 1


def is_listed(array: NDArray[Any]) -> bool:
    """Return whether it is sent as the list that any sequence of its numbers is."""
    return array.ndim == 1 and array.dtype.newbyteorder("<").str in LISTS


def is_blob(array: NDArray[Any]) -> bool:
    """Return whether YARP has no type for it, so that it travels as it is, described."""
    kind = array.dtype.newbyteorder("<").str
    if (array.ndim == 1 and kind in LISTS) or (array.ndim == 2 and kind == "<f8"):
        return False
    if array.ndim not in (2, 3) or not array.size:
        return kind in NUMBERS and array.ndim > 0
    return kind in NUMBERS and (kind[1:], 1 if array.ndim == 2 else array.shape[2]) not in NATURAL


def little(array: NDArray[Any]) -> NDArray[Any]:
    """The array in little-endian order. TypeError if it holds no numbers, or hides some."""
    _refuse_masked(array)
    if array.dtype.str in NUMBERS:
        return array
    swapped = array.dtype.newbyteorder("<")
    if swapped.str in NUMBERS:
        return array.astype(swapped)
    raise TypeError(
        f"an array of {array.dtype} and shape {array.shape} cannot be sent: bool, integers, and "
        "real and complex numbers of up to 64 bits can; array.astype(...), or array.tolist(), "
        "makes one of them"
    )


def memory(array: NDArray[Any]) -> memoryview:
    """The numbers in C's order, as bytes; a copy only if they lie otherwise. OverflowError for
    more than a message can say."""
    if array.ndim > ARRAY_DIMENSIONS:
        raise ValueError(
            f"an array of {array.ndim} dimensions; {ARRAY_DIMENSIONS} are sent: reshape it"
        )
    if array.nbytes > _INT32:
        raise OverflowError(
            f"an array of {array.nbytes} bytes is too long for a message: send it in parts"
        )
    if not array.size:
        return memoryview(b"")
    import numpy as np

    return np.ascontiguousarray(array).reshape(-1).view("u1").data


def array_of(value: Any) -> NDArray[Any] | None:
    """An array of another library (torch, jax, cupy ...), or anything with memory to share, as one
    of numpy; None for the rest. Only what lies in another device's memory is copied, or what
    another tensor's numbers have to be computed from. TypeError for what is no array of numpy."""
    if isinstance(value, type):
        return None
    shared = hasattr(value, "__array__") or hasattr(value, "__array_interface__")
    if not shared and not hasattr(value, "__dlpack__"):
        try:
            memoryview(value)
        except TypeError:
            return None
    if hasattr(value, "detach"):
        return _array_of_tensor(value)
    import numpy as np

    if hasattr(value, "cpu"):
        value = value.cpu()
    elif hasattr(value, "get") and type(value).__module__.startswith("cupy"):
        value = value.get()
        shared = True
    if not shared and hasattr(value, "__dlpack__"):
        found: NDArray[Any] = np.from_dlpack(value)
        return found
    _refuse_masked(value)
    return np.asarray(value)


def _refuse_masked(array: Any) -> None:
    """TypeError for an array with a mask. What numpy gives for places that are masked is a number
    of its own, or the one that was there, as the array happens to lie in memory."""
    if hasattr(array, "filled"):
        raise TypeError(
            "a masked array cannot be sent, since a message has no place for its mask; "
            "array.filled(number) can, and array.data with what is masked"
        )


def _array_of_tensor(tensor: Any) -> NDArray[Any]:
    """The numbers of a tensor of torch. Its views may be lazily conjugated or negated."""
    import numpy as np

    try:
        plain = tensor.detach().cpu()
        if hasattr(plain, "resolve_conj"):
            plain = plain.resolve_conj().resolve_neg()
        return np.asarray(plain)
    except (TypeError, RuntimeError) as error:  # bfloat16, sparse, quantized, without memory ...
        kind = getattr(tensor, "dtype", "unknown type")
        raise TypeError(
            f"a tensor of {kind} cannot be sent as it is: {str(error).rstrip('.')} "
            "(tensor.float(), .to_dense() or .dequantize() may make one that can)"
        ) from error


def is_array(value: Any) -> TypeGuard[NDArray[Any]]:
    """Return whether `value` is an array of numpy; numpy is not imported for it."""
    numpy = loaded("numpy")
    return numpy is not None and isinstance(value, numpy.ndarray)


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
    raise TypeError(f"no YARP type fits a numpy {name}: send str(value), or a number made of it")
