"""Values of parameters."""

from typing import Any

import numpy as np
import pytest

from yarpy.peers import ros2
from yarpy.peers.ros2.parameter.value import from_ros, kind_of, named, plain, to_ros

VALUE: Any = ros2.load("rcl_interfaces/msg/ParameterValue")
ROWS = [
    (None, 0),
    (True, 1),
    (-5, 2),
    (2.5, 3),
    ("text", 4),
    (b"\0\xff", 5),
    ([True, False], 6),
    ([1, 2], 7),
    ([1.5, 2.0], 8),
    (["a", ""], 9),
    ([], 9),
]


@pytest.mark.parametrize(("value", "kind"), ROWS)
def test_there_and_back(value: Any, kind: int) -> None:
    assert kind_of(value) == kind
    made = VALUE.from_bottle(to_ros(value))
    assert made.type == kind
    back = from_ros(VALUE.from_ros(b"".join(made.to_ros())))
    assert back == value and type(back) is type(value)
    if isinstance(value, list) and value:
        assert type(back[0]) is type(value[0])  # type: ignore[index]


def test_what_becomes_of_numbers_of_numpy() -> None:
    assert plain(np.float32(0.5)) == 0.5
    assert plain(np.array([1, 2])) == [1, 2]
    assert plain([1, 2.5]) == [1.0, 2.5]
    assert plain((True,)) == [True]
    assert named({"a": 1}) == [{"name": "a", "value": {"type": 2, "integer_value": 1}}]


@pytest.mark.parametrize("value", [{"a": 1}, [1, "a"], [[1]], [True, 1], object(), [None]])
def test_what_can_be_no_parameter(value: Any) -> None:
    with pytest.raises(TypeError, match="can be no parameter"):
        to_ros(value)


def test_a_kind_that_there_is_not() -> None:
    with pytest.raises(ValueError, match="kind 10"):
        from_ros(VALUE.from_bottle({"type": 10}))
