"""Classes that the library takes for types of ROS 2, and that carry finished bytes.

Rules: what a class says of its fields is what others can compare with their own types; the bytes
are never looked at. Questions and answers of services have a header in front of their fields.
"""

from __future__ import annotations

from typing import Any

from yarpy.peers.ros.message.model import ListOf, Primitive, Struct, Type
from yarpy.peers.ros2.dds.library import turn
from yarpy.peers.ros2.message.hash import dds_name


def raw_class(struct: Struct, kind: str = "msg") -> Any:
    """The class for a message; with the kind `srv` for the request or response of a service."""
    with turn:
        made = _dds_class(struct, kind)
        made.__idl__.fill_type_data()  # else its first topic does, and in any thread

    def serialize(self: Any, *arguments: Any, **options: Any) -> bytes:
        body: bytes = self.body
        return body

    def deserialize(cls: Any, data: bytes, *arguments: Any, **options: Any) -> Any:
        found = cls.__new__(cls)
        found.body = bytes(data)
        return found

    made.serialize, made.deserialize = serialize, classmethod(deserialize)
    return made


def _dds_class(struct: Struct, kind: str = "msg") -> Any:
    from cyclonedds.idl import make_idl_struct
    from cyclonedds.idl.types import int64, uint8, uint64

    fields: dict[str, Any] = {"guid": uint64, "seq": int64} if kind == "srv" else {}
    own = {field.name: _dds_type(field.type) for field in struct.fields}
    fields.update(own or {"structure_needs_at_least_one_member": uint8})
    name = dds_name(struct.name, kind)
    return make_idl_struct(name.rpartition("::")[2], name.replace("::", "."), fields)


def _dds_type(kind: Type) -> Any:
    from cyclonedds.idl import types as known

    types: Any = known
    if isinstance(kind, Struct):
        return _dds_class(kind)
    if isinstance(kind, ListOf):
        element = _dds_type(kind.element)
        if kind.length is not None:
            return types.array[element, kind.length]
        if kind.most is not None:
            return types.sequence[element, kind.most]
        return types.sequence[element]
    assert isinstance(kind, Primitive)
    if kind.wide:
        return types.sequence[types.uint32]  # which the library has, and which is the same bytes
    if kind.name in ("bool", "string"):
        return {"bool": bool, "string": str}[kind.name]
    return getattr(types, kind.name)
