"""The encoding of values in requests and replies of devices: numbers, pairs, words, lists.

    read(elements)      the value of a request's elements; Refused if there is none
    read_all(element)   the values of a list, one for each joint
    write(value)        the elements of a reply
    write_all(values)   ... for several joints
    check(value)        a result of a user's class, converted; TypeError, ValueError
    parse(elements)     the value in another device's reply: the inverse of `write`

Rules: commanded numbers are finite, and true and false are not numbers. Only the first four letters
of a word count, whether it is a string or a vocab.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache
from math import isfinite
from reprlib import repr as shown
from typing import Any, Final

from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.kits.devices.refusal import Refused


def number(element: object) -> float:
    """A finite number."""
    if isinstance(element, (int, float)) and not isinstance(element, bool):
        try:
            value = float(element)
        except OverflowError:
            raise Refused(f"{shown(element)} is too large") from None
        if isfinite(value):
            return value
    raise Refused(f"{shown(element)} is not a finite number")


def whole(element: object) -> int:
    """A whole number; 2.0 is one too, for senders that only use floats."""
    value = number(element)
    if value != int(value):
        raise Refused(f"{shown(element)} is not a whole number")
    return int(value)


def word(element: object) -> str:
    """A word of up to four letters, of either type; "" for anything else."""
    if isinstance(element, Vocab):
        return str.__str__(element)
    return str.__str__(Vocab(element)) if isinstance(element, str) else ""


#: Modes are told again and again.
_word_of: Final = lru_cache(200)(word)


def items(element: object, count: int | None = None) -> Sequence[Any]:
    """The elements of a list of `count`."""
    if not isinstance(element, (list, tuple)):
        raise Refused(f"{shown(element)} is not a list")
    if count is not None and len(element) != count:
        raise Refused(f"a list of {len(element)}, not of {count}")
    return element


class Kind:
    """A number, as float64, like most values."""

    #: number of request elements for one value
    count = 1

    def read(self, elements: Sequence[Any]) -> Any:
        return number(elements[0])

    def read_all(self, element: object, count: int) -> list[Any]:
        return [self.read([item]) for item in items(element, count)]

    def write(self, value: Any) -> list[Any]:
        return [value]

    def write_all(self, values: Sequence[Any]) -> list[Any]:
        return [Bottle(element for value in values for element in self.write(value))]

    def check(self, value: Any) -> Any:
        return float(value)

    def check_all(self, values: Iterable[Any]) -> list[Any]:
        return [self.check(value) for value in values]

    def parse(self, elements: Sequence[Any]) -> Any:
        return self.check(elements[0])


class Float(Kind):
    """A number, many of them at once: boards are read a thousand times a second."""

    def check_all(self, values: Iterable[Any]) -> list[Any]:
        return [*map(float, values)]


class Whole(Kind):
    """A whole number, as int32."""

    def read(self, elements: Sequence[Any]) -> Any:
        return whole(elements[0])

    def check(self, value: Any) -> Any:
        return int(value)


class Flag(Whole):
    """True or false, as 1 or 0; for several joints: whether it is true for all."""

    def read(self, elements: Sequence[Any]) -> Any:
        return bool(whole(elements[0]))

    def write(self, value: Any) -> list[Any]:
        return [int(value)]

    def write_all(self, values: Sequence[Any]) -> list[Any]:
        return [int(all(values))]

    def check(self, value: Any) -> Any:
        return bool(value)


class Word(Kind):
    """A vocab."""

    def read(self, elements: Sequence[Any]) -> Any:
        found = word(elements[0])
        if not found:
            raise Refused(f"{shown(elements[0])} is not a word")
        return found

    def write(self, value: Any) -> list[Any]:
        return [Vocab(value)]

    def check(self, value: Any) -> Any:
        if not isinstance(value, str):
            raise TypeError(f"{value!r} is not a word")
        return word(value)

    def check_all(self, values: Iterable[Any]) -> list[Any]:
        return [_word_of(one) if type(one) is str else self.check(one) for one in values]


class Text(Kind):
    """A string."""

    def check(self, value: Any) -> Any:
        return str(value)


class Pair(Kind):
    """Lowest and highest in order; for several joints: two lists."""

    count = 2

    def read(self, elements: Sequence[Any]) -> Any:
        low, high = (number(element) for element in elements)
        return low, high

    def write(self, value: Any) -> list[Any]:
        return [*value]

    def write_all(self, values: Sequence[Any]) -> list[Any]:
        return [Bottle(low for low, _ in values), Bottle(high for _, high in values)]

    def check(self, value: Any) -> Any:
        low, high = value
        return float(low), float(high)

    def parse(self, elements: Sequence[Any]) -> Any:
        return self.check(elements[:2])


class Numbers(Kind):
    """A list of a fixed number of numbers."""

    def __init__(self, size: int) -> None:
        self.size = size

    def read(self, elements: Sequence[Any]) -> Any:
        return tuple(number(item) for item in items(elements[0], self.size))

    def write(self, value: Any) -> list[Any]:
        return [Bottle(value)]

    def check(self, value: Any) -> Any:
        found = tuple(float(item) for item in value)
        if len(found) != self.size:
            raise ValueError(f"{len(found)} numbers, not {self.size}")
        return found


class Boxed(Kind):
    """A number in a list of its own."""

    def read(self, elements: Sequence[Any]) -> Any:
        return number(items(elements[0], 1)[0])

    def write(self, value: Any) -> list[Any]:
        return [Bottle([value])]

    def parse(self, elements: Sequence[Any]) -> Any:
        return self.check(elements[0][0])


class Fault(Kind):
    """A code and what it means."""

    def write(self, value: Any) -> list[Any]:
        return [*value]

    def check(self, value: Any) -> Any:
        code, text = value
        return int(code), str(text)

    def parse(self, elements: Sequence[Any]) -> Any:
        return self.check(elements[:2])


class JointType(Kind):
    """The type of a joint: a word in programs, a number on the wire."""

    words = {"revolute": "atrv", "prismatic": "atpr", "unknown": "unkn"}

    def write(self, value: Any) -> list[Any]:
        return [Vocab(self.words[value]).code]

    def check(self, value: Any) -> Any:
        if value not in self.words:
            raise ValueError(f"{value!r} is not one of {', '.join(self.words)}")
        return value

    def parse(self, elements: Sequence[Any]) -> Any:
        code = Vocab.from_code(elements[0])
        return next((name for name, text in self.words.items() if text == code), "unknown")


class Fixed(Kind):
    """Nothing in the request: the word implies the value. None: the method takes no value."""

    count = 0

    def __init__(self, value: object = None) -> None:
        self.value = value

    def read(self, elements: Sequence[Any]) -> Any:
        return self.value


FLOAT: Final = Float()
WHOLE: Final = Whole()
FLAG: Final = Flag()
WORD: Final = Word()
TEXT: Final = Text()
PAIR: Final = Pair()
BOXED: Final = Boxed()
FAULT: Final = Fault()
JOINT_TYPE: Final = JointType()
NOTHING: Final = Fixed()
ZERO: Final = Fixed(0.0)
