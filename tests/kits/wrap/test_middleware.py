"""What passes between decorators and middlewares."""

from __future__ import annotations

import pytest

import yarpy
from yarpy.kits.wrap.middleware import Binding, Failure, Item, Received, question_of


def test_options_that_a_middleware_does_not_have_are_refused() -> None:
    binding = Binding("/a", "pigeons", carrier="udp")
    binding.refuse(place="it has no place")
    with pytest.raises(ValueError, match="carrier='udp' on pigeons: pigeons walk"):
        binding.refuse(carrier="pigeons walk")


def test_item_is_spelled_once_for_several_middlewares() -> None:
    made = []
    item = Item(3)
    for _ in range(2):
        item.form("x", made.append)
    assert len(made) == 2  # alone, it is not worth remembering
    item.forms = {}
    for _ in range(2):
        item.form("x", made.append)
    assert len(made) == 3


def test_stamps_of_what_came() -> None:
    assert Received(1).stamp is None
    assert Received(1, 3, 2.5).stamp == yarpy.Stamp(3, 2.5)


def test_failures_are_errors() -> None:
    error = Failure.of(KeyError("gone")).error()
    assert isinstance(error, yarpy.RemoteError)
    assert (error.type, error.text, str(error)) == ("KeyError", "'gone'", "KeyError: 'gone'")
    assert str(Failure("", "no").error()) == "no"


def test_questions() -> None:
    assert question_of(((1, 2), {"a": 3})) == ([1, 2], {"a": 3})
    for wrong in (None, [], [[1]], [1, {}], [[1], [2]], [[], {1: 2}]):
        with pytest.raises(yarpy.DecodeError, match="a question is"):
            question_of(wrong)
