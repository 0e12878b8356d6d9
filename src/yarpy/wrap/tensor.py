"""A tensor in the file that `torch.save` makes of it, read without unpickling and without torch.

    archive/data.pkl     a pickle, which says type, place, shape and strides
    archive/data/0       the numbers

Rules: of the pickle only what such a file needs is understood, and nothing in it is ever called: it
is a text like any other. Files are not compressed, so nothing in one is larger than it.
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

if TYPE_CHECKING:
    from numpy.typing import NDArray

MAX_PICKLE: Final = 1 << 16  # bytes
MAX_OPCODES: Final = 1000

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
    except (*_WRONG, RuntimeError, NotImplementedError, EOFError) as error:
        raise DecodeError(f"not a file of torch with a tensor: {error}") from error


def as_floats(tensor: Tensor) -> NDArray[Any]:
    """The numbers in a type that numpy has."""
    if tensor.kind != BFLOAT16:
        return tensor.array
    return (tensor.array.astype("u4") << 16).view("f4")


class _Name(str):
    """What a pickle would import."""


class _Made(NamedTuple):
    """What a pickle would call, and with what."""

    what: Any
    arguments: Any


class _Place(NamedTuple):
    """What a pickle finds outside of itself."""

    said: Any


def _read(data: bytes) -> Tensor:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        members = {item.filename.partition("/")[2]: item for item in archive.infolist()}
        pickled = members["data.pkl"]
        if any(item.compress_type != zipfile.ZIP_STORED for item in members.values()):
            raise DecodeError("a file of torch that is compressed")
        if pickled.file_size > MAX_PICKLE:
            raise DecodeError("a file of torch with much more than a tensor")
        found = _value(archive.read(pickled))
        wanted = False
        if isinstance(found, _Made) and found.what == "torch._utils _rebuild_parameter":
            found, wanted = found.arguments[:2]
        if not isinstance(found, _Made) or found.what != "torch._utils _rebuild_tensor_v2":
            raise DecodeError("a file of torch that holds no tensor")
        place, offset, shape, strides, grad = found.arguments[:5]
        word, storage, key = place.said[:3]
        name = str(storage).removeprefix("torch ").removesuffix("Storage")
        if word != "storage" or not isinstance(storage, _Name) or name not in _NUMBERS:
            raise DecodeError(f"a tensor of {str(storage)[:80]}")
        order = "<"
        if "byteorder" in members and archive.read(members["byteorder"]) == b"big":
            order = ">"
        numbers = archive.read(members[f"data/{key}"])
    array = _array(numbers, order + _NUMBERS[name], (offset, shape, strides))
    return Tensor(
        array, BFLOAT16 if name == "BFloat16" else array.dtype.name, (wanted or grad) is True
    )


def _array(
    numbers: bytes, dtype: str, layout: tuple[int, tuple[int, ...], tuple[int, ...]]
) -> NDArray[Any]:
    """The numbers in their order. Where they are repeated (strides of 0) it is a view, which takes
    no memory."""
    import numpy as np

    offset, shape, strides = layout
    stored = np.frombuffer(numbers, dtype)
    stored = stored.astype(stored.dtype.newbyteorder("="), copy=False)
    if len(shape) != len(strides) or min((offset, *shape, *strides)) < 0:
        raise DecodeError(f"a tensor of the shape {shape} with strides of {strides}")
    count = math.prod(shape)
    if not count:
        return np.empty(shape, stored.dtype)
    last = offset + sum((n - 1) * step for n, step in zip(shape, strides, strict=True))
    apart = math.prod(n for n, step in zip(shape, strides, strict=True) if step)
    if max(last, apart - 1) >= len(stored):
        raise DecodeError(f"a tensor of the shape {shape} in {len(stored)} numbers")
    steps = tuple(step * stored.itemsize for step in strides)
    view = np.lib.stride_tricks.as_strided(stored[offset:], shape, steps, writeable=False)
    return view if count > len(stored) else np.array(view, order="C")


def _value(data: bytes) -> Any:
    """What a pickle describes, as plain values and the tuples above. Nothing is imported or
    called."""
    stack: list[Any] = []
    marks: list[int] = []
    memo: dict[int, Any] = {}
    for count, (code, given) in enumerate(_opcodes(data)):
        if count > MAX_OPCODES:
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
            stack.append(_Place(stack.pop()))
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
