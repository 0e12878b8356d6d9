"""Messages of ROS on YARP's own connections: the bytes that classes of C++ YARP send there.

    a message      256, fields, then each field behind its code; a message in it is a list again
    numbers[]      256 + code, count, the numbers; string[] likewise, with a length before each
    time           256, 2, 1, sec, 1, nsec

Rules: it is a Bottle, but for two habits: lists of messages and messages of equal numbers are never
specialised, lists of numbers always, even where they are empty. C++ counts constants as fields and
does not send them; that is understood here and never said. Whatever other Bottle comes is read as
such, if its structure is that of the type.
"""

from __future__ import annotations

from collections.abc import Callable
from struct import Struct as Packing
from struct import error as struct_error
from typing import Any, Final, TypeVar

from yarpy.data.bottle import read_bottle
from yarpy.data.value import (
    BIG,
    FLOAT32,
    FLOAT64,
    INT8,
    INT16,
    INT32,
    INT64,
    LIST,
    STRING,
    Blocks,
    Buffer,
)
from yarpy.errors import DecodeError, Truncated
from yarpy.limit import limits
from yarpy.peers.ros.message.convert.bottle import from_bottle
from yarpy.peers.ros.message.fault import array_of, fault
from yarpy.peers.ros.message.message import (
    TIMES,
    Duration,
    Message,
    Time,
    attribute,
    moment,
    parts_of,
)
from yarpy.peers.ros.message.model import ListOf, Primitive, Struct, Type
from yarpy.peers.ros.message.writer import joined

M = TypeVar("M", bound=Message)

_I32: Final = Packing("<i")
_HEAD: Final = Packing("<ii")
_WIDTHS: Final = {1: INT8, 2: INT16, 4: INT32, 8: INT64}
_SMALL: Final = 1 << 16


def code_of(kind: Primitive) -> int:
    """The code of a number or string in a Bottle."""
    if kind.letters in ("f", "d"):
        return FLOAT32 if kind.size == 4 else FLOAT64
    return _WIDTHS.get(kind.size, STRING)


# ---------------------------------------------------------------------------------- writing


def to_wire(message: Message) -> Blocks:
    """The message as blocks; large arrays are blocks of their own. TypeError, OverflowError."""
    pieces: list[bytes | memoryview] = []
    struct = message._definition.struct
    try:
        _write(struct, message, pieces.append)
    except (struct_error, TypeError, AttributeError, OverflowError, ValueError) as error:
        raise fault(struct, message) or error from None
    if memoryview not in map(type, pieces):
        return (b"".join(pieces),)
    return joined(pieces)


def _write(struct: Struct, message: Any, add: Callable[[bytes | memoryview], None]) -> None:
    add(_HEAD.pack(LIST, len(struct.fields)))
    parts = parts_of(message) if struct.name in TIMES else None
    for at, field in enumerate(struct.fields):
        value = getattr(message, attribute(field)) if parts is None else parts[at]
        _write_value(field.type, value, add)


def _write_value(kind: Type, value: Any, add: Callable[[bytes | memoryview], None]) -> None:
    if isinstance(kind, Struct):
        _write(kind, value, add)
    elif isinstance(kind, ListOf):
        _write_list(kind, value, add)
    elif isinstance(kind, Primitive):
        if kind.is_number:
            add(_I32.pack(code_of(kind)) + Packing("<" + kind.letters).pack(value))
        elif kind.name == "string":
            text = value.encode("utf-8", "surrogateescape")
            add(_HEAD.pack(STRING, len(text)) + text)
        else:
            letter, value = kind.letters[0], moment(Time, value)
            add(Packing(f"<iii{letter}i{letter}").pack(LIST, 2, 1, value.secs, 1, value.nsecs))


def _write_list(kind: ListOf, value: Any, add: Callable[[bytes | memoryview], None]) -> None:
    element = kind.element
    if isinstance(value, str) or (kind.length is not None and len(value) != kind.length):
        raise TypeError("no such list")
    if isinstance(element, Primitive) and element.is_number:
        import numpy as np

        array = array_of(value, np.dtype("<" + element.letters), "")
        add(_HEAD.pack(LIST + code_of(element), len(array)))
        if array.nbytes < BIG:
            add(array.tobytes())
        else:
            add(memoryview(np.ascontiguousarray(array).view("u1").data))
    elif isinstance(element, Primitive) and element.name == "string":
        add(_HEAD.pack(LIST + STRING, len(value)))
        for item in value:
            text = item.encode("utf-8", "surrogateescape")
            add(_I32.pack(len(text)) + text)
    else:
        add(_HEAD.pack(LIST, len(value)))
        for item in value:
            _write_value(element, item, add)


