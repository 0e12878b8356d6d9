"""Bottle: the list that every YARP program can read.

Rules: it is a Python list of the objects named in `yarpy.data.value`; nothing is converted when an
element is stored, only when the Bottle is written. The spellings live in `reader`, `writer` and
`text`, which know this class; the methods here import them when called, because two modules cannot
import each other at load time.
"""

from __future__ import annotations

from typing import Any, Self


class Bottle(list[Any]):
    """A list of numbers, strings, vocabs, booleans, blobs, dicts and further lists.

    `Bottle(["set", "pos", 3, 10.5])`, or in YARP's own notation
    `Bottle.from_text("set pos 3 10.5")`.
    """

    __slots__ = ()

    @classmethod
    def from_text(cls, text: str | bytes) -> Self:
        """Read YARP's notation. Unfinished and unbalanced parts vanish, as in C++."""
        from yarpy.data.text import parse_text

        return cls(parse_text(text))

    def to_text(self) -> str:
        """YARP's notation of the elements, on one line and without brackets around it."""
        from yarpy.data.text import print_text

        return print_text(self)

    @classmethod
    def from_bytes(cls, data: bytes | bytearray | memoryview) -> Self:
        """Read a binary message; DecodeError or Truncated if it is none."""
        from yarpy.data.reader import read_bottle

        bottle = read_bottle(data)
        return bottle if type(bottle) is cls else cls(bottle)

    def to_bytes(self) -> bytes:
        """The binary message; TypeError for elements that no message can hold."""
        from yarpy.data.writer import list_blocks

        return b"".join(list_blocks(self))

    def find(self, key: str, default: Any = None) -> Any:
        """The value of `key`: from `(key value)` or from `key value` standing side by side.

        The first element that matches decides; `default` if it has no value beside it.
        """
        from yarpy.data.text import plain_text

        for index, item in enumerate(self):
            if isinstance(item, (list, tuple)):
                if item and plain_text(item[0]) == key:
                    return item[1] if len(item) > 1 else default
            elif plain_text(item) == key:
                return self[index + 1] if index + 1 < len(self) else default
        return default

    def check(self, key: str) -> bool:
        """Is there a group of that name, or a value?"""
        return self.group(key) is not None or self.find(key) is not None

    def group(self, key: str) -> Bottle | None:
        """The whole list `(key ...)`; None if there is none, or if plain `key` stands before it."""
        from yarpy.data.text import plain_text

        for item in self:
            if isinstance(item, (list, tuple)):
                if item and plain_text(item[0]) == key:
                    return item if isinstance(item, Bottle) else Bottle(item)
            elif plain_text(item) == key:
                return None
        return None

    def __repr__(self) -> str:
        return f"Bottle({super().__repr__()})"
