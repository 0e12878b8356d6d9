"""The elements of a Bottle as text, as C++ YARP prints it to the letter.

Rules: printing chooses the form that reads back (`text_reader.py`); the words `null`, `inf` and
`nan` are printed bare although they read back as something else, and a negative NaN prints as
`-nan.0`, because peers do so. A dict prints as the lists `(key value ...)` sorted by key.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from math import copysign, isfinite, isnan
from typing import Any, Final

from yarpy.data.embedded import message_of, plain
from yarpy.data.reader import read_list
from yarpy.data.value import (
    MAX_DEPTH,
    Float32,
    Int8,
    Int16,
    Int64,
    Vocab,
)

_INT64_MAX: Final = 0x7FFFFFFFFFFFFFFF

_BARE = re.compile(r"[A-Za-z_][A-Za-z_0-9.\-]*")
_QUOTED: Final = str.maketrans({"\n": "\\n", "\r": "\\r", "\0": "\\0", "\\": "\\\\", '"': '\\"'})


def print_text(items: Sequence[Any], depth: int = 0) -> str:
    """The text of a list of elements, without brackets around it."""
    if depth > MAX_DEPTH:
        raise ValueError(f"lists nested more than {MAX_DEPTH} deep cannot be sent: flatten them")
    return " ".join([_print(item, depth) for item in items])


class Groups(dict[str, Any]):
    """A dict that knows more of a key than its value: the whole list `(key value ...)`."""

    __slots__ = ()

    def group(self, key: str) -> list[Any] | None:
        """The whole list `(key ...)`, or None."""
        raise NotImplementedError


def sorted_groups(values: Mapping[str, Any]) -> list[list[Any]]:
    """The lists `(key value ...)` that a mapping is in YARP, sorted by the bytes of the keys."""
    return [_group(values, key) for key in _sorted(values)]


def text_of(values: Mapping[str, Any], depth: int = 0) -> str:
    """The text of any mapping with string keys: its sorted lists."""
    return " ".join([f"({print_text(group, depth + 1)})" for group in sorted_groups(values)])


def _sorted(values: Mapping[str, Any]) -> list[str]:
    """The keys in the order of their bytes."""
    for key in values:
        if not isinstance(key, str):
            raise TypeError(f"the key {key!r} is not a string: YARP Properties have string keys")
    return sorted(values, key=lambda key: key.encode("utf-8", "surrogateescape"))


def _group(values: Mapping[str, Any], key: str) -> list[Any]:
    if isinstance(values, Groups):
        whole = values.group(key)
        if whole is not None:
            return whole
    value = values[key]
    return [key] if value is None else [key, value]


def plain_text(value: Any) -> str:
    """A value on its own as text: without quotes or brackets, as keys are compared."""
    if isinstance(value, Vocab):
        return _print_vocab(value).strip("[]")
    if isinstance(value, str):
        return str.__str__(value)
    if isinstance(value, (list, tuple)):
        return print_text(value)
    if value is None:
        return ""
    if isinstance(value, dict):
        return text_of(value)
    if isinstance(value, (bytes, bytearray, memoryview)):
        return _print_bytes(value)
    return _print(value, 0)


def _print(value: Any, depth: int) -> str:
    show = _PRINTERS.get(type(value))
    if show is not None:
        return show(value)
    if isinstance(value, (list, tuple)):
        return f"({print_text(value, depth + 1)})"
    if isinstance(value, dict):
        return f"({text_of(value, depth + 1)})"
    for kind in (Vocab, str, int, float, bytes, bytearray):
        if isinstance(value, kind):
            return _PRINTERS[kind](value)
    number = plain(value)
    if number is not value:
        return _print(number, depth)
    items = read_list(list, _newest_groups, message_of(value))
    return f"({print_text(items, depth + 1)})"


def _newest_groups(items: list[Any]) -> list[Any]:
    """A dict as it prints, from all its lists: one for each key, the last of it."""
    found = {plain_text(item[0]) if item else "": item for item in items if isinstance(item, list)}
    return [found[key] for key in _sorted(found)]


def _print_str(value: str) -> str:
    if _BARE.fullmatch(value) and value != "true" and value != "false":
        return value
    return f'"{value.translate(_QUOTED)}"'


def _print_int(value: int) -> str:
    if not -_INT64_MAX - 1 <= value <= _INT64_MAX:  # whoever reads it would take the nearest
        raise OverflowError(f"{value} does not fit in 64 bits; send it as a float or a string")
    return int.__repr__(value)


def _print_float(value: float) -> str:
    text = f"{value:.21g}"
    if "." in text or "e" in text:
        return text
    if isfinite(value):
        return text + ".0"
    return "-nan.0" if isnan(value) and copysign(1.0, value) < 0 else text


def _print_bool(value: bool) -> str:
    return "true" if value else "false"


def _print_vocab(value: Vocab) -> str:
    # a Vocab object may hold the codes that otherwise arrive as booleans
    if value.code == 0 or value.code == 0x31:
        return _print_bool(value.code != 0)
    return f"[{str.__str__(value)}]"


def _print_bytes(value: Iterable[int]) -> str:
    return " ".join(map(str, bytes(value)))


def _print_blob(value: Iterable[int]) -> str:
    return "{" + _print_bytes(value) + "}"


_PRINTERS: Final[dict[type, Callable[[Any], str]]] = {
    str: _print_str,
    int: _print_int,
    float: _print_float,
    bool: _print_bool,
    Vocab: _print_vocab,
    Int8: _print_int,
    Int16: _print_int,
    Int64: _print_int,
    Float32: _print_float,
    bytes: _print_blob,
    bytearray: _print_blob,
    memoryview: _print_blob,
}
