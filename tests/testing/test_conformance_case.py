"""What must arrive of a message, by the spelling of its carrier, and that a difference is seen."""

from __future__ import annotations

from typing import Any

import pytest
from support.mutant import Plain

from yarpy.carriers.own.local import Local
from yarpy.carriers.own.text import Text
from yarpy.data import codec
from yarpy.data.value import Vocab
from yarpy.testing.conformance_case import SIZES, ConformanceCase
from yarpy.wire.message import DATA, Message


class Binary(ConformanceCase):
    carrier = Plain


class Readable(ConformanceCase):
    carrier = Text


class Whole(ConformanceCase):
    carrier = Local


def test_what_arrives_of_a_value() -> None:
    value = [1, 2.5, "a b", [Vocab("set")], b"\xff"]
    assert Binary().expected(value) == value
    assert Readable().expected(value)[:3] == [1, 2.5, "a b"]
    assert Whole().expected(value) is value


@pytest.mark.parametrize("size", SIZES)
def test_messages_of_a_size(size: int) -> None:
    assert Binary().of_size(size) == [bytes(size)]
    assert Readable().of_size(size) == ["x" * size]


@pytest.mark.parametrize(("value", "other"), [([1], [2]), ([1], ["1"]), ([], [[]]), (["a"], ["A"])])
def test_differences_are_seen(value: Any, other: Any) -> None:
    case = Binary()
    message = Message(DATA, b"".join(codec.encode(value)), "", "binary")
    case._check(message, value)
    with pytest.raises(AssertionError, match="arrived as"):
        case._check(message, other)


def test_it_has_no_tests_itself() -> None:
    assert not [name for name in dir(ConformanceCase) if name.startswith("test")]
