"""The Python class of a type: fields with defaults, constants, documentation, and how it is read
and written.

Rules: made from a Definition and the classes of the types in it, nothing else. A default is made
anew for each object; numbers side by side are arrays, which have the length that is declared.
What has to be compiled is compiled when it is first used: a type may come from a stranger who
never sends a value of it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import ModuleType
from typing import Any

from yarpy.data.generated import Code
from yarpy.peers.ros.message import reader as plain_reader
from yarpy.peers.ros.message import writer as plain_writer
from yarpy.peers.ros.message.convert.bottle import from_bottle, to_bottle
from yarpy.peers.ros.message.definition import Definition
from yarpy.peers.ros.message.message import Duration, Message, Time, attribute
from yarpy.peers.ros.message.model import Field, ListOf, Primitive, Struct, Type
from yarpy.peers.ros.message.wire import from_wire, to_wire

_PACKAGE = __name__.rpartition(".")[0]


def make(
    definition: Definition,
    used: Mapping[Struct, type[Message]],
    restore: Callable[[str, str, bytearray], Message],
    reader: ModuleType = plain_reader,
    writer: ModuleType = plain_writer,
) -> type[Message]:
    """The class of a type; `used` has those of all types in it. `restore` makes a message of its
    name, full text and bytes in whatever process they are unpickled; `reader` and `writer` know
    these bytes."""
    struct = definition.struct
    package, _, name = definition.name.rpartition("/")
    names = tuple(map(attribute, struct.fields))
    namespace: dict[str, Any] = {
        **{attribute(constant): constant.value for constant in struct.constants},
        "__slots__": names,
        "__doc__": documentation(struct),
        "__module__": f"{_PACKAGE}.{package}" if package else _PACKAGE,
        "__annotations__": {attribute(item): annotation(item.type) for item in struct.fields},
        "_type": definition.name,
        "_md5sum": definition.md5sum,
        "_full_text": definition.full_text,
        "_definition": definition,
        "_names": names,
        "_used": dict(used),
        "_has_header": _begins_with_header(struct),
        "_is_text": _is_text(struct),
        "_restore": staticmethod(restore),
        "to_bottle": to_bottle,
        "from_bottle": classmethod(from_bottle),
        "to_wire": to_wire,
        "from_wire": classmethod(from_wire),
    }
    made: type[Message] = type(name, (Message,), namespace)
    classes = {**used, struct: made}
    for attr, make_it in {
        "__init__": lambda: _initialiser(struct, used),
        "_read": lambda: staticmethod(reader.reader(struct, classes)),
        "_write": lambda: staticmethod(writer.writer(struct, used)),
        "from_ros": lambda: staticmethod(reader.whole(struct, made._read)),
        "to_ros": lambda: writer.whole(struct, made._write),
    }.items():
        setattr(made, attr, _Late(made, attr, make_it))
    return made


def _begins_with_header(struct: Struct) -> bool:
    first = struct.fields[0].type if struct.fields else None
    return isinstance(first, Struct) and first.name == "std_msgs/Header"


def _is_text(struct: Struct) -> bool:
    kinds = [field.type for field in struct.fields]
    return len(kinds) == 1 and isinstance(kinds[0], Primitive) and kinds[0].name == "string"


class _Late:
    """An attribute of a class that is made when it is first asked for."""

    def __init__(self, owner: type[Message], name: str, make_it: Callable[[], Any]) -> None:
        self._owner, self._name, self._make_it = owner, name, make_it

    def __get__(self, instance: Message | None, owner: type[Message]) -> Any:
        found = self._make_it()
        setattr(self._owner, self._name, found)  # of two threads the later one wins
        return found.__get__(instance, owner)


def annotation(kind: Type) -> str:
    """Return the type as it is written in Python."""
    if isinstance(kind, ListOf):
        element = kind.element
        if isinstance(element, Primitive) and element.is_number:
            return f"NDArray[np.{'bool_' if element.name == 'bool' else element.name}]"
        return f"list[{annotation(element)}]"
    if isinstance(kind, Primitive):
        if kind.is_number:
            return "bool" if kind.name == "bool" else kind.name.rstrip("0123456789").lstrip("u")
        return {"string": "str", "binary": "bytes"}.get(kind.name, kind.name.capitalize())
    return kind.name.rpartition("/")[2]


def documentation(struct: Struct) -> str:
    """The comments of a type, and a line for each of its fields and constants."""
    lines = [f"{struct.name}\n\n{struct.doc}" if struct.doc else struct.name, ""]
    lines += [f"    {item.type} {attribute(item)}{_beside(item.doc)}" for item in struct.fields]
    lines += [
        f"    {item.type} {attribute(item)} = {item.value!r}{_beside(item.doc)}"
        for item in struct.constants
    ]
    return "\n".join(lines).strip()


def _beside(doc: str) -> str:
    """A comment behind a declaration, further lines below it."""
    return f"  # {doc}".replace("\n", "\n        # ") if doc else ""


def _initialiser(struct: Struct, used: Mapping[Struct, type[Message]]) -> Callable[..., None]:
    code = Code()
    arguments = ["self"]
    for item in struct.fields:
        name = attribute(item)
        default = _default(item.type, used) if item.default is None else _given(item)
        if callable(default):
            arguments.append(f"{name}=None")
            code.line(f"self.{name} = {code.name(default)}() if {name} is None else {name}")
        else:
            arguments.append(f"{name}={code.name(default)}")
            code.line(f"self.{name} = {name}")
    return code.compiled("__init__", ", ".join(arguments))


def _given(item: Field) -> Any:
    """Return the default of a field: a value, or the function that makes a list of such
    elements."""
    kind, given = item.type, item.default
    if not isinstance(kind, ListOf):
        return given
    element = kind.element
    if isinstance(element, Primitive) and element.is_number:
        import numpy as np

        dtype = np.dtype("<" + element.letters)
        return lambda: np.array(given, dtype)
    return lambda: [*given]


def _default(kind: Type, used: Mapping[Struct, type[Message]]) -> Any:
    """A value that never changes, or what makes one."""
    if isinstance(kind, Struct):
        return used[kind]
    if isinstance(kind, ListOf):
        return _default_list(kind, used)
    assert isinstance(kind, Primitive)
    if kind.is_number:
        return {"bool": False, "float32": 0.0, "float64": 0.0}.get(kind.name, 0)
    return {"time": Time(), "duration": Duration()}.get(kind.name, "")


def _default_list(kind: ListOf, used: Mapping[Struct, type[Message]]) -> Callable[[], Any]:
    element, length = kind.element, kind.length or 0
    if isinstance(element, Primitive) and element.is_number:
        import numpy as np

        dtype = np.dtype("<" + element.letters)
        return lambda: np.zeros(length, dtype)
    default = _default(element, used)
    if not length:
        return list
    if callable(default):
        return lambda: [default() for _ in range(length)]
    return lambda: [default] * length
