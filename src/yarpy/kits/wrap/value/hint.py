"""Type hints as shapes.

Rules: a hint is read once, where a method is decorated. One that cannot be sent is a TypeError.
"""

from __future__ import annotations

import dataclasses
import enum
import types
import typing
from collections.abc import Mapping, Sequence
from datetime import datetime
from typing import Annotated, Any, Final, Literal, Union, get_args, get_origin, get_type_hints

from yarpy.kits.wrap.value.array import Array, Image, Picture
from yarpy.kits.wrap.value.shape import (
    ANY,
    Choice,
    Either,
    Foreign,
    Maybe,
    Member,
    Nothing,
    Record,
    Row,
    Scalar,
    Several,
    Shape,
    Table,
    Wired,
)

#: arrays of these libraries travel as those of numpy do
_LIBRARIES: Final = ("torch", "tensorflow", "jax", "cupy", "paddle")


def shape_of(hint: Any) -> Shape:
    """The shape of a type hint. Raises TypeError for one that cannot be sent."""
    if hint is Any or hint is object:
        return ANY
    if hint is None or hint is type(None):
        return Nothing()
    if isinstance(hint, typing.TypeVar):
        return shape_of(hint.__bound__) if hint.__bound__ is not None else ANY
    if type(hint).__name__ == "TypeAliasType":
        return shape_of(hint.__value__)
    supertype = getattr(hint, "__supertype__", None)  # NewType
    if supertype is not None:
        return shape_of(supertype)
    origin = get_origin(hint)
    if origin is not None:
        return _generic(hint, origin, get_args(hint))
    if isinstance(hint, type):
        return _class(hint)
    raise _unsendable(hint)


def _generic(hint: Any, origin: Any, arguments: tuple[Any, ...]) -> Shape:
    if origin is Annotated:
        found = next((one for one in arguments[1:] if isinstance(one, Image)), None)
        return Picture(found) if found is not None else shape_of(arguments[0])
    if origin is Union or origin is types.UnionType:
        rest = [one for one in arguments if one is not type(None)]
        inner = shape_of(rest[0]) if len(rest) == 1 else Either([shape_of(one) for one in rest])
        return Maybe(inner) if len(rest) < len(arguments) else inner
    if origin is Literal:
        return Choice(arguments)
    if origin in (typing.Required, typing.NotRequired, typing.Final, typing.ClassVar):
        return shape_of(arguments[0])
    origin = getattr(origin, "__value__", origin)  # `type` aliases, as NDArray is from 3.12 on
    origin = get_origin(origin) or origin
    if not isinstance(origin, type):
        raise _unsendable(hint)
    if origin is tuple:
        if len(arguments) == 2 and arguments[1] is Ellipsis:
            return Several(tuple, shape_of(arguments[0]))
        return Row([shape_of(one) for one in arguments])
    if issubclass(origin, (set, frozenset)):
        return Several(origin, shape_of(arguments[0]))
    if issubclass(origin, Mapping) and len(arguments) == 2:
        return Table(shape_of(arguments[0]), shape_of(arguments[1]))
    if issubclass(origin, Sequence) and not hasattr(origin, "to_wire"):
        return Several(list, shape_of(arguments[0]))
    return _class(origin)


def _class(kind: Any) -> Shape:
    if kind in (bool, int, float, str, bytes):
        return Scalar(kind)
    if kind in (bytearray, memoryview):
        return Scalar(bytes)
    if kind in (complex, datetime):
        return Foreign(kind)
    if hasattr(kind, "to_wire") and hasattr(kind, "from_wire"):
        return Wired(kind)
    if kind.__module__.startswith("yarpy.data."):  # a Bottle, a Property, a Vocab, the odd widths
        return Wired(kind)
    if issubclass(kind, enum.Enum):
        return Member(kind)
    if dataclasses.is_dataclass(kind):
        fields = [field for field in dataclasses.fields(kind) if field.init]
        needed = [
            field.name
            for field in fields
            if field.default is dataclasses.MISSING and field.default_factory is dataclasses.MISSING
        ]
        return _record(kind, [field.name for field in fields], needed)
    if typing.is_typeddict(kind):
        hints = get_type_hints(kind, include_extras=True)
        # Not __required_keys__, which takes annotations that are texts for required.
        needed = [
            name
            for name, hint in hints.items()
            if get_origin(hint) is typing.Required
            or (kind.__total__ and get_origin(hint) is not typing.NotRequired)
        ]
        return _record(kind, [*hints], needed)
    if issubclass(kind, tuple):
        names = getattr(kind, "_fields", None)
        if names is None:
            return Several(tuple, ANY)
        hints = get_type_hints(kind, include_extras=True)
        items = [_named(kind, name, hints.get(name, Any)) for name in names]
        return Row(items, getattr(kind, "_make"))  # noqa: B009
    if issubclass(kind, (set, frozenset)):
        return Several(kind, ANY)
    if issubclass(kind, dict) or kind is Mapping:
        return Table(ANY, ANY)
    if issubclass(kind, list) or kind is Sequence:
        return Several(list, ANY)
    if issubclass(kind, (int, float, str, bytes)):
        return Wired(kind)
    module = kind.__module__.partition(".")[0]
    if module == "numpy":
        if kind.__name__ == "ndarray":
            return Array()
        if hasattr(kind, "itemsize"):
            return Foreign(kind)
    if module in _LIBRARIES and (hasattr(kind, "__dlpack__") or hasattr(kind, "__array__")):
        return Array(module)
    raise _unsendable(kind)


def _record(kind: Any, names: Sequence[str], needed: Sequence[str]) -> Shape:
    hints = get_type_hints(kind, include_extras=True)
    fields = {name: _named(kind, name, hints[name]) for name in names}
    return Record(kind, fields, frozenset(needed))


def _named(kind: Any, name: str, hint: Any) -> Shape:
    if hint is kind:
        raise TypeError(f"{kind.__name__} holds itself: such a type has no end")
    try:
        return shape_of(hint)
    except TypeError as error:
        raise TypeError(f"{name} of {kind.__name__}: {error}") from error
    except RecursionError:
        raise TypeError(f"{kind.__name__} holds itself: such a type has no end") from None


def _unsendable(hint: Any) -> TypeError:
    name = getattr(hint, "__qualname__", None) or str(hint)
    module = getattr(hint, "__module__", "")
    shown = name if module in ("builtins", "typing", "") else f"{module}.{name}"
    return TypeError(
        f"{shown} cannot be sent; numbers, texts, bytes, lists, tuples, dicts, sets, dataclasses, "
        "TypedDicts, arrays, the types of yarpy and classes with to_wire() and from_wire() can"
    )
