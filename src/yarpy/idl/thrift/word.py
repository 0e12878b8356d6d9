"""Python's names for those of Thrift: with a `_` behind where Python, or the class, needs the name.

    from  ->  from_        and back

Rules: a name that ends in `_` already and would be one of those gets one more, so that each name of
Python belongs to one of Thrift.
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
    return f"{name}_" if name.rstrip("_") in taken else name


def original(name: str, taken: Collection[str] = PYTHON) -> str:
    """The name in Thrift."""
    return name[:-1] if name.endswith("_") and name.rstrip("_") in taken else name
