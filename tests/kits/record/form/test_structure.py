"""Messages of numbers: where these are, found once and compared then."""

import pytest
from support.recordings import payload_of

from yarpy.data.bottle import Bottle
from yarpy.data.value import Float32, Int8, Vocab
from yarpy.kits.record.form.structure import NUMBERS, Structure, Structures

ROWS = [
    ([1, 2.5], ("i", "d"), (1, 2.5)),
    ([Int8(3), Float32(0.5), 1 << 40], ("b", "f", "q"), (3, 0.5, 1 << 40)),
    ([[1.0, 2.0], Vocab("ok"), 7], (("d", "d"), "v", "i"), (1.0, 2.0, 7)),
    ([[1, [2.0, 3]]], (("i", ("d", "i")),), (1, 2.0, 3)),
]


@pytest.mark.parametrize(("value", "outline", "numbers"), ROWS)
def test_numbers(value: list, outline: tuple, numbers: tuple) -> None:
    payload = payload_of(Bottle(value))
    found = Structure(payload)
    assert found.outline == outline
    assert found.values(payload) == numbers


def test_what_is_built_alike() -> None:
    found = Structure(payload_of([1, 2.5]))
    assert found.values(payload_of([7, -1.0])) == (7, -1.0)
    assert found.values(payload_of([7, 1, 1])) is None
    assert found.values(payload_of([1.5, 2])) is None  # as long, but in another order


@pytest.mark.parametrize(
    "value",
    ["word", [1, "word"], [b"blob"], [], [Vocab("ok")], [[[[[[1]]]]]], [1.5] * (NUMBERS + 1)],
)
def test_what_is_none(value: object) -> None:
    with pytest.raises(ValueError):
        Structure(payload_of(value))


def test_what_is_cut_off() -> None:
    payload = payload_of([1, [2.5, 3.5], 4])
    for end in range(len(payload)):
        with pytest.raises(ValueError):
            Structure(payload[:end])
    with pytest.raises(ValueError):
        Structure(payload + b"\0")


def test_of_a_port() -> None:
    structures = Structures()
    first, second = payload_of([1, 2]), payload_of([1, 2.0])
    known = structures.find(first)
    assert known is not None and known[1] == (1, 2)
    again = structures.find(payload_of([5, 6]))
    assert again is not None and again[0] is known[0] and again[1] == (5, 6)
    other = structures.find(second)
    assert other is not None and other[1] == (1, 2.0)


def test_texts_are_looked_at_less_and_less_often() -> None:
    structures = Structures()
    text, numbers = payload_of(["a"]), payload_of([1])
    assert all(structures.find(text) is None for _ in range(1000))
    waited = next(n for n in range(1000) if structures.find(numbers))
    assert waited <= 128
    assert structures.find(numbers) is not None
