"""Services, structs and enums as plain data, for programs that show or offer them to others.

    {"name": "Camera", "kind": "service", "doc": "", "version": 0,
     "methods": [{"name": "set_speed", "doc": "Sets ...", "oneway": False,
                  "result": {"type": "bool"},
                  "arguments": [{"name": "speed", "type": "double"},
                                {"name": "exactly", "type": "bool", "default": False}]}],
     "types": {"Mode": {"name": "Mode", "kind": "enum", "doc": "", "values": {"AUTO": 0}}}}

Rules: everything in it can be written as JSON. A type is named as in the `.thrift` file,
`list<double>`; structs and enums that are mentioned anywhere stand once under `types`.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from enum import IntEnum
from typing import Any

from yarpy.kits.thrift.kind import Kind, ListOf, MapOf, SetOf, name_of
from yarpy.kits.thrift.method import Method
from yarpy.kits.thrift.service import Service
from yarpy.kits.thrift.structure import Enum, Struct


def describe(what: Any) -> dict[str, Any]:
    """Return what a service, a struct or an enum consists of, as dicts, lists, strings and numbers.

    `what` is the class or an object of it. A field or argument without `default` has to be given;
    a default that is no plain value is its text. Raises TypeError for anything else.
    """
    cls = what if isinstance(what, type) else type(what)
    seen: dict[str, dict[str, Any]] = {}
    if issubclass(cls, Service):
        found = _service(cls, seen)
    elif issubclass(cls, Struct | Enum):
        found = _described(cls, seen)
        seen.pop(cls.__name__, None)
    else:
        raise TypeError(
            f"{cls.__name__} is of no .thrift file: describe takes a service, a struct or an enum"
        )
    return {**found, "types": seen}


def _service(cls: type[Service], seen: dict[str, dict[str, Any]]) -> dict[str, Any]:
    methods = [_method(each, seen) for each in cls._methods.values()]
    head = {"name": cls.__name__, "kind": "service", "doc": _doc(cls)}
    return {**head, "version": cls._version, "methods": methods}


def _method(method: Method, seen: dict[str, dict[str, Any]]) -> dict[str, Any]:
    first = len(method.parts) - len(method.defaults)
    arguments = []
    for at, part in enumerate(method.parts):
        default = method.defaults[at - first] if at >= first else None
        arguments.append(_named(part.name, part.kind, default, seen))
    result = None if method.result is None else {"type": _type(method.result, seen)}
    head = {"name": method.name, "doc": method.doc, "oneway": method.oneway}
    return {**head, "result": result, "arguments": arguments}


def _described(cls: Any, seen: dict[str, dict[str, Any]]) -> dict[str, Any]:
    head: dict[str, Any] = {"name": cls.__name__, "kind": cls._thrift, "doc": _doc(cls)}
    seen[cls.__name__] = head  # before its fields, which may be of its own type
    if issubclass(cls, Enum):
        head["values"] = {name: int(one) for name, one in cls.__members__.items()}
    else:
        head["fields"] = [_named(each.name, each.kind, each.default, seen) for each in cls._specs()]
    return head


def _named(
    name: str, kind: Kind, default: Callable[[], Any] | None, seen: dict[str, dict[str, Any]]
) -> dict[str, Any]:
    found = {"name": name, "type": _type(kind, seen)}
    if default is not None:
        found["default"] = _plain(default())
    return found


def _type(kind: Kind, seen: dict[str, dict[str, Any]]) -> str:
    """Return the name of a kind, and describe what is in it."""
    if isinstance(kind, type):
        if kind.__name__ not in seen:
            _described(kind, seen)
    elif isinstance(kind, ListOf | SetOf):
        _type(kind.element, seen)
    elif isinstance(kind, MapOf):
        _type(kind.key, seen)
        _type(kind.value, seen)
    return name_of(kind)


def _plain(value: Any) -> Any:
    if isinstance(value, IntEnum):
        return value.name
    if value is None or isinstance(value, bool | int | float | str):
        return value
    if isinstance(value, Struct):
        return {spec.name: _plain(getattr(value, spec.attribute)) for spec in value._specs()}
    if isinstance(value, dict):
        return {str(_plain(key)): _plain(item) for key, item in value.items()}
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, list | tuple | set | frozenset):
        return [_plain(item) for item in value]
    return bytes(value).decode("latin-1") if isinstance(value, bytes) else str(value)


def _doc(cls: type[Any]) -> str:
    return inspect.cleandoc(cls.__dict__.get("__doc__") or "")
