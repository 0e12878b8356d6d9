"""A value that came, as the type that a program wants: dataclasses, TypedDicts, named tuples ...

    convert({"q": [1, 2]}, Observation)     Observation(q=array([1, 2]))

Rules: the hints of a class are followed, also of those in it. Numbers become wider ones, lists
arrays, arrays YARP's own types; nothing is guessed from texts. What does not fit is a DecodeError
that says where. Keys that a class does not have are left out, so that it may have fewer.
"""

from __future__ import annotations

import dataclasses
import enum
import types
import typing
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from typing import Any, Final

from yarpy.data.bottle import Bottle, Property
from yarpy.data.embedded import with_article
from yarpy.data.text import print_text
from yarpy.data.value import MAX_DEPTH
from yarpy.data.writer import list_blocks
from yarpy.errors import DecodeError


def is_typed(type_: Any) -> bool:
    """Return whether `type_` says more than which of YARP's own types is wanted."""
    if isinstance(type_, type):
        return (
            dataclasses.is_dataclass(type_)
            or typing.is_typeddict(type_)
            or bool(getattr(type_, "__annotations__", None) and issubclass(type_, tuple))
            or is_tensor(type_)
            or type_ is complex
        )
    return bool(typing.get_args(type_)) or _aliased(type_) is not type_


def is_tensor(type_: Any) -> bool:
    """Return whether it is torch's type of arrays; torch is not imported for it."""
    module, name = getattr(type_, "__module__", ""), getattr(type_, "__name__", "")
    return name == "Tensor" and module == "torch"


def convert(value: Any, type_: Any, path: str = "", depth: int = 0) -> Any:
    """The value as `type_`. DecodeError if it is something else, TypeError for a type that no
    message can be read as. `path` is where in the message it stands."""
    type_ = _aliased(type_)
    if type_ is Any or type_ is object:
        return value
    if depth > MAX_DEPTH:
        raise DecodeError(f"values nested more than {MAX_DEPTH} deep")
    origin = typing.get_origin(type_)
    if origin is not None:
        return _generic(value, type_, origin, path, depth)
    if type_ is None or type_ is types.NoneType:
        if value is not None and value != []:
            raise _wrong("nothing", value, path)
        return None
    if isinstance(type_, typing.TypeVar):
        return value
    if not isinstance(type_, type):
        raise TypeError(f"messages cannot be read as {type_!r}")
    if dataclasses.is_dataclass(type_) and not hasattr(type_, "from_wire"):
        return _record(value, type_, path, depth)
    if typing.is_typeddict(type_):
        return _typed_dict(value, type_, path, depth)
    if issubclass(type_, tuple) and hasattr(type_, "_fields"):
        return _named_tuple(value, type_, path, depth)
    return _class(value, type_, path)


def _aliased(type_: Any) -> Any:
    """Return the type behind a `type` alias (NDArray from Python 3.12 on), any other as it is."""
    while hasattr(type_, "__value__"):
        type_ = type_.__value__
    return type_


# ---------------------------------------------------------------------------------- generics


def _generic(value: Any, type_: Any, origin: Any, path: str, depth: int) -> Any:
    args = typing.get_args(type_)
    if hasattr(origin, "__value__"):  # NDArray[float], from Python 3.12 on
        return convert(value, typing.get_origin(_aliased(origin)), path, depth)
    if origin in (typing.Annotated, typing.Required, typing.NotRequired, typing.ClassVar):
        return convert(value, args[0], path, depth)
    if origin is typing.Literal:
        for choice in args:
            if choice == value and (type(choice) is type(value) or isinstance(choice, str)):
                return choice
        raise _wrong(f"one of {', '.join(map(repr, args))}", value, path)
    if origin in (typing.Union, types.UnionType):
        return _union(value, args, path, depth)
    if origin is tuple:
        items = _items(value, path)
        if len(args) == 2 and args[1] is ...:
            return tuple(_each(items, args[0], path, depth))
        if len(items) != len(args):
            raise _wrong(f"{len(args)} values", value, path)
        pairs = enumerate(zip(items, args, strict=True))
        return tuple(convert(item, arg, f"{path}[{at}]", depth + 1) for at, (item, arg) in pairs)
    if isinstance(origin, type) and issubclass(origin, Mapping):
        found = _mapping(value, path)
        return {
            convert(key, args[0], path, depth): convert(item, args[1], f"{path}.{key}", depth + 1)
            for key, item in found.items()
        }
    if isinstance(origin, type) and origin.__name__ != "ndarray" and issubclass(origin, Sequence):
        return _each(_items(value, path), args[0], path, depth)
    return convert(value, origin, path, depth)


