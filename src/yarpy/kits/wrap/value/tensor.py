"""A tensor in the file that `torch.save` makes of it, read without unpickling and without torch.

    archive/data.pkl     a pickle, which says type, place, shape and strides
    archive/data/0       the numbers

Rules: of the pickle only what such a file needs is understood, and nothing in it is ever called: it
is a text like any other. Its references may form a graph that is exponential when it is spelled
out, so that nothing of it is printed, compared or named before its type is known. Files are not
compressed, so nothing in one is larger than it but what is repeated: that is a view, of limited
size, and stays one.
"""

from __future__ import annotations

import io
import math
import pickletools
import struct
import zipfile
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from yarpy.errors import DecodeError
from yarpy.limit import TENSOR_DIMENSIONS, TENSOR_OPCODES, TENSOR_PICKLE, limits

if TYPE_CHECKING:
    from numpy.typing import NDArray

_STORAGE: Final = "storage"

BFLOAT16: Final = "bfloat16"  # which numpy does not have: the upper halves of float32
_NUMBERS: Final = {
    "Float": "f4",
    "Double": "f8",
    "Half": "f2",
    "BFloat16": "u2",
    "Long": "i8",
    "Int": "i4",
    "Short": "i2",
    "Char": "i1",
    "Byte": "u1",
    "Bool": "?",
    "ComplexFloat": "c8",
    "ComplexDouble": "c16",
}
_WRONG: Final = (
    ValueError,
    TypeError,
    LookupError,
    OverflowError,
    zipfile.BadZipFile,
    struct.error,
)


class Tensor(NamedTuple):
    """`array` has the numbers; those of `kind` BFLOAT16 as uint16. `grad`: it wants gradients."""

    array: NDArray[Any]
    kind: str
    grad: bool


def read(data: bytes) -> Tensor:
    """The tensor in a file. Raises DecodeError."""
    try:
        return _read(data)
    except DecodeError:
        raise
    # pickletools warns of odd escapes, which is an exception where the program says so
    except (*_WRONG, RuntimeError, NotImplementedError, EOFError, Warning) as error:
        raise DecodeError(f"not a file of torch with a tensor: {error}") from error


def as_floats(tensor: Tensor) -> NDArray[Any]:
    """The numbers in a type that numpy has."""
    import numpy as np

    array = tensor.array
    if tensor.kind != BFLOAT16:
        return array
    # Of what is repeated, the numbers alone.
    once = array[tuple(slice(None if step else 1) for step in array.strides)]
    return np.broadcast_to((once.astype("u4") << 16).view("f4"), array.shape)


class _Name(str):
    """A name that a pickle would import."""


class _Made(NamedTuple):
    """A call that a pickle would make, and its arguments."""

    what: Any
    arguments: Any


class _Reference(NamedTuple):
    """A reference of a pickle to something outside of itself."""

    said: Any


def _read(data: bytes) -> Tensor:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        members = {item.filename.partition("/")[2]: item for item in archive.infolist()}
        pickled = members["data.pkl"]
        if any(item.compress_type != zipfile.ZIP_STORED for item in members.values()):
            raise DecodeError("a file of torch that is compressed")
        if pickled.file_size > TENSOR_PICKLE:
            raise DecodeError("a file of torch with much more than a tensor")
        found = _value(archive.read(pickled))
        wanted = False
        if isinstance(found, _Made) and found.what == "torch._utils _rebuild_parameter":
            found, wanted = found.arguments[:2]
        if not isinstance(found, _Made) or found.what != "torch._utils _rebuild_tensor_v2":
            raise DecodeError("a file of torch that holds no tensor")
        place, offset, shape, strides, grad = found.arguments[:5]
        if not isinstance(place, _Reference):
            raise DecodeError("a file of torch whose tensor has no storage")
        word, storage, key = place.said[:3]
        if not (type(word) is type(key) is str and isinstance(storage, _Name) and word == _STORAGE):
            raise DecodeError("a file of torch whose tensor has no storage")
        if not all(map(_is_count, (offset, *_row(shape), *_row(strides)))):
            raise DecodeError("a tensor whose shape or strides are no numbers, or negative")
        name = storage.removeprefix("torch ").removesuffix("Storage")
        if name not in _NUMBERS:
            raise DecodeError(f"a tensor of {storage[:80]}")
        order = "<"
        if "byteorder" in members and archive.read(members["byteorder"]) == b"big":
            order = ">"
        numbers = archive.read(members[f"data/{key}"])
    array = _array(numbers, order + _NUMBERS[name], (offset, shape, strides))
    return Tensor(
        array, BFLOAT16 if name == "BFloat16" else array.dtype.name, (wanted or grad) is True
    )


