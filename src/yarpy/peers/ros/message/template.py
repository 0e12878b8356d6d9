"""The template of a type: what C++ YARP asks a type server for, to translate the bytes of ROS into
Bottles and back without knowing the type.

    template = item... ["---" item...]            behind `---` the answer of a service
    item     = kind *                             a number or string
             | vector kind N * | vector kind *    N of them, or as many as are counted
             | list N item...                     a list of N

Rules: constants take no part, and arrays of fixed length are not counted (in both C++ YARP errs).
What a template cannot say, lists of messages and arrays of times, makes it "?", which C++ YARP
takes for "not known".
"""

from __future__ import annotations

from typing import Final

from yarpy.peers.ros.message.definition import Definition, ServiceDefinition
from yarpy.peers.ros.message.model import ListOf, Primitive, Struct, Type

UNKNOWN: Final = "?"


def template(definition: Definition | ServiceDefinition) -> str:
    """The template, or "?"."""
    try:
        if isinstance(definition, Definition):
            return _struct(definition.struct)
        halves = (definition.request.struct, definition.response.struct)
        return " --- ".join(map(_struct, halves))
    except ValueError:
        return UNKNOWN


def _struct(struct: Struct) -> str:
    kinds = {str(field.type) for field in struct.fields}
    first = struct.fields[0].type if struct.fields else None
    if len(kinds) == 1 and isinstance(first, Primitive) and len(first.letters) < 2:
        return f"vector {first} {len(struct.fields)} *"
    items = (_item(field.type) for field in struct.fields)
    return " ".join([f"list {len(struct.fields)}", *items])


def _item(kind: Type) -> str:
    if isinstance(kind, Struct):
        return _struct(kind)
    if isinstance(kind, ListOf):
        element = kind.element
        if not isinstance(element, Primitive) or len(element.letters) == 2:
            raise ValueError("no template says this")
        return f"vector {element} {'' if kind.length is None else f'{kind.length} '}*"
    if isinstance(kind, Primitive) and len(kind.letters) == 2:
        return f"vector {'uint32' if kind.name == 'time' else 'int32'} 2 *"
    return f"{kind} *"
