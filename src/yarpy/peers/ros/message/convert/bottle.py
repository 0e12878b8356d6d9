"""Messages of ROS as Bottles: what a YARP program without their classes sees, types and hears.

    message               a list with an element per field: (1 (0 0) base) (a b) (1.0 2.0) () (0.5)
    bool and 8 bits       Int8                   float32     Float32
    16, 64 bits           Int16, Int64           time        two int32: (sec nsec)
    32 bits, float64      int, float             numbers[]   Vector, over the same memory

Rules: unsigned numbers keep their bits and so become negative beyond half their range. Back again
the structure must be that of the type, as in C++ YARP; numbers only have to fit: an integer is
taken for a float, never the reverse, nor a number for a string. DecodeError names the field.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final, TypeVar

from yarpy.data.bottle import Bottle
from yarpy.data.sig.vector import Vector
from yarpy.data.value import Float32, Int8, Int16, Int64
from yarpy.errors import DecodeError
from yarpy.peers.ros.message.fault import array_of, check_primitive, described
from yarpy.peers.ros.message.message import TIMES, Duration, Message, Time, moment, parts_of
from yarpy.peers.ros.message.model import ListOf, Primitive, Struct, Type

if TYPE_CHECKING:
    from numpy.typing import NDArray

M = TypeVar("M", bound=Message)

_WIDTHS: Final = {1: Int8, 2: Int16, 4: int, 8: Int64}


# ---------------------------------------------------------------------------------- to Bottles


def to_bottle(message: Message) -> Bottle:
    """The Bottle of a message. TypeError and OverflowError as `to_ros` has them."""
    return _items(message, message._type)


def _items(message: Message, path: str) -> Bottle:
    fields = message._definition.struct.fields
    return Bottle(
        _element(field.type, getattr(message, name), f"{path}.{field.name}")
        for field, name in zip(fields, message._names, strict=True)
    )


def _element(kind: Type, value: Any, path: str) -> Any:
    if isinstance(kind, Struct):
        parts = parts_of(value) if kind.name in TIMES else None
        if parts is not None:
            return Bottle(parts)
        if not isinstance(value, Message):
            raise TypeError(f"{path}: expected {kind}, got {described(value)}")
        return _items(value, path)
    if isinstance(kind, ListOf):
        element = kind.element
        if isinstance(element, Primitive) and element.is_number:
            return _vector(element, value, path)
        return Bottle(_element(element, item, f"{path}[{at}]") for at, item in enumerate(value))
    assert isinstance(kind, Primitive)
    if kind.name == "string":
        return value
    if not kind.is_number:
        check_primitive(kind, value, path)
        value = moment(Time, value)
        return Bottle([_signed(value.secs, 4), _signed(value.nsecs, 4)])
    if kind.letters in "fd":
        return Float32(value) if kind.size == 4 else float(value)
    try:
        return _WIDTHS[kind.size](_signed(int(value), kind.size))
    except OverflowError as error:
        raise OverflowError(f"{path}: {error}") from None


def _signed(value: int, size: int) -> int:
    """The signed number with the bits of an unsigned one."""
    half = 1 << (8 * size - 1)
    return value - 2 * half if half <= value < 2 * half else value


def _vector(element: Primitive, value: Any, path: str) -> Vector:
    import numpy as np

    array = array_of(value, np.dtype("<" + element.letters), path)
    if array.dtype.kind in "ub":
        array = array.view(f"<i{element.size}")
    return Vector(array, dtype=array.dtype)


# ---------------------------------------------------------------------------------- from Bottles


def from_bottle(cls: type[M], items: Any) -> M:
    """The message of a list, of a dict with some of the fields, or of a single value where the
    type has a single field."""
    if cls._is_text and type(items) is str:
        return cls(items)  # as below
    if isinstance(items, (str, int, float, bytes)) and cls._definition.struct.name not in TIMES:
        items = [items]
    found: M = _message(cls, items, cls._type)
    return found


def _message(cls: type[Any], items: Any, path: str) -> Any:
    if isinstance(items, cls):
        return items
    fields = cls._definition.struct.fields
    if cls._definition.struct.name in TIMES:
        items = parts_of(items) or items
    if isinstance(items, dict):
        named = dict(zip((field.name for field in fields), cls._names, strict=True))
        unknown = next((key for key in items if key not in named), None)
        if unknown is not None:
            raise DecodeError(f"{path} has no field {unknown!r}; it has {', '.join(named)}")
        kinds = {field.name: field.type for field in fields}
        return cls(
            **{
                named[key]: _value(cls, kinds[key], item, f"{path}.{key}")
                for key, item in items.items()
            }
        )
    if not _is_list(items):
        raise DecodeError(f"{path}: expected a list of {len(fields)}, got {described(items)}")
    if len(items) != len(fields):
        names = " ".join(field.name for field in fields)
        raise DecodeError(f"{path}: expected {len(fields)} elements ({names}), got {len(items)}")
    values = [
        _value(cls, field.type, item, f"{path}.{field.name}")
        for field, item in zip(fields, items, strict=True)
    ]
    return cls(*values)


def _value(cls: type[Message], kind: Type, item: Any, path: str) -> Any:
    if isinstance(kind, Struct):
        return _message(cls._used[kind], item, path)
    if isinstance(kind, ListOf):
        return _list(cls, kind, item, path)
    assert isinstance(kind, Primitive)
    if kind.is_number:
        return _number(kind, item, path)
    if kind.name == "string":
        if isinstance(item, str):
            return str.__str__(item)
        raise DecodeError(f"{path}: expected a string, got {described(item)}")
    parts = parts_of(item)
    if parts is not None and parts[0] < 0 and kind.name == "time":
        raise DecodeError(f"{path}: {item} does not fit in time")
    item = parts or item
    if not _is_list(item) or len(item) != 2:
        raise DecodeError(f"{path}: expected (sec nsec) or seconds, got {described(item)}")
    part = _SECONDS[kind.name]
    pair = (_number(part, item[0], f"{path}.secs"), _number(part, item[1], f"{path}.nsecs"))
    return Time(*pair) if kind.name == "time" else Duration(*pair)


_SECONDS: Final = {"time": Primitive("uint32", "I", 4), "duration": Primitive("int32", "i", 4)}


def _list(cls: type[Message], kind: ListOf, item: Any, path: str) -> Any:
    element = kind.element
    is_number = isinstance(element, Primitive) and element.is_number
    if not _is_list(item) and not (is_number and isinstance(item, (bytes, bytearray, memoryview))):
        raise DecodeError(f"{path}: expected a list, got {described(item)}")
    if kind.length is not None and len(item) != kind.length:
        raise DecodeError(f"{path}: expected {kind.length} elements, got {len(item)}")
    if isinstance(element, Primitive) and element.is_number:
        return _array(element, item, path)
    return [_value(cls, element, each, f"{path}[{at}]") for at, each in enumerate(item)]


def _array(element: Primitive, item: Any, path: str) -> NDArray[Any]:
    import numpy as np

    dtype = np.dtype("<" + element.letters)
    array = item.array if isinstance(item, Vector) else item
    if isinstance(array, (list, tuple)):
        numbers = [_number(element, each, f"{path}[{at}]") for at, each in enumerate(array)]
        return np.array(numbers, dtype)
    try:
        if isinstance(array, np.ndarray) and array.dtype.kind == "i" and dtype.kind in "ub":
            if dtype.kind == "b":
                return np.not_equal(array, 0)
            if array.dtype.itemsize == dtype.itemsize:
                return array.view(dtype)
        return array_of(array, dtype, path)
    except (TypeError, OverflowError) as error:
        raise DecodeError(str(error)) from None


def _number(kind: Primitive, item: Any, path: str) -> Any:
    if kind.letters == "?":
        if isinstance(item, int) and item in (0, 1):
            return bool(item)
        raise DecodeError(f"{path}: expected true or false, got {described(item)}")
    is_int = isinstance(item, int) and not isinstance(item, bool)
    if kind.letters in "fd":
        if is_int or isinstance(item, float):
            return float(item)
        raise DecodeError(f"{path}: expected a number, got {described(item)}")
    if not is_int:
        raise DecodeError(f"{path}: expected an integer ({kind}), got {described(item)}")
    half = 1 << (8 * kind.size - 1)
    unsigned = kind.letters.isupper()
    if not -half <= item < (2 * half if unsigned else half):
        raise DecodeError(f"{path}: {item} does not fit in {kind}")
    return int(item) % (2 * half) if unsigned else int(item)


def _is_list(item: Any) -> bool:
    if isinstance(item, (str, bytes, bytearray, memoryview)):
        return False
    return isinstance(item, (list, tuple, Sequence)) or hasattr(item, "__array_interface__")
