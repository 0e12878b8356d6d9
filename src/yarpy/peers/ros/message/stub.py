"""Python code for types: a module that needs no definition to be found, and stubs for editors.

Rules: a module has everything that its types contain, those within first, and their full texts: it
works wherever yarpy is. Two types of the same short name are called package_Type. Texts are written
as Python literals, so nothing in a comment becomes code.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from yarpy.peers.ros.message.factory import annotation
from yarpy.peers.ros.message.library import Service
from yarpy.peers.ros.message.message import TIMES, Message, attribute
from yarpy.peers.ros.message.model import ListOf, Primitive, Struct, Type

Loaded = type[Message] | Service

_HEAD = '''"""Messages of ROS, written by `yarpy idl rosmsg {option}`: {names}."""

'''
_IMPORTS = """from yarpy.peers.ros.message.library import default_library

_library = default_library()
"""
_STUB_IMPORTS = """from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray
from yarpy.peers.ros.message.library import Service
from yarpy.peers.ros.message.message import Duration, Message, Time

__all__ = {names}
"""


def python(types: Iterable[Loaded]) -> str:
    """The text of a module with the classes of these types."""
    given = [*types]
    lines = [_head("--python", given), _IMPORTS]
    for name, found in _named(given).items():
        make = "service_of" if isinstance(found, Service) else "message_of"
        full = found.full_text if isinstance(found, Service) else found._full_text
        lines.append(f"{name} = _library.{make}(\n    {_type_name(found)!r},\n{_literal(full)})\n")
    return "\n".join(lines)


def stubs(types: Iterable[Loaded]) -> str:
    """The text of the `.pyi` file that belongs to `python(types)`."""
    given = [*types]
    named = _named(given)
    names = {_type_name(found): name for name, found in named.items()}
    parts = [_head("--stubs", given) + _STUB_IMPORTS.format(names=[*named])]
    for name, found in named.items():
        if isinstance(found, Service):
            parts.append(_service_stub(name, found, names))
        else:
            parts.append(_class_stub(name, found, names))
    return "\n".join(parts)


def _head(option: str, given: list[Loaded]) -> str:
    return _HEAD.format(option=option, names=", ".join(map(_type_name, given)))


def _type_name(found: Loaded) -> str:
    return found.name if isinstance(found, Service) else found._type


def _named(given: list[Loaded]) -> dict[str, Loaded]:
    """Every type that is needed by its name in the module, those within others first."""
    needed: dict[str, Loaded] = {}

    def need(found: Loaded) -> None:
        if _type_name(found) in needed:
            return
        if isinstance(found, Service):
            need(found.Request)
            need(found.Response)
        else:
            own = {used._type: used for used in found._used.values()}
            for other in found._definition.used:
                need(own[other.name])
        needed[_type_name(found)] = found

    for found in given:
        need(found)
    short = [name.rpartition("/")[2] for name in needed]
    return {
        plain if short.count(plain) == 1 and plain not in _TAKEN else name.replace("/", "_"): found
        for (name, found), plain in zip(needed.items(), short, strict=True)
    }


_TAKEN = frozenset(
    ("Duration", "Message", "Service", "Time", "ClassVar", "ArrayLike", "NDArray", "None", "True")
)


def _literal(text: str) -> str:
    """A text as string literals, one for each line of it."""
    lines = text.splitlines(keepends=True) or [""]
    return "".join(f"    {line!r}\n" for line in lines)


def _class_stub(name: str, cls: type[Message], names: dict[str, str]) -> str:
    struct = cls._definition.struct
    lines = [f"class {name}(Message):", _documented(cls.__doc__ or "")]
    lines += [
        f"    {attribute(item)}: ClassVar[{type(item.value).__name__}]" for item in struct.constants
    ]
    lines += [f"    {attribute(item)}: {_annotated(item.type, names)}" for item in struct.fields]
    lines += ["", "    def __init__("]
    lines += ["        self,"]
    lines += [
        f"        {attribute(item)}: {_accepted(item.type, names)} = ...," for item in struct.fields
    ]
    lines += ["    ) -> None: ..."]
    return "\n".join(lines) + "\n"


def _service_stub(name: str, service: Service, names: dict[str, str]) -> str:
    request, response = (names[half._type] for half in (service.Request, service.Response))
    return (
        f"class _{name}(Service):\n"
        f"    Request: type[{request}]\n"
        f"    Response: type[{response}]\n\n"
        f"{name}: _{name}\n"
    )


def _annotated(kind: Type, names: dict[str, str]) -> str:
    if isinstance(kind, Struct):
        return names[kind.name]
    if isinstance(kind, ListOf) and isinstance(kind.element, Struct):
        return f"list[{names[kind.element.name]}]"
    return annotation(kind)


def _accepted(kind: Type, names: dict[str, str]) -> str:
    """Return the annotation of what may be assigned to a field: any numbers for an array of
    them, seconds for a time."""
    element: Any = kind.element if isinstance(kind, ListOf) else None
    if isinstance(element, Primitive) and element.is_number:
        return "ArrayLike"
    found = _annotated(kind, names)
    if not isinstance(kind, ListOf) and kind.name in TIMES:
        found += " | float"
    return found if isinstance(kind, Primitive) else f"{found} | None"


def _documented(text: str) -> str:
    """A docstring; what would end it is escaped."""
    escaped = text.replace("\\", "\\\\").replace('"""', '\\"\\"\\"')
    body = escaped.replace("\n", "\n    ").replace("\n    \n", "\n\n")
    if body.endswith('"'):
        body += " "
    return f'    """{body}"""'
