"""Property: the dictionary that YARP programs can read.

Rules: as a message it is the Bottle of its text, lists `(key value ...)` sorted by key, so kinds
that text cannot express become the nearest kind on the way out (an Int8 an int32, a Float32 a
double, a dict a list of lists). Reading takes list elements only; a later key wins.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, Self

from yarpy.data.bottle import Bottle


class Property(dict[str, Any]):
    """Named values. The value of `(key)` alone is None; `group(key)` gives all of `(key a b c)`."""

    __slots__ = ("_groups",)
    # Lists that say more than key and value, kept with the value they belong to: when another value
    # is put under the key, the rest of the old list no longer counts.
    _groups: dict[str, tuple[Any, Bottle]]

    def __init__(self, *args: Any, **values: Any) -> None:
        super().__init__(*args, **values)
        self._groups = dict(args[0]._groups) if args and isinstance(args[0], Property) else {}

    @classmethod
    def from_bottle(cls, items: Iterable[Any]) -> Self:
        """Take the `(key value ...)` lists among `items` and nothing else."""
        from yarpy.data.text import plain_text

        self = cls()
        for item in items:
            if not isinstance(item, (list, tuple)):
                continue
            key = plain_text(item[0]) if item else ""
            value = item[1] if len(item) > 1 else None
            self[key] = value
            if len(item) != 2 or type(item[0]) is not str:
                self._groups[key] = (value, item if isinstance(item, Bottle) else Bottle(item))
            else:
                self._groups.pop(key, None)
        return self

    @classmethod
    def from_text(cls, text: str | bytes) -> Self:
        """Read `(key value) (key value)`; elements that are not lists are skipped."""
        from yarpy.data.text import parse_text

        return cls.from_bottle(parse_text(text))

    def to_text(self) -> str:
        """YARP's notation, sorted by key."""
        return text_of(self)

    @classmethod
    def from_bytes(cls, data: bytes | bytearray | memoryview) -> Self:
        """Read a binary message; DecodeError or Truncated if it is none."""
        return cls.from_bottle(Bottle.from_bytes(data))

    def to_bytes(self) -> bytes:
        """The binary message: the Bottle of the text."""
        return bottle_of(self).to_bytes()

    def group(self, key: str) -> Bottle | None:
        """The whole list `(key ...)`, or None."""
        if key not in self:
            return None
        return _group(self, key, self[key])

    def find(self, key: str, default: Any = None) -> Any:
        """The value of `key`, or `default`: the same as `get`, under the name Bottles have."""
        return self.get(key, default)

    def check(self, key: str) -> bool:
        """Is there such a key, with or without a value?"""
        return key in self

    def update(self, *args: Any, **values: Any) -> None:
        """As for any dict; from another Property the whole lists are taken."""
        super().update(*args, **values)
        if args and isinstance(args[0], Property):
            self._groups.update(args[0]._groups)

    def copy(self) -> Self:
        return type(self)(self)

    def __repr__(self) -> str:
        return f"Property({super().__repr__()})"


def text_of(values: Mapping[str, Any], depth: int = 0) -> str:
    """The text of any mapping with string keys, sorted by the bytes of the keys."""
    from yarpy.data.text import print_text

    groups = (_group(values, key, values[key]) for key in _sorted(values))
    return " ".join(f"({print_text(group, depth + 1)})" for group in groups)


def bottle_of(values: Mapping[str, Any]) -> Bottle:
    """The elements of a Property message: its `text_of`, read back."""
    try:
        return Bottle(
            Bottle(map(_through_text, _group(values, key, values[key]))) for key in _sorted(values)
        )
    except _NotPlain:
        return Bottle.from_text(text_of(values))


class _NotPlain(Exception):
    """Only printing and reading it back shows what this value becomes."""


def _through_text(value: Any) -> Any:
    """A value after it was printed and read back: mostly unchanged."""
    kind = type(value)
    if kind is int or kind is bool or kind is bytes:
        return value
    if kind is str and value not in ("null", "inf", "nan"):
        return value
    if kind is float and value == value:
        return value
    if kind is list or kind is Bottle or kind is tuple:
        return Bottle(map(_through_text, value))
    raise _NotPlain


def _sorted(values: Mapping[str, Any]) -> list[str]:
    """The keys in the order of their bytes."""
    for key in values:
        if not isinstance(key, str):
            raise TypeError(f"the key {key!r} is not a string: YARP Properties have string keys")
    return sorted(values, key=lambda key: key.encode("utf-8", "surrogateescape"))


def _group(values: Mapping[str, Any], key: str, value: Any) -> Bottle:
    if isinstance(values, Property):
        known, group = values._groups.get(key, (None, None))
        if group is not None and known is value:
            return group
    return Bottle([key]) if value is None else Bottle([key, value])
