import copy
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from support.steps import measured

from yarpy.data import codec
from yarpy.data.bottle import Bottle, Property
from yarpy.data.python import description
from yarpy.data.sig.image import Image
from yarpy.data.sig.matrix import Matrix
from yarpy.data.sig.pointcloud import PointCloud
from yarpy.data.sig.sound import Sound
from yarpy.data.sig.vector import Vector
from yarpy.data.stamp import Stamp
from yarpy.data.value import Vocab
from yarpy.data.walker import Walker


def sent(obj: Any) -> bytes:
    return b"".join(codec.encode(obj))


def same(one: Any, other: Any) -> bool:
    """Return whether two values are equal, also in what types and arrays there are in them."""
    if isinstance(one, np.ndarray):
        return (
            type(other) is np.ndarray
            and one.dtype.newbyteorder("<") == other.dtype
            and one.shape == other.shape
            and np.array_equal(one, other, equal_nan=one.dtype.kind in "fc")
        )
    if isinstance(one, dict):
        return (
            isinstance(other, dict)
            and list(one) == list(other)
            and all(same(one[key], other[key]) for key in one)
        )
    if isinstance(one, (list, tuple)):
        kind = tuple if isinstance(one, tuple) else list
        return isinstance(other, kind) and len(one) == len(other) and all(map(same, one, other))
    return bool(one == other or one != one)


class Pair(NamedTuple):
    a: Any
    b: Any


@dataclass
class Pose:
    x: float
    frame: str | None = None
    inner: Any = field(default_factory=list)


GOLDEN: list[tuple[Any, str, str]] = [
    (
        {"b": np.array([1.0, 2.0]), "a": 1},
        "00010000 03000000"
        "00010000 02000000 04000000 01000000 62 0a010000 02000000 000000000000f03f 0000000000000040"
        "00010000 02000000 04000000 01000000 61 01000000 01000000"
        "00010000 03000000 04000000 0a000000 79617270792e74797065"
        "00010000 02000000 04000000 04000000 64696374"
        "00010000 02000000 04000000 01000000 62"
        "00010000 03000000 04000000 05000000 6172726179 04000000 03000000 3c6638 01000000 02000000"
        "01000000 6f000000",
        '(b (1.0 2.0)) (a 1) (yarpy.type (dict (b (array "<f8" 2))) 111)',
    ),
    (
        [1, None],
        "00010000 03000000 01000000 01000000 00010000 00000000"
        "00010000 03000000 04000000 0a000000 79617270792e74797065"
        "00010000 02000000 04000000 04000000 6c697374"
        "00010000 02000000 01000000 01000000 04010000 01000000 04000000 6e6f6e65"
        "01000000 56000000",
        "1 () (yarpy.type (list (1 (none))) 86)",
    ),
    (1 + 2j, "", "(1.0 2.0) (yarpy.type (complex) 53)"),
    (Pose(1.5), "", "(x 1.5) (frame) (inner ()) (yarpy.type (dict) 50)"),
    (
        {"rgb": np.zeros((1, 2, 3), "u1"), "mask": np.ones((1, 2), bool), "n": {"t": (1, 2)}},
        "",
        "(rgb ([mat] [rgb] (3 6 1 2 1) {0 0 0 0 0 0})) (mask {1 1}) (n ((t (1 2)))) "
        '(yarpy.type (dict (rgb (array "|u1" 1 2 3)) (mask (array "|b1" 1 2)) '
        "(n (dict (t (tuple))))) 268)",
    ),
]


@pytest.mark.parametrize(("value", "wire", "text"), GOLDEN, ids=lambda it: str(it)[:20])
def test_golden(value: Any, wire: str, text: str) -> None:
    message = sent(value)
    if wire:
        assert message.hex() == wire.replace(" ", "")
    assert codec.encode_text(value).decode() == text
    assert Bottle.from_bytes(message).to_text() == text
    walker = Walker()
    assert walker.advance(message) == len(message) and walker.done
    wanted = {"x": 1.5, "frame": None, "inner": []} if isinstance(value, Pose) else value
    assert same(wanted, codec.decode(message))
    assert same(wanted, codec.decode_text(text)), "what came as text is restored too"
    assert codec.decode_leading(message) is None


