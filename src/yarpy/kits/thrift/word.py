"""Python's names for those of Thrift: with a `_` behind where Python, or the class, needs the name.

    from   ->  from_        and back
    _enum  ->  enum_        and back by what a class has noted

Rules: a name that ends in `_` already and would be one of those gets one more, so that each name of
Python belongs to one of Thrift. A `_` before a name, which in Python makes it nobody else's
business, goes behind it; the two that would then be one are refused by `interface`.
"""

from __future__ import annotations

import keyword
import sys
from collections.abc import Collection
from enum import IntEnum
from typing import Final

#: no name of a type, a constant or an argument
PYTHON: Final = frozenset((*keyword.kwlist, "self"))
#: no name of a module in a file: it would hide Python's own `types`, and nothing would start
MODULES: Final = sys.stdlib_module_names | {"numpy", "yarpy"}
#: no name of a type or a constant: what a module of classes is written with
TYPES: Final = PYTHON | {
    *("str", "int", "float", "bool", "bytes", "list", "dict", "set", "tuple", "type", "object"),
    *("property", "classmethod", "staticmethod", "NotImplementedError"),
}
#: what structs have beside their fields
STRUCT: Final = PYTHON | {
    *("to_wire", "from_wire", "to_bottle", "from_bottle", "to_dict", "to_text", "Editor"),
}
#: what exceptions have beside their fields
ERROR: Final = STRUCT | {"args", "with_traceback", "add_note"}
#: what constants of an enum have
ENUM: Final = (
    PYTHON
    | {name for name in dir(IntEnum) if not name.startswith("_")}
    | {
        *dir(int),
        *("mro", "name", "value", "word"),
    }
)
#: what services have beside their methods
SERVICE: Final = PYTHON | {
    *("connect", "connect_async", "close", "page", "help", "remote_version", "timeout"),
}


def attribute(name: str, taken: Collection[str] = PYTHON) -> str:
    """The name in Python."""
    if name.startswith("_"):
        return attribute(name.lstrip("_"), taken).rstrip("_") + "_"
    return f"{name}_" if name.rstrip("_") in taken else name


def original(name: str, taken: Collection[str] = PYTHON) -> str:
    """The name in Thrift."""
    return name[:-1] if name.endswith("_") and name.rstrip("_") in taken else name
