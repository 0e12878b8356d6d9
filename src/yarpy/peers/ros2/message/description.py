"""Types as nodes describe them: every node since Iron answers the service `get_type_description`.

Rules: pure. A description comes from a stranger: it is read as a definition would be, with the same
limits, and what it makes must have the hash that was asked for.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any, Final

from yarpy.errors import DecodeError
from yarpy.limit import ROS2_TYPES
from yarpy.log import readable
from yarpy.peers.ros.message.message import Message
from yarpy.peers.ros2.message.action import plain_name
from yarpy.peers.ros2.message.hash import FILLER, NESTED, full_name
from yarpy.peers.ros2.message.library import Library, Service2, hash_of
from yarpy.peers.ros2.message.parse import BUILTIN

SERVICE: Final = "type_description_interfaces/GetTypeDescription"

_WORDS: Final = {number: word for word, (number, _) in BUILTIN.items() if word != "char"}
_LIMITED: Final = {21: "string", 22: "wstring"}  # of limited length
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*+(?:/[A-Za-z][A-Za-z0-9_]*+){2}")
_FIELD = re.compile(r"[A-Za-z][A-Za-z0-9_]*+")


def type_of(description: Any, name: str, kind: str, hash_: str) -> type[Message] | Service2:
    """The type package/Type of an answer's `type_description`, `kind` being "msg" or "srv". Raises
    DecodeError."""
    whole = full_name(plain_name(name), kind)
    texts = _texts([description.type_description, *description.referenced_type_descriptions])
    if kind == "srv":
        parts = [texts.get(f"{whole}_{half}") for half in ("Request", "Response")]
        if None in parts:
            raise DecodeError(f"the description of {whole} has no request, or no response")
        texts[whole] = "---\n".join(map(str, parts))
    if whole not in texts:
        raise DecodeError(f"the description is of another type than {whole}")
    library = Library([_Described(texts, whole)])
    found = library.message(name) if kind == "msg" else library.service(name)
    if hash_of(found) != hash_:
        raise DecodeError(f"{whole} is described as {hash_of(found)}, but named as {hash_}")
    return found


class _Described:
    """A source: the texts of a description, by their full names."""

    def __init__(self, texts: dict[str, str], name: str) -> None:
        self._texts, self._name = texts, name

    def find(self, name: str, kind: str) -> str | None:
        return self._texts.get(full_name(name, kind))

    def __str__(self) -> str:
        return f"the description of {self._name}"


def _texts(types: Iterable[Any]) -> dict[str, str]:
    """Definitions, by full names."""
    found: dict[str, str] = {}
    for each in types:
        if not _NAME.fullmatch(each.type_name) or len(found) == ROS2_TYPES:
            raise DecodeError(f"a description of {readable(each.type_name[:80])!r}")
        fields = [item for item in each.fields if item.name != FILLER]
        found[each.type_name] = "".join(f"{_spelled(item)}\n" for item in fields)
    return found


def _spelled(item: Any) -> str:
    """A field as in a file."""
    number, capacity = item.type.type_id, item.type.capacity
    base, rest = number % 48, number // 48
    brackets = {0: "", 1: f"[{capacity}]", 2: f"[<={capacity}]", 3: "[]"}.get(rest)
    if base == NESTED:
        word = item.type.nested_type_name if _NAME.fullmatch(item.type.nested_type_name) else ""
    elif base in _LIMITED:
        word = f"{_LIMITED[base]}<={item.type.string_capacity}"
    else:
        word = _WORDS.get(base, "")
    if brackets is None or not word or not _FIELD.fullmatch(item.name):
        raise DecodeError(
            f"a description with the field {readable(item.name[:80])!r} of the type {number}, "
            "which is not known here"
        )
    return f"{word}{brackets} {item.name}"
