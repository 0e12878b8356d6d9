"""What comes back from YARP equal to what was written."""

from __future__ import annotations

import pytest

from yarpy.data import codec
from yarpy.data.bottle import Bottle
from yarpy.kits.wrap.value.native import NOT_NATIVE, native_dict, native_list, survives


@pytest.mark.parametrize(
    "value",
    [1, -(1 << 63), 0.5, True, "", b"a", [1, ["a"]], Bottle([2]), {"a": 1, "b": [2]}, [{"a": 1}]],
)
def test_what_survives_comes_back(value: object) -> None:
    assert survives(value)
    assert codec.decode(b"".join(codec.encode([value])))[0] == value


@pytest.mark.parametrize(
    "value", [1 << 63, None, 1j, (1, 2), {1: 2}, {"a": {"b": 1}}, {"a": [{}]}, [1 << 63], [[None]]]
)
def test_what_does_not_survive(value: object) -> None:
    assert not survives(value)


def test_lists() -> None:
    assert native_list([]) == [] and native_list(["a", "b"]) == ["a", "b"]
    assert native_list(["a"]) is NOT_NATIVE, "as Wrapyfi sends everything"
    assert native_list([1, None]) is NOT_NATIVE


def test_dicts() -> None:
    plain = native_dict({"a": 1, "b": "c"})
    assert type(plain) is Bottle and plain == Bottle([["a", 1], ["b", "c"]])
    assert native_dict({"a": [True]}) == [["a", [True]]], "whose types a description tells"
    assert native_dict({1: "a"}) is native_dict({"a": None}) is NOT_NATIVE
