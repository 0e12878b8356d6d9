"""Shapes: one class for each kind of value that a hint can mean, and how it travels.

    shape = shape_of(tuple[float, str])    `hint.py` reads hints
    shape.dump(value)      the value as plain Python, before it is spelled
    shape.load(plain)      ... and back: a DecodeError if something else came
    shape.native(plain)    what a port writes if YARP brings it back equal, else NOT_NATIVE
    shape.read(message)    the value of a message that is in YARP's own types

Rules: `dump` raises TypeError for what the hint does not allow. Native is only what comes back
equal, whatever the hint; a frame carries the rest.
"""

from __future__ import annotations

import enum
from collections.abc import Mapping, Sequence
from datetime import datetime
from typing import Any, Final

from yarpy.data import codec
from yarpy.errors import DecodeError
from yarpy.kits.wrap.value.native import INT64, NOT_NATIVE, native_dict, native_list
from yarpy.wire.message import Message


class Shape:
    """Any value: what has no hint. Only what tells its type by itself is native. `exact`: what is
    of that type is dumped and loaded as it is."""

    name = "anything"
    exact: type | None = None

    def dump(self, value: Any) -> Any:
        return value

    def load(self, plain: Any) -> Any:
        return plain

    def native(self, plain: Any) -> Any:
        kind = type(plain)
        if kind in _SCALARS:
            return Scalar.native(plain)
        if hasattr(kind, "to_wire") and not issubclass(kind, (list, dict)):
            return plain
        return NOT_NATIVE

    def read(self, message: Message) -> Any:
        return message.value

    def _wrong(self, plain: Any) -> DecodeError:
        return DecodeError(f"expected {self.name}, got {shown(plain)}")


class Scalar(Shape):
    """A number, a text, bytes, a bool."""

    def __init__(self, kind: type) -> None:
        self.kind = self.exact = kind
        self.name = kind.__name__

    def dump(self, value: Any) -> Any:
        if type(value) is self.kind:
            return value
        fitting = isinstance(value, self.kind) and not (
            isinstance(value, bool) and self.kind is not bool
        )
        if self.kind is float and isinstance(value, int) and not isinstance(value, bool):
            fitting = True
        if not fitting and getattr(value, "shape", None) == () and hasattr(value, "item"):
            return self.dump(value.item())  # a number of numpy
        if self.kind is bytes and isinstance(value, (bytearray, memoryview)):
            fitting = True
        if not fitting:
            raise TypeError(f"expected {self.name}, got {shown(value)}")
        return self.kind(value)

    def load(self, plain: Any) -> Any:
        try:
            return self.dump(plain)
        except (TypeError, ValueError, OverflowError) as error:
            raise DecodeError(str(error)) from None

    @staticmethod
    def native(plain: Any) -> Any:
        """A number that takes more than 64 bits is not native."""
        if type(plain) is int and not -INT64 <= plain < INT64:
            return NOT_NATIVE
        return plain

    def read(self, message: Message) -> Any:
        value = message.value  # nearly always of this kind, with fewer steps
        return value if type(value) is self.kind else message.as_(self.kind)


class Nothing(Shape):
    """None."""

    name = "None"

    def dump(self, value: Any) -> Any:
        if value is not None:
            raise TypeError(f"expected None, got {shown(value)}")
        return None

    def load(self, plain: Any) -> Any:
        if plain is not None and plain != []:
            raise self._wrong(plain)
        return None

    def native(self, plain: Any) -> Any:
        return None


