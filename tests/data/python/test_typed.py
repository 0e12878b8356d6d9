import enum
import sys
import types
from dataclasses import dataclass, field
from typing import Annotated, Any, Literal, NamedTuple, NotRequired, TypedDict

import numpy as np
import pytest
from numpy.typing import NDArray

from yarpy.data import codec
from yarpy.data.bottle import Bottle, Property
from yarpy.data.python import typed
from yarpy.data.sig.image import Image
from yarpy.data.sig.matrix import Matrix
from yarpy.data.sig.vector import Vector
from yarpy.data.stamp import Stamp
from yarpy.errors import DecodeError


class Mode(enum.IntEnum):
    OFF = 0
    ON = 1


class Joint(NamedTuple):
    name: str
    angle: float = 0.0


@dataclass
class Observation:
    rgb: NDArray[np.uint8]
    joints: np.ndarray
    name: str
    arm: list[Joint]
    goal: "tuple[float, float] | None" = None
    mode: Mode = Mode.OFF
    extra: dict[str, float] = field(default_factory=dict)


class Step(TypedDict):
    observation: Observation
    reward: float
    done: NotRequired[bool]


def through(value: Any, type_: Any) -> Any:
    return codec.decode_as(b"".join(codec.encode(value)), type_)


def observation() -> Observation:
    return Observation(
        rgb=np.ones((4, 5, 3), "u1"),
        joints=np.arange(3.0),
        name="left",
        arm=[Joint("elbow", 1.5), Joint("wrist")],
        goal=(1.0, 2.0),
        mode=Mode.ON,
        extra={"force": 3.0},
    )


def check(found: Observation) -> None:
    wanted = observation()
    assert type(found) is Observation
    assert (found.rgb == wanted.rgb).all() and found.rgb.dtype == "u1"
    assert (found.joints == wanted.joints).all() and type(found.joints) is np.ndarray
    assert (found.name, found.arm, found.goal) == (wanted.name, wanted.arm, wanted.goal)
    assert type(found.arm[0]) is Joint and type(found.goal) is tuple
    assert found.mode is Mode.ON and found.extra == {"force": 3.0}


def test_a_dataclass() -> None:
    check(through(observation(), Observation))
    check(through([observation()], list[Observation])[0])
    step = through(Step(observation=observation(), reward=1), Step)
    check(step["observation"])
    assert step["reward"] == 1.0 and type(step["reward"]) is float and "done" not in step


def test_of_what_cpp_sends() -> None:
    """A Property: lists for arrays, integers for numbers."""
    sent = Property.from_text(
        "(joints (0.0 1 2)) (name left) (arm ((elbow 1.5) (wrist))) (goal (1 2)) (mode 1) "
        "(extra ((force 3))) (unknown 5)"
    )
    sent["rgb"] = Image(np.ones((4, 5, 3), "u1"))
    check(through(Bottle([[key, sent[key]] for key in sent]), Observation))


def test_named_tuples() -> None:
    class State(NamedTuple):
        q: np.ndarray
        rgb: np.ndarray
        t: float = 0

    value = State(np.arange(3, dtype="i4"), np.ones((3, 4, 3), "u1"), 2.5)
    found = through(value, State)
    assert type(found) is State and found.t == 2.5
    assert found.q.dtype == "i4" and found.q.tolist() == [0, 1, 2] and found.rgb.shape == (3, 4, 3)
    assert through(["elbow"], Joint) == Joint("elbow")
    assert through({"name": "elbow", "angle": 2}, Joint) == Joint("elbow", 2.0)
    for wrong in ([], ["a", 1, 2], [1, 2], 5):
        with pytest.raises(DecodeError, match="expected a"):
            through(wrong, Joint)


@pytest.mark.parametrize(
    ("value", "type_", "wanted"),
    [
        ([1, 2], list[float], [1.0, 2.0]),
        ([1, "a"], tuple[int, str], (1, "a")),
        ([1.0, 2.0], tuple[float, ...], (1.0, 2.0)),
        ({"a": [1]}, dict[str, list[int]], {"a": [1]}),
        ([None, 1], list[int | None], [None, 1]),
        ("on", Literal["on", "off"], "on"),
        (1, Mode, Mode.ON),
        (5, Annotated[int, "metres"], 5),
        (5, float | str, 5.0),
        (5, int | float, 5),
        ("x", float | str, "x"),
        (1j, complex, 1j),
        (2.5, complex, 2.5 + 0j),
        ({"a": None}, dict[str, Any], {"a": None}),
        ({"a": ()}, Property, Property(a=())),
        ({"a": (1, 2), "b": Stamp(1, 2.0)}, dict, {"a": (1, 2), "b": Stamp(1, 2.0)}),
        ([np.zeros((1, 1, 1)), 1], list, [0, 1]),
    ],
    ids=str,
)
def test_values(value: Any, type_: Any, wanted: Any) -> None:
    found = through(value, type_)
    if isinstance(found, list) and isinstance(found[0], np.ndarray):
        found[0] = int(found[0].sum())
    assert found == wanted and type(found) is type(wanted)


