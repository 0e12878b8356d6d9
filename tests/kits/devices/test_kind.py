import math

import pytest

from yarpy.data.bottle import Bottle
from yarpy.data.value import Float32, Int64, Vocab
from yarpy.kits.devices.kind import (
    BOXED,
    FAULT,
    FLAG,
    FLOAT,
    JOINT_TYPE,
    NOTHING,
    PAIR,
    TEXT,
    WHOLE,
    WORD,
    ZERO,
    Numbers,
    items,
    number,
    whole,
    word,
)
from yarpy.kits.devices.refusal import Refused

THREE = Numbers(3)

# kind, value, what it is in a request or reply
SPELLED = [
    (FLOAT, 2.5, [2.5]),
    (WHOLE, 7, [7]),
    (FLAG, True, [1]),
    (WORD, "posd", [Vocab("posd")]),
    (TEXT, "left arm", ["left arm"]),
    (PAIR, (-3.0, 4.0), [-3.0, 4.0]),
    (THREE, (1.0, 2.0, 3.0), [Bottle([1.0, 2.0, 3.0])]),
    (BOXED, 0.5, [Bottle([0.5])]),
    (FAULT, (3, "too hot"), [3, "too hot"]),
    (JOINT_TYPE, "revolute", [1987212385]),
    (JOINT_TYPE, "prismatic", [1919972449]),
    (JOINT_TYPE, "unknown", [1852534389]),
]
COMMANDED = (FLOAT, WHOLE, FLAG, WORD, PAIR, THREE, BOXED)


@pytest.mark.parametrize(("kind", "value", "elements"), SPELLED)
def test_values_are_spelled_and_read(kind, value, elements):
    assert kind.write(kind.check(value)) == elements
    assert [type(a) for a in kind.write(kind.check(value))] == [type(b) for b in elements]
    assert kind.parse(elements) == value
    if kind in COMMANDED:
        assert kind.read(elements) == value


def test_several_joints():
    assert FLOAT.write_all([1.0, 2.0]) == [[1.0, 2.0]]
    assert PAIR.write_all([(1.0, 2.0), (3.0, 4.0)]) == [[1.0, 3.0], [2.0, 4.0]]
    assert THREE.write_all([(1.0, 2.0, 3.0)]) == [[[1.0, 2.0, 3.0]]]
    assert FLAG.write_all([True, True]) == [1]
    assert FLAG.write_all([True, False]) == [0]
    assert FLOAT.read_all([1, 2.5], 2) == [1.0, 2.5]
    assert WORD.read_all(["pos", Vocab("vel")], 2) == ["pos", "vel"]


def test_nothing_takes_nothing():
    assert (NOTHING.count, NOTHING.read(())) == (0, None)
    assert (ZERO.count, ZERO.read(())) == (0, 0.0)


BAD_NUMBERS = [
    "1", Vocab("one"), True, False, None, math.nan, math.inf, -math.inf, 10**400, b"1", [1.0], {},
]  # fmt: skip


@pytest.mark.parametrize("element", BAD_NUMBERS, ids=repr)
def test_no_numbers(element):
    for kind in (FLOAT, WHOLE, FLAG):
        with pytest.raises(Refused):
            kind.read([element])
    with pytest.raises(Refused):
        PAIR.read([0.0, element])
    with pytest.raises(Refused):
        FLOAT.read_all([0.0, element], 2)
    with pytest.raises(Refused):
        THREE.read([[1.0, 2.0, element]])


def test_numbers_of_any_width():
    assert number(Int64(3)) == 3.0 and number(Float32(0.5)) == 0.5
    assert whole(2.0) == 2 and type(whole(2.0)) is int
    with pytest.raises(Refused, match="whole"):
        whole(2.5)


def test_words_are_four_letters_of_strings_or_vocabs():
    assert word("bogus") == "bogu" == word(Vocab("bogus"))
    assert type(word(Vocab("pos"))) is str
    assert [word(value) for value in (1, True, None, [], b"pos")] == [""] * 5
    with pytest.raises(Refused):
        WORD.read([7])


def test_lists_have_their_length():
    assert items((1, 2), 2) == (1, 2)
    for element, count in (([1], 2), ("ab", 2), (None, 0), ([], 1)):
        with pytest.raises(Refused):
            items(element, count)


@pytest.mark.parametrize(
    ("kind", "value"),
    [
        (FLOAT, "x"), (FLOAT, None), (PAIR, (1.0,)), (PAIR, 3.0), (THREE, (1.0, 2.0)),
        (WORD, 3), (FAULT, "x"), (JOINT_TYPE, "rotary"), (WHOLE, "x"),
    ],
)  # fmt: skip
def test_what_a_device_must_not_give(kind, value):
    with pytest.raises((TypeError, ValueError)):
        kind.check(value)