PLAIN = [
    *([], [1, 2], ["a", 1.5], {"a": 1}, {"b": 2, "a": [1, "x"]}, {"a": None}, {}, [{"a": 1}]),
    *([[1, 2], [3, 4]], ["set", np.arange(3.0)], [np.arange(3, dtype="i4"), 5], (1, 2), b"x"),
    *(Bottle([1, Image(np.zeros((1, 1), "u1"))]), Bottle([{"a": {"b": 1}}]), Property(a={"b": 1})),
    *([Vector([1.0]), Stamp(1, 2.0)], {"a": Vector([1.0])}, [np.float32(0.5), np.int8(1)]),
]


@pytest.mark.parametrize("value", PLAIN, ids=str)
def test_what_needs_no_description_has_none(value: Any) -> None:
    assert not description.place(sent(value))


VALUES: list[Any] = [
    {"a": {"b": {"c": [1, {"d": "e"}]}}},
    {"a": (1, "x"), "b": [(1,), [2]]},
    {"rgb": np.arange(24, dtype="u1").reshape(2, 4, 3), "depth": np.ones((3, 5), "f4")},
    {"q": np.arange(32.0), "empty": np.zeros((0, 3), "f4"), "name": "arm", "grip": True},
    {"q": np.arange(5, dtype="u8"), "z": np.array([1j, 2]), "m": np.eye(3), "none": None},
    [None, [None, [None]], (), {}, {"a": None}],
    (np.zeros((2, 3, 4)), [np.ones(3)], {"k": (np.zeros(2, "i4"),)}),
    {1: "one", 2.5: "float", b"b": "bytes", False: "no"},
    {"inf": "inf", "nan": "nan", "null": "null", "e": "", "l": ["inf"], "u": "\udcff", "é": "é"},
    [1j, {"c": -2.5 + 0j}],
    {"b": b"\0\1" * 4000, "n": [b"", b"x"], "t": ((b"a", b"b"),)},
    [{}, [], (), [[]], [()], {"": {}}],
    [1 << 40, -(1 << 63), {"x": (1 << 62,)}],
    {"yarpy.type": 3, "x": None, "y": ()},
    [["yarpy.type", ["list"], 54], None],
    {"a": {"yarpy.type": (1, 2)}},
    {"v": Vocab("ok"), "x": {"w": Vocab("set")}},
    {"f": np.float32(0.5), "i": np.int64(3), "b": np.bool_(True), "x": ()},
    {"c": np.complex64(1 + 2j)},
    Pair(np.ones((2, 2, 2), "f4"), None),
    {"same": [1, 1], "ints": [1, 2, 3], "floats": [1.0, 2.0], "words": ["a", "b"], "x": ()},
]


@pytest.mark.parametrize("value", VALUES, ids=lambda it: str(it)[:30])
def test_comes_back_equal(value: Any) -> None:
    message = sent(value)
    assert description.place(message)
    for view in (message, bytearray(message), memoryview(message)):
        found = codec.decode(view)
        assert same(value, found), found
    assert same(value, codec.decode_as(message, type(found)))
    assert sent(found) == message, "and is the same message when it is sent on"
    if (
        not isinstance(value, dict) or "inf" not in value
    ):  # a text has no other spelling for the number
        assert same(value, codec.decode_text(codec.encode_text(value)))
    walker = Walker()
    assert walker.advance(message) == len(message) and walker.done


def test_what_a_cpp_program_passed_on() -> None:
    """C++ writes lists of elements of one kind without their tags, whoever wrote them before."""
    for value in VALUES:
        again = sent(Bottle(Bottle.from_bytes(sent(value))))
        found = codec.decode(again)
        if isinstance(value, dict) and "yarpy.type" in value:
            continue  # its own key, which may have moved
        assert same(value, found), value


OWN = [
    Image(np.arange(12, dtype="u1").reshape(2, 2, 3), "bgr"),
    Matrix(np.eye(2)),
    Vector([1, 2], "int32"),
    Stamp(5, 2.5),
    Sound(np.zeros((2, 3), "i2"), 8000),
    PointCloud(np.ones((4, 3), "f4")),
]