# ---------------------------------------------------------------------------------- reading


def from_wire(cls: type[M], view: Buffer) -> M:
    """The message in these bytes; DecodeError if they are neither its own form nor a Bottle of its
    structure."""
    try:
        found: M = _Reader(view).whole(cls)
        return found
    except _Other:
        pass
    except struct_error:
        size = len(view)
        raise Truncated(f"{cls._type} goes on beyond the {size} bytes here", size + 1) from None
    return from_bottle(cls, read_bottle(view))


class _Other(Exception):
    """Not what a class would have sent: perhaps another Bottle."""


class _Reader:
    """Follows the type through the bytes; numbers in lists stay where they are."""

    def __init__(self, view: Buffer) -> None:
        self.view = view
        self.at = 0
        self.room = limits().elements if len(view) > _SMALL else _SMALL

    def whole(self, cls: type[Message]) -> Any:
        found = self.message(cls)
        if self.at != len(self.view):
            raise _Other
        return found

    def head(self) -> tuple[int, int]:
        found: tuple[int, int] = _HEAD.unpack_from(self.view, self.at)
        self.at += 8
        return found

    def take(self, size: int) -> int:
        """Step over bytes that must be there; gives where they begin."""
        start = self.at
        if size < 0 or start + size > len(self.view):
            raise _Other
        self.at += size
        return start

    def message(self, cls: type[Message]) -> Any:
        struct = cls._definition.struct
        code, count = self.head()
        if code != LIST or count not in (
            len(struct.fields),
            len(struct.fields) + len(struct.constants),
        ):
            raise _Other
        return cls(*[self.value(cls, field.type) for field in struct.fields])

    def value(self, cls: type[Message], kind: Type) -> Any:
        if isinstance(kind, Struct):
            return self.message(cls._used[kind])
        if isinstance(kind, ListOf):
            return self.list(cls, kind)
        assert isinstance(kind, Primitive)
        if kind.name == "string":
            code, size = self.head()
            if code != STRING:
                raise _Other
            return self.text(size)
        if not kind.is_number:
            start = self.take(24)
            packing = Packing(f"<iii{kind.letters[0]}i{kind.letters[0]}")
            code, count, one, seconds, two, nanoseconds = packing.unpack_from(self.view, start)
            if (code, count, one, two) != (LIST, 2, 1, 1):
                raise _Other
            return (Time if kind.name == "time" else Duration)(seconds, nanoseconds)
        if _I32.unpack_from(self.view, self.at)[0] != code_of(kind):
            raise _Other
        self.at += 4
        return Packing("<" + kind.letters).unpack_from(self.view, self.take(kind.size))[0]

    def text(self, size: int) -> str:
        start = self.take(size)
        return str(self.view[start : self.at], "utf-8", "surrogateescape")

    def list(self, cls: type[Message], kind: ListOf) -> Any:
        element = kind.element
        code, count = self.head()
        if count < 0 or kind.length not in (None, count):
            raise _Other
        if isinstance(element, Primitive) and element.is_number:
            if code != LIST + code_of(element):
                raise _Other
            return self.array(element, count)
        self.room -= count
        if self.room < 0:
            raise DecodeError(
                f"{cls._type}: more than {limits().elements} elements (YARPY_MAX_ELEMENTS)"
            )
        if isinstance(element, Primitive) and element.name == "string":
            if code != LIST + STRING:
                raise _Other
            return [self.text(_I32.unpack_from(self.view, self.take(4))[0]) for _ in range(count)]
        if code != LIST:
            raise _Other
        return [self.value(cls, element) for _ in range(count)]

    def array(self, element: Primitive, count: int) -> Any:
        import numpy as np

        start = self.take(count * element.size)
        if element.name == "bool":
            return np.frombuffer(self.view, "u1", count, start) != 0
        return np.frombuffer(self.view, "<" + element.letters, count, start)