def _union(value: Any, args: tuple[Any, ...], path: str, depth: int) -> Any:
    for exact in args:
        if isinstance(exact, type) and type(value) is exact:
            return value
    why: DecodeError | None = None
    for arg in args:
        try:
            return convert(value, arg, path, depth)
        except DecodeError as error:
            why = error
    assert why is not None
    raise why


def _each(items: Sequence[Any], arg: Any, path: str, depth: int) -> list[Any]:
    return [convert(item, arg, f"{path}[{at}]", depth + 1) for at, item in enumerate(items)]


# ---------------------------------------------------------------------------------- records


@lru_cache(maxsize=256)
def _hints(type_: Any) -> dict[str, Any]:
    try:
        return typing.get_type_hints(type_, include_extras=True)
    except Exception as error:  # hints are code of the program, which may name what is not there
        raise TypeError(f"the hints of {type_.__name__} cannot be read: {error}") from error


def _record(value: Any, type_: Any, path: str, depth: int) -> Any:
    if type(value) is type_:
        return value
    found, hints, given = _mapping(value, path, type_), _hints(type_), {}
    for field in dataclasses.fields(type_):
        if not field.init:
            continue
        if field.name in found:
            inner = f"{path}.{field.name}"
            given[field.name] = convert(found[field.name], hints[field.name], inner, depth + 1)
        elif field.default is dataclasses.MISSING and field.default_factory is dataclasses.MISSING:
            raise _missing(type_, field.name, path)
    return _made(type_, path, given)


def _typed_dict(value: Any, type_: Any, path: str, depth: int) -> Any:
    found, hints, given = _mapping(value, path, type_), _hints(type_), {}
    for name, hint in hints.items():
        if name in found:
            given[name] = convert(found[name], hint, f"{path}.{name}", depth + 1)
        elif name in type_.__required_keys__:
            raise _missing(type_, name, path)
    return given


def _named_tuple(value: Any, type_: Any, path: str, depth: int) -> Any:
    hints = _hints(type_)
    if isinstance(value, list) and value and all(_is_pair(item, type_) for item in value):
        value = Property.from_bottle(value)
    if isinstance(value, Mapping):
        wanted = [name for name in type_._fields if name in value]
        given = {name: value[name] for name in wanted}
    else:
        items = _items(value, path, type_)
        if len(items) > len(type_._fields):
            raise _wrong(
                f"{with_article(type_.__name__)} of {len(type_._fields)} values", value, path
            )
        given = dict(zip(type_._fields, items, strict=False))
    for name in type_._fields:
        if name in given:
            inner = f"{path}.{name}"
            given[name] = convert(given[name], hints.get(name, Any), inner, depth + 1)
        elif name not in type_._field_defaults:
            raise _missing(type_, name, path)
    return _made(type_, path, given)


def _is_pair(item: Any, type_: Any) -> bool:
    """Return whether an element of a list is a key and a value: a field of the type."""
    return isinstance(item, list) and 0 < len(item) < 3 and item[0] in type_._fields


def _made(type_: Any, path: str, given: dict[str, Any]) -> Any:
    try:
        return type_(**given)
    except (ValueError, TypeError, LookupError, OverflowError) as error:
        raise DecodeError(f"expected {with_article(type_.__name__)}{_at(path)}: {error}") from error


def _missing(type_: Any, name: str, path: str) -> DecodeError:
    return DecodeError(f"expected {with_article(type_.__name__)}{_at(path)}: it has no {name!r}")


# ---------------------------------------------------------------------------------- classes


def _class(value: Any, type_: type, path: str) -> Any:
    if type_ in _PLAIN:
        return _PLAIN[type_](value, path)
    if type(value) is type_:
        return value
    if issubclass(type_, enum.Enum):
        return _called(type_, value, path)
    if type_.__name__ == "ndarray" and type_.__module__ == "numpy":
        return array_in(value, path)
    if is_tensor(type_):
        return _tensor(array_in(value, path), type_)
    if issubclass(type_, Property):
        return type_(_mapping(value, path))
    from_wire = getattr(type_, "from_wire", None)
    if from_wire is not None:
        return _own(value, type_, from_wire, path)
    if isinstance(value, type_):
        return value
    for base in _BASES:
        if issubclass(type_, base):
            return _called(type_, _PLAIN[base](value, path), path)
    numpy_number = type_.__module__ == "numpy" and hasattr(type_, "dtype")
    if numpy_number and isinstance(value, (bool, int, float, complex)):
        return _called(type_, value, path)
    raise TypeError(
        f"messages cannot be read as {type_.__name__}; give it a class method from_wire(view)"
    )


