"""Message: what the classes of all types have in common; Time and Duration.

Rules: a class of a type has the fields of its `.msg` file as attributes and its constants as class
attributes. What begins with an underscore is not a field, since ROS has none that do: `_type`,
`_md5sum` and `_full_text` are named as in rospy. A field that Python or this class needs the name
of has a `_` behind it. Values are checked when they are sent, not when they are assigned; where
a time is wanted, a number of seconds is one. The methods that read and write are those of the class
that `factory` makes.
"""

from __future__ import annotations

import keyword
import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, ClassVar, Final, NamedTuple, Self

from yarpy.data.value import Blocks, Buffer
from yarpy.peers.ros.message.model import Constant, Field, Struct

if TYPE_CHECKING:
    from yarpy.data.bottle import Bottle
    from yarpy.peers.ros.message.definition import Definition

#: elements of an array that `repr` still shows
_SHOWN: Final = 16


class Time(NamedTuple):
    """Seconds and nanoseconds since 1970, both unsigned 32 bits."""

    secs: int = 0
    nsecs: int = 0

    def to_sec(self) -> float:
        """As a number of seconds; for times of today that is good to about 200 nanoseconds."""
        return self.secs + self.nsecs / 1e9

    @classmethod
    def from_sec(cls, seconds: float) -> Self:
        return cls(*_split(seconds))


class Duration(NamedTuple):
    """Seconds and nanoseconds, both signed 32 bits; the nanoseconds of what is negative count
    upwards from the second below."""

    secs: int = 0
    nsecs: int = 0

    def to_sec(self) -> float:
        """As a number of seconds."""
        return self.secs + self.nsecs / 1e9

    @classmethod
    def from_sec(cls, seconds: float) -> Self:
        return cls(*_split(seconds))


#: types of two fields, seconds and nanoseconds; ROS 2 has messages for them
TIMES: Final = frozenset(
    ("time", "duration", "builtin_interfaces/Time", "builtin_interfaces/Duration")
)


def parts_of(value: Any) -> tuple[int, int] | None:
    """Return a number of seconds as seconds and nanoseconds; None for what is no such number."""
    if isinstance(value, float):
        return _split(value) if math.isfinite(value) else None
    return (value, 0) if isinstance(value, int) and not isinstance(value, bool) else None


def moment(kind: Callable[[int, int], Any], value: Any) -> Any:
    """Return a number of seconds as a time of this kind, whatever else as it is."""
    parts = parts_of(value)
    return value if parts is None else kind(*parts)


def _split(seconds: float) -> tuple[int, int]:
    below = math.floor(seconds)
    nanoseconds = round((seconds - below) * 1e9)
    return (below + 1, 0) if nanoseconds == 1_000_000_000 else (below, nanoseconds)


class Message:
    """A value of a ROS type: `Pose(x=1.0, theta=0.5)`; what is not given is 0, "" or empty."""

    __slots__ = ()

    #: package/Type, its checksum, and the texts of it and of all types in it
    _type: ClassVar[str]
    _md5sum: ClassVar[str]
    _full_text: ClassVar[str]
    _definition: ClassVar[Definition]
    #: the attributes, in the order of the fields
    _names: ClassVar[tuple[str, ...]]
    #: the classes of all messages in it, and the functions that read and write one in a row
    _used: ClassVar[dict[Struct, type[Message]]]
    #: whether it begins with number and time
    _has_header: ClassVar[bool] = False
    #: whether a string is its only field
    _is_text: ClassVar[bool] = False
    _read: ClassVar[Callable[..., Any]]
    _write: ClassVar[Callable[..., Any]]
    #: makes a message of its type, full text and bytes, wherever it is unpickled
    _restore: ClassVar[Callable[..., Any]]

    def __init__(self, *values: Any, **fields: Any) -> None:
        raise TypeError("make the class of a type first: yarpy.idl.load('package/Type')")

    def to_ros(self) -> Blocks:
        """The bytes of ROS, in blocks to be sent one after the other; large arrays are blocks of
        their own and not copied. TypeError or OverflowError names the field that does not fit."""
        raise NotImplementedError

    @classmethod
    def from_ros(cls, view: Buffer) -> Self:
        """The message in these bytes; Truncated or DecodeError if they are none.

        Arrays of numbers look at the bytes, without a copy, whether aligned or not.
        """
        raise NotImplementedError

    def to_bottle(self) -> Bottle:
        """The message as YARP programs see it: a list with an element per field."""
        raise NotImplementedError

    @classmethod
    def from_bottle(cls, items: Any) -> Self:
        """The message of a list with an element per field, or of a dict of some of them.

        Numbers become the declared kind if they fit; DecodeError names the field otherwise.
        """
        raise NotImplementedError

    def to_wire(self) -> Blocks:
        """The bytes that a YARP connection carries, as classes of C++ YARP send them."""
        raise NotImplementedError

    @classmethod
    def from_wire(cls, view: Buffer) -> Self:
        """The message in what a YARP connection brought; DecodeError if it is another."""
        raise NotImplementedError

    def to_dict(self) -> dict[str, Any]:
        """The fields by the names they have in ROS, messages in it as dicts too. Arrays stay."""
        fields = self._definition.struct.fields
        return {
            field.name: _plain(getattr(self, name))
            for field, name in zip(fields, self._names, strict=True)
        }

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Message):
            return NotImplemented
        if (self._type, self._md5sum) != (other._type, other._md5sum):
            return False
        return all(_same(getattr(self, name), getattr(other, name)) for name in self._names)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        fields = (f"{name}={_shown(getattr(self, name))}" for name in self._names)
        return f"{type(self).__name__}({', '.join(fields)})"

    def __reduce__(self) -> tuple[Callable[..., Any], tuple[str, str, bytearray]]:
        return self._restore, (self._type, self._full_text, bytearray().join(self.to_ros()))


#: names that fields cannot have as attributes
RESERVED: Final = frozenset((*keyword.kwlist, "self", *vars(Message)))


def attribute(item: Field | Constant) -> str:
    """The attribute of a field: its name, with one more `_` where Python needs the name itself."""
    return f"{item.name}_" if item.name.rstrip("_") in RESERVED else item.name


def _plain(value: Any) -> Any:
    if isinstance(value, Message):
        return value.to_dict()
    if isinstance(value, (Time, Duration)):
        return value._asdict()
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    return value


def _same(mine: Any, other: Any) -> bool:
    if hasattr(mine, "__array_interface__") or hasattr(other, "__array_interface__"):
        import numpy as np

        return np.array_equal(mine, other)
    if isinstance(mine, (list, tuple)) and isinstance(other, (list, tuple)):
        return len(mine) == len(other) and all(map(_same, mine, other))
    return bool(mine == other)


def _shown(value: Any) -> str:
    if hasattr(value, "__array_interface__"):
        if value.size > _SHOWN:
            return f"<{value.size} {value.dtype}>"
        return repr(value.tolist())
    return repr(value)