def test_arrays_of_a_list() -> None:
    arrays = through([np.arange(3, dtype="i2"), np.ones(2, "f4")], list[NDArray[Any]])
    assert [array.dtype for array in arrays] == [np.array([0]).dtype, "<f8"]
    large = through([np.arange(3000, dtype="i2"), 1], tuple[np.ndarray, int])[0]
    assert large.dtype == "i2"


def test_arrays_as_types_of_yarp() -> None:
    assert through(np.ones((2, 2), "f4"), Matrix) == Matrix(np.ones((2, 2)))
    assert through(np.ones(3, "u2"), Vector) == [1, 1, 1]
    assert through({"v": np.ones(3), "m": np.eye(2)}, dict[str, Any])["m"].shape == (2, 2)

    @dataclass
    class Both:
        v: Vector
        image: Image

    found = through({"v": np.ones(3), "image": np.ones((2, 2), "u1")}, Both)
    assert type(found.v) is Vector and found.image == Image(np.ones((2, 2), "u1"))


def test_a_tensor(monkeypatch: pytest.MonkeyPatch) -> None:
    """torch shares the memory of an array that may be written to."""
    torch = types.ModuleType("torch")
    taken = []

    class Tensor:
        pass

    Tensor.__module__ = "torch"
    monkeypatch.setattr(torch, "from_numpy", taken.append, raising=False)
    monkeypatch.setitem(sys.modules, "torch", torch)
    message = bytearray(b"".join(codec.encode(np.ones((2, 3, 4), "f4"))))
    codec.decode_as(message, Tensor)
    assert np.shares_memory(taken[0], np.frombuffer(message, "u1"))
    codec.decode_as(bytes(message), Tensor)
    assert taken[1].flags.writeable and (taken[1] == taken[0]).all()


@pytest.mark.parametrize(
    ("value", "type_", "why"),
    [
        ({"name": "x"}, Observation, "an Observation: it has no 'rgb'"),
        ({"observation": 5, "reward": 1}, Step, "an Observation at observation, got 5"),
        ({"reward": 1.0}, Step, "a Step: it has no 'observation'"),
        (["x", 1], list[float], r"a number at \[0\], got x"),
        ([True], list[int], r"an integer at \[0\], got true"),
        ([1, 2, 3], tuple[int, int], "2 values, got"),
        (7, Mode, "a Mode: 7 is not a valid Mode"),
        ("x", Literal["a"], "one of 'a', got x"),
        ({"a": "x"}, dict[str, float], "a number at a, got x"),
        ([1, None], str, "a string, got"),
        ({"a": ()}, Image, "an Image, got"),
        ({"a": ()}, np.ndarray, "an array, got"),
        (np.zeros((2, 2, 2)), Matrix, "a Matrix"),
        ("word", list[int], "a list, got word"),
        (5, dict[str, int], "a dict, got 5"),
    ],
    ids=str,
)
def test_what_does_not_fit(value: Any, type_: Any, why: str) -> None:
    with pytest.raises(DecodeError, match=f"expected {why}"):
        through(value, type_)


def test_types_that_nothing_is_read_as() -> None:
    class Strange:
        pass

    for type_ in (Strange, list[Strange], set[int]):
        with pytest.raises(TypeError, match="cannot be read as"):
            through([1], type_)


def test_hints_that_name_what_is_not_there() -> None:
    @dataclass
    class Broken:
        x: "Missing"  # type: ignore[name-defined]  # noqa: F821

    with pytest.raises(TypeError, match="the hints of Broken cannot be read"):
        through({"x": 1}, Broken)


def test_depth_is_limited() -> None:
    @dataclass
    class Node:
        next: Any

    nested: Any = 1
    for _ in range(45):
        nested = [nested]
    hint: Any = int
    for _ in range(120):
        hint = list[hint]
    with pytest.raises(DecodeError):
        typed.convert(nested, hint)
