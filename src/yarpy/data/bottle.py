"""Bottle and Property: the list and the dictionary that every YARP program can read.

Rules: a Bottle is a Python list of the objects named in `yarpy.data.value`; nothing is converted
when an element is stored, only when it is written. A Property as a message is the Bottle of its
text, lists `(key value ...)` sorted by key, so kinds that text cannot express become the nearest
kind on the way out (an Int8 an int32, a Float32 a double, a dict a list of lists). Reading one
takes list elements only; a later key wins.

Both are in one file because each may hold the other. The spellings are in `reader`, `writer` and
`text`, which know neither and are handed the classes to make.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, Self

from yarpy.data.array_export import ArrayExport
from yarpy.data.numbers import Packed
from yarpy.data.reader import read_list
from yarpy.data.text import Groups, plain_text, print_text, text_of
from yarpy.data.text_reader import parse_text
from yarpy.data.value import Buffer
from yarpy.data.writer import dict_elements, list_blocks

if TYPE_CHECKING:
    from numpy.typing import NDArray


class Bottle(ArrayExport, list[Any]):
    """A list of numbers, strings, vocabs, booleans, blobs, dicts and further lists.

    `Bottle(["set", "pos", 3, 10.5])`, or in YARP's own notation
    `Bottle.from_text("set pos 3 10.5")`.
    """

    __slots__ = ()

    @classmethod
    def from_text(cls, text: str | bytes) -> Self:
        """Read YARP's notation. Unfinished and unbalanced parts vanish, as in C++."""
        return cls(parse_text(text, Bottle))

    def to_text(self) -> str:
        """YARP's notation of the elements, on one line and without brackets around it."""
        return print_text(self)

    @classmethod
    def from_bytes(cls, data: bytes | bytearray | memoryview) -> Self:
        """Read a binary message; DecodeError or Truncated if it is none."""
        bottle = read_bottle(data)
        return bottle if isinstance(bottle, cls) else cls(bottle)

    def to_bytes(self) -> bytes:
        """The binary message; TypeError for elements that no message can hold."""
        return b"".join(list_blocks(self))

    def find(self, key: str, default: Any = None) -> Any:
        """The value of `key`: from `(key value)` or from `key value` standing side by side.

        The first element that matches decides; `default` if it has no value beside it.
        """
        for index, item in enumerate(self):
            if isinstance(item, (list, tuple)):
                if item and plain_text(item[0]) == key:
                    return item[1] if len(item) > 1 else default
            elif plain_text(item) == key:
                return self[index + 1] if index + 1 < len(self) else default
        return default

    def check(self, key: str) -> bool:
        """Return whether there is a group of that name, or a value."""
        return self.group(key) is not None or self.find(key) is not None

    def group(self, key: str) -> Bottle | None:
        """The whole list `(key ...)`; None if there is none, or if plain `key` stands before it."""
        for item in self:
            if isinstance(item, (list, tuple)):
                if item and plain_text(item[0]) == key:
                    return item if isinstance(item, Bottle) else Bottle(item)
            elif plain_text(item) == key:
                return None
        return None

    @property
    def array(self) -> NDArray[Any]:
        """The numbers as a numpy array: of two dimensions for rows, columns and a list of as many
        numbers, which a Matrix is, else of one. Of a received list of numbers it is a view of the
        received bytes. ValueError for what is no array."""
        import numpy as np

        if len(self) == 3 and isinstance(self[2], list):
            rows, cols, numbers = self
            if type(rows) is type(cols) is int and len(numbers) == rows * cols and rows >= 0:
                flat: NDArray[Any] = np.asarray(numbers, "f8")
                return flat.reshape(rows, cols)
        return np.array(list(self))

    def __repr__(self) -> str:
        return f"Bottle({super().__repr__()})"


class Numbers(Packed, Bottle):
    """A Bottle of numbers of one kind, as it came. It is unpacked when an element is asked for;
    `array` needs none."""

    __slots__ = ()

    def __reduce__(self) -> tuple[Callable[[list[Any]], Bottle], tuple[list[Any]]]:
        return Bottle, (list(self),)

    def __reduce_ex__(
        self, protocol: Any
    ) -> tuple[Callable[[list[Any]], Bottle], tuple[list[Any]]]:
        return self.__reduce__()


class Property(Groups):
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
        return cls.from_bottle(parse_text(text, Bottle))

    def to_text(self) -> str:
        """YARP's notation, sorted by key."""
        return text_of(self)

    @classmethod
    def from_bytes(cls, data: bytes | bytearray | memoryview) -> Self:
        """Read a binary message; DecodeError or Truncated if it is none."""
        return cls.from_bottle(Bottle.from_bytes(data))

    def to_bytes(self) -> bytes:
        """The binary message: the Bottle of the text."""
        return b"".join(list_blocks(dict_elements(self)))

    def group(self, key: str) -> Bottle | None:
        """The whole list `(key ...)`, or None."""
        if key not in self:
            return None
        value = self[key]
        known, group = self._groups.get(key, (None, None))
        if group is not None and known is value:
            return group
        return Bottle([key]) if value is None else Bottle([key, value])

    def find(self, key: str, default: Any = None) -> Any:
        """The value of `key`, or `default`: the same as `get`, under the name Bottles have."""
        return self.get(key, default)

    def check(self, key: str) -> bool:
        """Return whether there is such a key, with or without a value."""
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


def read_bottle(view: Buffer) -> Bottle:
    """The Bottle at the start of `view`; Truncated or DecodeError if there is none."""
    return read_list(Bottle, Property.from_bottle, view, Numbers.over)
