"""The structure of messages that consist of numbers: where these are in their bytes.

    256, 2, 1, 7, 10, 0.5               two numbers
    256, 2, 266, 3, ..., 9, 'ok'        three of a list, and a word that is no number

Rules: pure. The messages of a port are mostly alike: a structure is found once, and then compared
with each message by one call, so that what is recorded costs little. What has texts, blobs or
dictionaries in it has none, nor what has too many numbers or lists in lists.
"""

from __future__ import annotations

from operator import itemgetter
from struct import Struct, error
from typing import Any, Final

from yarpy.data.value import FIXED, GROUP_MASK, LIST, UNIT_MASK, VOCAB32

NUMBERS: Final = 4096  # in a message; lists of one kind of number may be longer
DEPTH: Final = 4  # lists in lists
_TAG: Final = Struct("<i")


class Structure:
    """The places of the numbers in messages of `size` bytes that are built alike.

    `outline` tells what a message is: a letter of `struct` for a number, "v" for a vocab, and
    a tuple of these for a list.
    """

    __slots__ = ("_fixed", "_known", "_layout", "_values", "outline", "size")

    def __init__(self, payload: bytes | bytearray | memoryview) -> None:
        """Raises ValueError if it is something else."""
        walk = _Walk(payload)
        self.outline: tuple[Any, ...] = walk.root()
        self.size = len(payload)
        if not walk.values:
            raise ValueError("no numbers")
        self._layout = Struct("<" + "".join(walk.letters))
        found = self._layout.unpack(payload)
        self._fixed = _getter(walk.fixed)
        self._known = self._fixed(found)
        self._values = _getter(walk.values)

    def values(self, payload: bytes | bytearray | memoryview) -> tuple[float, ...] | None:
        """Return the numbers of a message; None if it is built in another way."""
        if len(payload) != self.size:
            return None
        found = self._layout.unpack(payload)
        return self._values(found) if self._fixed(found) == self._known else None


def _getter(places: list[int]) -> Any:
    """Return a function that takes a tuple of what is at these places."""
    if len(places) == 1:
        place = places[0]
        return lambda found: (found[place],)
    return itemgetter(*places)


class _Walk:
    """Goes over a message once. Raises ValueError."""

    def __init__(self, payload: bytes | bytearray | memoryview) -> None:
        self._payload = payload
        self._at = 0
        self._place = 0
        self.letters: list[str] = []
        self.fixed: list[int] = []  # places of what is the same in each message
        self.values: list[int] = []

    def root(self) -> tuple[Any, ...]:
        tag = self._word()
        if not tag & LIST:
            raise ValueError("no list")
        outline = self._list(tag, DEPTH)
        if self._at != len(self._payload):
            raise ValueError("something follows")
        return outline

    def _word(self) -> int:
        """Take a tag or a count."""
        try:
            found: int = _TAG.unpack_from(self._payload, self._at)[0]
        except error:
            raise ValueError("cut off") from None
        self._at += 4
        self.letters.append("i")
        self.fixed.append(self._place)
        self._place += 1
        return found

    def _list(self, tag: int, depth: int) -> tuple[Any, ...]:
        count, unit = self._word(), tag & UNIT_MASK
        if tag & ~(UNIT_MASK | LIST) or not depth or not 0 <= count <= NUMBERS:
            raise ValueError("no list of numbers")
        if unit:
            return tuple(self._number(unit) for _ in range(count))
        return tuple(self._item(depth - 1) for _ in range(count))

    def _item(self, depth: int) -> Any:
        tag = self._word()
        return self._list(tag, depth) if tag & GROUP_MASK else self._number(tag)

    def _number(self, tag: int) -> str:
        kind = FIXED.get(tag)
        if kind is None or self._place > 3 * NUMBERS:
            raise ValueError("no number")
        letter, size = kind
        self.letters.append(letter)
        self._at += size
        if self._at > len(self._payload):
            raise ValueError("cut off")
        if tag == VOCAB32:
            letter = "v"
        else:
            self.values.append(self._place)
        self._place += 1
        return letter


class Structures:
    """The structure of the last messages of each port."""

    def __init__(self) -> None:
        self._known: Structure | None = None
        self._odd = 0  # messages that were of no structure, one after the other
        self._left = 0  # messages that are not looked at

    def find(
        self, payload: bytes | bytearray | memoryview
    ) -> tuple[Structure, tuple[float, ...]] | None:
        """Return the structure of a message and its numbers; None if it has none."""
        known = self._known
        if known is not None:
            values = known.values(payload)
            if values is not None:
                return known, values
        if self._left:  # texts stay texts mostly: they are looked at less and less often
            self._left -= 1
            return None
        try:
            known = self._known = Structure(payload)
        except ValueError:
            self._odd = min(self._odd + 1, 7)
            self._left = (1 << self._odd) - 2
            return None
        self._odd = 0
        values = known.values(payload)
        return None if values is None else (known, values)