def _row(values: Any) -> tuple[Any, ...]:
    return values if type(values) is tuple and len(values) <= TENSOR_DIMENSIONS else (None,)


def _is_count(value: Any) -> bool:
    return type(value) is int and 0 <= value < 1 << 63


def _array(
    numbers: bytes, dtype: str, layout: tuple[int, tuple[int, ...], tuple[int, ...]]
) -> NDArray[Any]:
    """The numbers in their order. Where they are repeated (strides of 0) it is a view, which takes
    no memory; but a copy of it would."""
    import numpy as np

    offset, shape, strides = layout
    stored = np.frombuffer(numbers, dtype)
    stored = stored.astype(stored.dtype.newbyteorder("="), copy=False)
    if len(shape) != len(strides):
        raise DecodeError(f"a tensor of the shape {shape} with strides of {strides}")
    count = math.prod(shape)
    if not count:
        return np.empty(shape, stored.dtype)
    last = offset + sum((n - 1) * step for n, step in zip(shape, strides, strict=True))
    apart = math.prod(n for n, step in zip(shape, strides, strict=True) if step)
    if max(last, apart - 1) >= len(stored):
        raise DecodeError(f"a tensor of the shape {shape} in {len(stored)} numbers")
    most = max(limits().unpacked, len(numbers))
    if count * max(stored.itemsize, 4) > most and count > len(stored):
        raise DecodeError(
            f"a tensor of the shape {shape} that repeats {len(stored)} numbers: it takes more than "
            f"{most} bytes (YARPY_MAX_UNPACKED)"
        )
    steps = tuple(step * stored.itemsize for step in strides)
    view = np.lib.stride_tricks.as_strided(stored[offset:], shape, steps, writeable=False)
    return view if count > len(stored) else np.array(view, order="C")


def _value(data: bytes) -> Any:
    """Return the value of a pickle, as plain values and the tuples above. Nothing is imported or
    called."""
    stack: list[Any] = []
    marks: list[int] = []
    memo: dict[int, Any] = {}
    for count, (code, given) in enumerate(_opcodes(data)):
        if count > TENSOR_OPCODES:
            break
        if code == "STOP":
            return stack.pop()
        if code in ("PROTO", "FRAME"):
            continue
        if code == "MARK":
            marks.append(len(stack))
        elif code in ("BINPUT", "LONG_BINPUT", "MEMOIZE"):
            memo[len(memo) if given is None else given] = stack[-1]
        elif code in ("BINGET", "LONG_BINGET"):
            stack.append(memo[given])
        elif code == "GLOBAL":
            stack.append(_Name(given))
        elif code in _CONSTANTS:
            stack.append(_CONSTANTS[code])
        elif code in _GIVEN:
            stack.append(given)
        elif code == "TUPLE":
            begin = marks.pop()
            stack[begin:] = [tuple(stack[begin:])]
        elif code in _TUPLES:
            begin = len(stack) - _TUPLES[code]
            if begin < 0:
                break
            stack[begin:] = [tuple(stack[begin:])]
        elif code == "BINPERSID":
            stack.append(_Reference(stack.pop()))
        elif code == "REDUCE":
            arguments = stack.pop()
            stack.append(_Made(stack.pop(), arguments))
        else:
            raise DecodeError(f"a file of torch with more than a tensor: {code}")
    raise DecodeError("a file of torch with more than a tensor")


_CONSTANTS: Final = {"NONE": None, "NEWTRUE": True, "NEWFALSE": False, "EMPTY_TUPLE": ()}
_GIVEN: Final = frozenset(
    ("BINUNICODE", "SHORT_BINUNICODE", "BININT", "BININT1", "BININT2", "LONG1")
)
_TUPLES: Final = {"TUPLE1": 1, "TUPLE2": 2, "TUPLE3": 3}


def _opcodes(data: bytes) -> Iterator[tuple[str, Any]]:
    for opcode, given, _ in pickletools.genops(data):
        yield opcode.name, given