def _called(type_: Any, value: Any, path: str) -> Any:
    try:
        return type_(value)
    except (ValueError, TypeError, LookupError, OverflowError) as error:
        raise DecodeError(f"expected {with_article(type_.__name__)}{_at(path)}: {error}") from error


def _own(value: Any, type_: Any, from_wire: Callable[[Any], Any], path: str) -> Any:
    """A type that is made of the bytes of a message: of an array, or of the list it came as."""
    if isinstance(value, (list, tuple)):
        try:
            return from_wire(b"".join(list_blocks(value)))
        except (DecodeError, TypeError) as error:
            raise _wrong(with_article(type_.__name__), value, path) from error
    if getattr(value, "shape", None) is not None:
        value = _called(type_, value, path)
        return value
    from_array = getattr(value, "array", None)
    if from_array is not None and type_.__module__.startswith("yarpy.data."):
        return _called(type_, from_array, path)
    raise _wrong(with_article(type_.__name__), value, path)


def array_in(value: Any, path: str = "") -> Any:
    """The array that a value is, or that is in an Image, a Vector or a list of numbers."""
    import numpy as np

    if isinstance(value, np.ndarray):
        return value
    if not isinstance(value, Bottle) and hasattr(value, "array"):
        return value.array
    if isinstance(value, (list, tuple, int, float, complex)):
        image = _image_in(value)
        if image is not None:
            return image
        try:
            found = np.asarray(value)
        except ValueError:
            found = np.empty(0, "O")
        if found.dtype.kind in "biufc":
            return found
    raise _wrong("an array", value, path)


def _image_in(value: Any) -> Any:
    """The pixels of an image that stands in a list as the list that it is, else None."""
    if not isinstance(value, list) or len(value) != 4 or value[0] != "mat":
        return None
    from yarpy.data.sig.image import Image

    image = Image.found(b"".join(list_blocks(value)))
    return None if image is None else image.array


def _tensor(array: Any, type_: Any) -> Any:
    """A tensor over the memory of an array; a copy if that may not be written to, since torch
    knows no such memory."""
    import sys

    return sys.modules[type_.__module__].from_numpy(
        array if array.flags.writeable else array.copy()
    )


def _items(value: Any, path: str, type_: Any = None) -> Sequence[Any]:
    if isinstance(value, (list, tuple)):
        return value
    if hasattr(value, "tolist") and hasattr(value, "__len__"):
        return list(value)
    raise _wrong(with_article(type_.__name__) if type_ else "a list", value, path)


def _mapping(value: Any, path: str, type_: Any = None) -> Mapping[Any, Any]:
    if isinstance(value, Mapping):
        return value
    if isinstance(value, list) and all(isinstance(item, list) and item for item in value):
        return Property.from_bottle(value)
    raise _wrong(with_article(type_.__name__) if type_ else "a dict", value, path)


def _scalar(kind: type, said: str) -> Callable[[Any, str], Any]:
    def read(value: Any, path: str) -> Any:
        if isinstance(value, bool) and kind is not bool:
            raise _wrong(said, value, path)
        if kind is float and isinstance(value, int):
            return float(value)
        if kind is complex and isinstance(value, (int, float)):
            return complex(value)
        if not isinstance(value, kind):
            raise _wrong(said, value, path)
        if type(value) is kind:
            return value
        return str.__str__(value) if kind is str else kind(value)

    return read


def _list(value: Any, path: str) -> list[Any]:
    return list(_items(value, path))


_BASES: Final = (str, int, float, complex, bytes, list, tuple, dict)
_PLAIN: Final[dict[Any, Callable[[Any, str], Any]]] = {
    str: _scalar(str, "a string"),
    int: _scalar(int, "an integer"),
    float: _scalar(float, "a number"),
    complex: _scalar(complex, "a complex number"),
    bool: _scalar(bool, "true or false"),
    bytes: _scalar(bytes, "a blob"),
    list: _list,
    tuple: lambda value, path: tuple(_items(value, path)),
    dict: lambda value, path: dict(_mapping(value, path)),
}


def _at(path: str) -> str:
    return f" at {path.lstrip('.')}" if path else ""


def _wrong(wanted: str, value: Any, path: str) -> DecodeError:
    try:
        text = print_text([value])[:80]
    except (TypeError, ValueError):
        text = repr(value)[:80]
    return DecodeError(f"expected {wanted}{_at(path)}, got {text}")
