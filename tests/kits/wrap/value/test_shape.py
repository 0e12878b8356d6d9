"""Shapes: what hints allow, and which values YARP brings back equal."""

from __future__ import annotations

import enum
from dataclasses import dataclass, field
from typing import Annotated, Any, Literal, NamedTuple, NotRequired, TypedDict

import numpy as np
import pytest

import yarpy
from yarpy.kits.wrap.value.array import Image
from yarpy.kits.wrap.value.hint import shape_of
from yarpy.kits.wrap.value.native import NOT_NATIVE
from yarpy.wire.message import DATA, Message, Packet


@dataclass
class Pose:
    x: float
    y: float = 0.0
    tags: list[str] = field(default_factory=list)


class Words(TypedDict):
    a: int
    b: NotRequired[str]


class Pair(NamedTuple):
    a: int
    b: str


class Colour(enum.Enum):
    RED = 1


PICTURE = np.arange(18, dtype="u1").reshape(2, 3, 3)
NATIVE = [
    *[(int, 3), (int, 2**40), (float, 2.0), (float, 2), (str, "5"), (bool, True), (bytes, b"x")],
    *[(list, [1, "a", [2.5]]), (list[int], [1, 2]), (list[float], [1.0]), (set[int], {1})],
    *[(tuple[int, str], (1, "a")), (tuple[int, ...], (1, 2)), (Pair, Pair(1, "a"))],
    *[(dict, {"a": 1, "b": [1, 2]}), (dict, {"a": {"b": 1}}), (dict[str, float], {"a": 1.5})],
    *[(list[dict[str, int]], [{"a": 1}]), (Pose, Pose(1, 2, ["a"])), (list[Pose], [Pose(1)])],
    *[(Words, {"a": 1}), (Colour, Colour.RED), (Literal["a", "b"], "a"), (int | str, "a")],
    *[(yarpy.Vector, yarpy.Vector([1.0])), (yarpy.Vocab, yarpy.Vocab("set")), (Any, "5")],
    *[(yarpy.Bottle, yarpy.Bottle([1])), (yarpy.Int8, yarpy.Int8(3)), (Any, 5), (int | None, 4)],
    *[(None, None), (yarpy.Image, yarpy.Image(PICTURE))],
]  # fmt: skip
FRAMED = [
    *[(int, 2**70), (dict, {"a": {"b": {"c": 1}}}), (dict, {1: 2}), (dict, {"a": None})],
    *[(list, ["x"]), (Any, {"a": 1}), (Any, (1, 2)), (int | None, None), (list, [(1,)])],
    *[(complex, 1j), (list, [{"a": {"b": 1}}]), (dict[str, int], {"a": 2**70})],
]  # fmt: skip


def through(hint: Any, value: object) -> object:
    """What YARP brings back."""
    shape = shape_of(hint)
    native = shape.native(shape.dump(value))
    assert native is not NOT_NATIVE
    message = Message(DATA, b"".join(Packet(native).blocks))
    return shape.load(shape.read(message))


@pytest.mark.parametrize(("hint", "value"), NATIVE, ids=str)
def test_native_values_come_back_equal(hint: Any, value: object) -> None:
    found = through(hint, value)
    kind = float if hint is float else type(value)
    assert found == value and (type(found) is kind or kind is yarpy.Bottle)


@pytest.mark.parametrize(("hint", "value"), FRAMED, ids=str)
def test_others_are_for_frames(hint: Any, value: object) -> None:
    shape = shape_of(hint)
    plain = shape.dump(value)
    assert shape.native(plain) is NOT_NATIVE
    assert shape.load(plain) == value


@pytest.mark.parametrize(
    ("hint", "value"),
    [
        (int, "x"),
        (int, True),
        (str, 1),
        (float, "1"),
        (list[int], 3),
        (list[int], ["a"]),
        (dict, [1]),
        (tuple[int, int], (1,)),
        (Pose, {"x": 1}),
        (Literal["a"], "b"),
        (Words, 3),
        (None, 1),
        (np.ndarray, "x"),
        (int | str, 1.5),
        (Colour, 7),
        (set[int], "ab"),
        (dict[str, int], {1: 1}),
    ],
)
def test_what_a_hint_does_not_allow(hint: Any, value: object) -> None:
    with pytest.raises((TypeError, ValueError)):
        shape_of(hint).dump(value)


@pytest.mark.parametrize(
    ("hint", "plain"),
    [
        (int, "x"),
        (list[int], {"a": 1}),
        (dict, [1]),
        (tuple[int, int], [1]),
        (Pose, {"y": 1}),
        (Pose, {"x": "far"}),
        (Words, {"b": "x"}),
        (Colour, "BLUE"),
        (Literal[1], 2),
        (None, 3),
        (np.ndarray, "x"),
        (np.ndarray, [[1], [2, 3]]),
        (complex, "x"),
        (set[int], [[1]]),
        (yarpy.Vector, ["a"]),
        (Annotated[np.ndarray, Image()], 3),
        (list[list[int]], [1]),
    ],
)
def test_what_comes_and_is_something_else(hint: Any, plain: object) -> None:
    with pytest.raises(yarpy.DecodeError):
        shape_of(hint).load(plain)


def test_fields_that_a_newer_peer_sends_are_left_out() -> None:
    assert shape_of(Pose).load({"x": 1.0, "new": 3}) == Pose(1.0)