class Several(Shape):
    """A list, a set, or a tuple of any length."""

    def __init__(self, kind: type, item: Shape) -> None:
        self.kind, self.item = kind, item
        self.name = f"a {kind.__name__}"
        self.exact = kind if type(item) is Shape else None

    def dump(self, value: Any) -> Any:
        if type(value) is self.exact:
            return value
        if isinstance(value, (str, bytes, dict)) or not hasattr(value, "__iter__"):
            raise TypeError(f"expected {self.name}, got {shown(value)}")
        dump = self.item.dump
        return self.kind(dump(item) for item in value)

    def load(self, plain: Any) -> Any:
        if not isinstance(plain, (list, tuple, set, frozenset)):
            raise self._wrong(plain)
        load = self.item.load
        try:
            return self.kind([load(item) for item in plain])
        except TypeError as error:
            raise DecodeError(f"expected {self.name}: {error}") from error

    def native(self, plain: Any) -> Any:
        return native_list(plain if type(plain) is list else list(plain))

    def read(self, message: Message) -> Any:
        return message.as_(list)


class Row(Shape):
    """A tuple of so many values, each of its own kind."""

    def __init__(self, items: Sequence[Shape], make: Any = tuple) -> None:
        self.items, self._make = tuple(items), make
        self.name = f"a tuple of {len(self.items)}"

    def dump(self, value: Any) -> Any:
        if not isinstance(value, (tuple, list)) or len(value) != len(self.items):
            raise TypeError(f"expected {self.name}, got {shown(value)}")
        return tuple(shape.dump(item) for shape, item in zip(self.items, value, strict=True))

    def load(self, plain: Any) -> Any:
        if not isinstance(plain, (list, tuple)) or len(plain) != len(self.items):
            raise self._wrong(plain)
        return self._make([shape.load(item) for shape, item in zip(self.items, plain, strict=True)])

    def native(self, plain: Any) -> Any:
        return native_list(list(plain))

    def read(self, message: Message) -> Any:
        return message.as_(list)


class Table(Shape):
    """A dict."""

    name = "a dict"

    def __init__(self, key: Shape, item: Shape) -> None:
        self.key, self.item = key, item
        self.exact = dict if type(key) is Shape and type(item) is Shape else None

    def dump(self, value: Any) -> Any:
        if type(value) is self.exact:
            return value
        if not isinstance(value, Mapping):
            raise TypeError(f"expected {self.name}, got {shown(value)}")
        return {self.key.dump(key): self.item.dump(item) for key, item in value.items()}

    def load(self, plain: Any) -> Any:
        if not isinstance(plain, dict):
            raise self._wrong(plain)
        if self.exact is not None:
            return plain
        return {self.key.load(key): self.item.load(item) for key, item in plain.items()}

    def native(self, plain: Any) -> Any:
        return native_dict(plain)

    def read(self, message: Message) -> Any:
        return message.as_(dict)


class Record(Shape):
    """A dataclass or a TypedDict: its fields by name."""

    def __init__(self, kind: type, fields: Mapping[str, Shape], needed: frozenset[str]) -> None:
        self.kind, self.fields, self.needed = kind, fields, needed
        self.name = kind.__name__
        self._typed_dict = issubclass(kind, dict)

    def dump(self, value: Any) -> Any:
        if self._typed_dict:
            if not isinstance(value, Mapping):
                raise TypeError(f"expected {self.name}, got {shown(value)}")
            return {name: self._field(name).dump(item) for name, item in value.items()}
        if not isinstance(value, self.kind):
            raise TypeError(f"expected {self.name}, got {shown(value)}")
        return {name: shape.dump(getattr(value, name)) for name, shape in self.fields.items()}

    def _field(self, name: str) -> Shape:
        return self.fields.get(name) or ANY

    def load(self, plain: Any) -> Any:
        if not isinstance(plain, dict):
            raise self._wrong(plain)
        missing = sorted(self.needed - plain.keys())
        if missing:
            raise DecodeError(f"expected {self.name}, which has {missing[0]!r}: {shown(plain)}")
        found = {}
        for name, item in plain.items():
            if name in self.fields:
                try:
                    found[name] = self.fields[name].load(item)
                except DecodeError as error:
                    raise DecodeError(f"{name} of {self.name}: {error}") from error
        if self._typed_dict:
            return found
        try:
            return self.kind(**found)
        except (TypeError, ValueError) as error:
            raise DecodeError(f"expected {self.name}: {error}") from error

    def native(self, plain: Any) -> Any:
        return native_dict(plain)

    def read(self, message: Message) -> Any:
        return message.as_(dict)


