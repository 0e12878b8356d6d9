from datetime import date
from decimal import Decimal
from enum import Enum
from pathlib import Path
from types import MappingProxyType

import numpy as np
import pytest

from yarpy.data import codec
from yarpy.data.bottle import Bottle, Property
from yarpy.data.embedded import message_of, plain
from yarpy.data.stamp import Stamp
from yarpy.data.value import Float32, Int8


class Wheel:
    """A type of somebody's own, which is a dict on the wire."""

    def to_wire(self):
        return (Bottle([{"size": 3, "null": [1, 2]}, 4]).to_bytes(),)


def test_a_numpy_number_is_a_python_number():
    assert type(plain(np.int8(-3))) is Int8
    assert type(plain(np.float32(0.5))) is Float32
    assert plain(np.array(7)) == 7 and type(plain(np.array(7))) is int


@pytest.mark.parametrize("value", [7, "word", [1], np.zeros(2), Stamp(1, 2.0), None])
def test_anything_else_stays_as_it_is(value):
    assert plain(value) is value


def test_message_of():
    assert message_of(np.array([1.5])) == Bottle([1.5]).to_bytes()
    assert message_of(Stamp(1, 2.0)) == b"".join(Stamp(1, 2.0).to_wire())


@pytest.mark.parametrize("value", [None, object()])
def test_what_no_message_can_hold(value):
    for send in (message_of, lambda value: Bottle([value]).to_bytes()):
        with pytest.raises(TypeError, match="cannot be an element of a Bottle; int, float"):
            send(value)
    with pytest.raises(TypeError, match="cannot be an element"):
        Bottle([value]).to_text()


@pytest.mark.parametrize(
    "value", [np.int8(5), np.array([1.5, 2.0]), np.array(3), Stamp(1, 2.0), Wheel(), [Wheel()]]
)
def test_text_is_that_of_what_arrives(value):
    """In the text spelling, and within a Property."""
    assert Bottle([value]).to_text() == Bottle.from_bytes(Bottle([value]).to_bytes()).to_text()
    said = Property(k=value).to_text()
    assert Bottle.from_text(said).to_bytes() == Property(k=value).to_bytes()


def test_a_dict_within_prints_sorted_and_without_what_came_before():
    class Doubled:
        def to_wire(self):
            lists = Bottle([["b", 1], ["a"], [], ["b", 2, 3], 7, [5, "x"]]).to_bytes()
            dict_head = b"\0\3\0\0" + lists[4:]  # the same list, marked as a dict
            return (b"\0\1\0\0\1\0\0\0" + dict_head[:4] + lists,)

    message = b"".join(Doubled().to_wire())
    (inner,) = Bottle.from_bytes(message)
    assert type(inner) is Property
    assert Bottle([Doubled()]).to_text() == "((() (5 x) (a) (b 2 3)))"
    assert Bottle([Bottle.from_bytes(message)]).to_text() == Bottle([Doubled()]).to_text()


class Side(Enum):
    LEFT = 1


@pytest.mark.parametrize(
    ("value", "can"),
    [
        ({1}, "a set cannot be sent; a list can: list(it)"),
        (range(3), "a range cannot be sent; a list can: list(it)"),
        ((n for n in ()), "a generator cannot be sent; a list can: list(it)"),
        (MappingProxyType({}), "a mappingproxy cannot be sent; a dict can: dict(it)"),
        (Path("/x"), "cannot be sent; its text can: str(path)"),
        (date(2026, 1, 2), "a date cannot be sent; its text can: .isoformat()"),
        (Decimal("1.5"), "a Decimal cannot be sent; a float can: float(number)"),
        (Side.LEFT, "a Side cannot be sent; its .value can"),
        (KeyError("x"), "a KeyError cannot be sent; its text can: str(error)"),
        (Stamp, "Stamp is the class itself"),
        (lambda: 1, "a function cannot be sent; what it returns can"),
        (object(), "lists, dicts, dataclasses"),
    ],
)
def test_an_error_says_what_can_be_sent_instead(value, can):
    with pytest.raises(TypeError) as alone:
        codec.encode(value)
    assert can in str(alone.value)
    with pytest.raises(TypeError, match="cannot be an element of a Bottle; ") as within:
        codec.encode([value])
    if type(value) is not object:
        assert str(within.value).endswith(str(alone.value).partition("; ")[2])
