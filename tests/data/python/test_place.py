"""What cannot be sent is named by the place where it stands."""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import pytest

from yarpy.data import codec
from yarpy.data.bottle import Bottle
from yarpy.data.python.place import located


@dataclass
class Arm:
    joints: Any


class Pair(NamedTuple):
    left: Any
    right: Any


FAULTS: list[tuple[Any, str]] = [
    ({"a": [0, 1, 2, {3}]}, '["a"][3]'),
    ({"q": np.arange(3.0), "a": {"b": ({1: object()},)}}, '["a"]["b"][0][1]'),
    ([1, None, [2, {3}]], "[2][1]"),
    ([1, {2}], "[1]"),
    (({"a": {1}},), '[0]["a"]'),
    (Arm({"left": [{1}]}), '.joints["left"][0]'),
    ([Arm([Arm({1})])], "[0].joints[0].joints"),
    ({"arms": Pair(1, {2})}, '["arms"].right'),
    ({"ä b": np.array(["x"])}, '["ä b"]'),
    ({"k" * 50: {1}}, f'["{"k" * 39}...]'),
    ({1: {2}}, "[1]"),
    (Bottle([1, [2, {3}]]), "[1][1]"),
    ({"a": {(1, 2): 3}}, '["a"]'),
    ([{1}, {2}], "[0]"),
]


@pytest.mark.parametrize(("value", "path"), FAULTS, ids=[path for _, path in FAULTS])
def test_the_place_is_named(value: Any, path: str) -> None:
    with pytest.raises(TypeError) as told:
        codec.encode(value)
    assert str(told.value).startswith(f"value{path}: ")
    reason = str(told.value).partition(": ")[2]
    assert "cannot" in reason or "is neither" in reason or "numbers" in reason


@pytest.mark.parametrize("value", [{1}, object(), {(1, 2): 3}, np.array(["x"])])
def test_a_value_that_cannot_be_sent_itself_has_no_place(value: Any) -> None:
    with pytest.raises(TypeError) as told:
        codec.encode(value)
    assert not str(told.value).startswith("value")


def test_a_value_in_itself_ends() -> None:
    value: dict[str, Any] = {"s": {1}}
    value["again"] = value
    with pytest.raises(TypeError, match=r'^value\["s"\]: '):
        codec.encode(value)
    error = TypeError("of something else")
    assert located({"again": [1, None, "x"]}, error) is error