class Wired(Shape):
    """A type of YARP, of an IDL, or of the user: whatever has to_wire() and from_wire()."""

    def __init__(self, kind: Any) -> None:
        self.kind = kind
        self.name = kind.__name__

    def dump(self, value: Any) -> Any:
        if not isinstance(value, self.kind) and not hasattr(value, "to_wire"):
            value = self.kind(value)
        return value

    def load(self, plain: Any) -> Any:
        if isinstance(plain, self.kind):
            return plain
        try:
            return codec.decode_as(b"".join(codec.encode(plain)), self.kind)
        except (TypeError, OverflowError) as error:
            raise self._wrong(plain) from error

    def native(self, plain: Any) -> Any:
        return plain

    def read(self, message: Message) -> Any:
        return message.as_(self.kind)


class Maybe(Shape):
    """None, or a value of some kind."""

    def __init__(self, item: Shape) -> None:
        self.item = item
        self.name = f"None or {item.name}"

    def dump(self, value: Any) -> Any:
        return None if value is None else self.item.dump(value)

    def load(self, plain: Any) -> Any:
        return None if plain is None else self.item.load(plain)

    def native(self, plain: Any) -> Any:
        return NOT_NATIVE if plain is None else self.item.native(plain)

    def read(self, message: Message) -> Any:
        return self.item.read(message)


class Either(Shape):
    """A value of one of several kinds: the first that fits."""

    def __init__(self, items: Sequence[Shape]) -> None:
        self.items = tuple(items)
        self.name = " or ".join(item.name for item in items)

    def dump(self, value: Any) -> Any:
        for item in self.items:
            try:
                return item.dump(value)
            except (TypeError, ValueError):
                continue
        raise TypeError(f"expected {self.name}, got {shown(value)}")

    def load(self, plain: Any) -> Any:
        for item in self.items:
            try:
                return item.load(plain)
            except DecodeError:
                continue
        raise self._wrong(plain)

    def native(self, plain: Any) -> Any:
        return ANY.native(plain)


class Choice(Shape):
    """One of the values of a Literal."""

    def __init__(self, values: Sequence[Any]) -> None:
        self.values = tuple(values)
        self.name = " or ".join(map(repr, values))

    def dump(self, value: Any) -> Any:
        if value not in self.values:
            raise TypeError(f"expected {self.name}, got {shown(value)}")
        return value

    def load(self, plain: Any) -> Any:
        if isinstance(plain, (list, dict)) or plain not in self.values:
            raise self._wrong(plain)
        return plain

    def native(self, plain: Any) -> Any:
        return ANY.native(plain)


class Member(Shape):
    """A member of an enumeration, by its name."""

    def __init__(self, kind: type[enum.Enum]) -> None:
        self.kind = kind
        self.name = f"a name of {kind.__name__}"

    def dump(self, value: Any) -> Any:
        return self.kind(value).name

    def load(self, plain: Any) -> Any:
        if not isinstance(plain, str) or plain not in self.kind.__members__:
            raise self._wrong(plain)
        return self.kind[plain]

    def native(self, plain: Any) -> Any:
        return plain

    def read(self, message: Message) -> Any:
        return message.as_(str)


class Foreign(Shape):
    """A type that frames alone carry: dates, complex numbers, numbers of numpy."""

    def __init__(self, kind: type) -> None:
        self.kind = kind
        self.name = kind.__name__

    def load(self, plain: Any) -> Any:
        if isinstance(plain, self.kind):
            return plain
        if isinstance(plain, (int, float, complex)) and self.kind is not datetime:
            return self.kind(plain)
        raise self._wrong(plain)

    def native(self, plain: Any) -> Any:
        return NOT_NATIVE


ANY: Final = Shape()
_SCALARS: Final = (bool, int, float, str, bytes)


def shown(value: Any) -> str:
    text = repr(value)
    return f"{type(value).__name__} {text[:57]}..." if len(text) > 60 else text