@pytest.mark.parametrize("value", OWN, ids=lambda it: type(it).__name__)
def test_types_of_our_own_in_it(value: Any) -> None:
    for whole in ([value, None], {"a": value, "b": ()}, ({"x": [value], "y": ()},)):
        found = codec.decode(sent(whole))
        place = found[0] if isinstance(whole, list) else found
        inner = place["a"] if isinstance(whole, dict) else place
        inner = inner[0]["x"][0] if isinstance(whole, tuple) else inner
        assert type(inner) is type(value)
        assert sent(inner) == sent(value)


class Point:
    def to_wire(self) -> Any:
        return codec.encode([1, "a"])


def test_a_type_of_a_user_in_it() -> None:
    assert codec.decode(sent({"p": Point(), "x": ()})) == {"p": [1, "a"], "x": ()}


def test_large_arrays_are_views_and_are_not_copied() -> None:
    value = {
        "rgb": np.ones((480, 640, 3), "u1"),
        "mask": np.ones((500, 500), bool),
        "deep": [{"q": (np.ones(100_000, "f4"),)}],
        "blob": np.ones((10, 10, 10, 10, 10), "f2"),
    }
    with measured() as peak:
        blocks = codec.encode(value)
    assert peak.bytes < 1 << 18
    message = b"".join(blocks)
    with measured() as peak:
        found = codec.decode(message)
    assert peak.bytes < 1 << 18 and same(value, found)
    memory = np.frombuffer(message, "u1")
    for array in (found["rgb"], found["mask"], found["deep"][0]["q"][0], found["blob"]):
        assert np.shares_memory(memory, array)


arrays = hnp.arrays(
    st.sampled_from(
        ["?", "i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "f2", "f4", "f8", "c8", "c16"]
    ),
    hnp.array_shapes(min_dims=1, min_side=0, max_side=5),
)
leaves = st.one_of(
    *(st.none(), st.booleans(), st.integers(-(1 << 63), (1 << 63) - 1), st.floats(), st.text()),
    *(st.binary(), st.complex_numbers(allow_nan=False), arrays),
)
values = st.recursive(
    leaves,
    lambda inner: (
        st.lists(inner, max_size=4)
        | st.dictionaries(st.text(max_size=5), inner, max_size=4)
        | st.lists(inner, max_size=3).map(tuple)
    ),
    max_leaves=12,
)


@given(st.dictionaries(st.text(max_size=5), values, max_size=4))
def test_every_dict_comes_back(value: dict[str, Any]) -> None:
    message = sent(value)
    found = codec.decode_as(message, dict)
    ordered = value if description.place(message) else dict(sorted(value.items(), key=_bytes))
    assert same(ordered, found)


def _bytes(pair: tuple[str, Any]) -> bytes:
    return pair[0].encode("utf-8", "surrogateescape")


@given(st.lists(values, max_size=4))
def test_every_list_comes_back(value: list[Any]) -> None:
    message = sent(value)
    found = codec.decode_as(message, list)
    if description.place(message):
        assert same(value, found)
    else:  # arrays of one dimension are lists of numbers there
        assert len(found) == len(value)


def _cyclic() -> Any:
    value: dict[str, Any] = {}
    value["again"] = value
    return value


def _deep() -> Any:
    value: Any = None
    for _ in range(200):
        value = {"a": value}
    return value


@pytest.mark.parametrize(
    ("make", "why"),
    [
        (_cyclic, ValueError),
        (_deep, ValueError),
        (lambda: {"a": (1 << 70,)}, OverflowError),
        (lambda: {"a": {1, 2}, "b": None}, TypeError),
        (lambda: {None: (1,)}, TypeError),
        (lambda: {(1, 2): 3}, TypeError),
        (lambda: [None, object()], TypeError),
        (lambda: {"a": np.array(["x"])}, TypeError),
        (lambda: {"a": Pose}, TypeError),
    ],
)
def test_what_cannot_be_sent(make: Callable[[], Any], why: type[Exception]) -> None:
    with pytest.raises(why):
        codec.encode(make())


def test_the_deepest_that_can_be_sent_comes_back() -> None:
    value: Any = ()
    deepest = None
    for _ in range(60):
        value = {"a": value}
        try:
            message = sent(value)
        except ValueError:
            break
        assert same(value, codec.decode(message))
        deepest = copy.deepcopy(value)
    assert deepest is not None and value != deepest
