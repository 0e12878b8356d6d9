"""The model of types: what a value takes at least."""

from yarpy.peers.ros.message.model import (
    PRIMITIVES,
    Field,
    ListOf,
    Primitive,
    Struct,
    has_arrays,
    parts,
    smallest,
)

FLOAT = PRIMITIVES["float64"]
PAIR = Struct("Pair", (Field("x", FLOAT), Field("name", PRIMITIVES["string"])))


def test_smallest_sizes() -> None:
    assert PAIR.smallest == 12
    assert smallest(ListOf(PAIR)) == 4
    assert smallest(ListOf(PAIR, 3)) == 36
    assert smallest(PRIMITIVES["time"]) == 8
    assert Struct("Empty", ()).smallest == 0


def test_parts_count_objects() -> None:
    assert PAIR.parts == 3
    assert parts(ListOf(FLOAT, 1000)) == 1  # one array
    assert parts(ListOf(PRIMITIVES["time"], 10)) == 11
    assert parts(ListOf(PAIR, 10)) == 31
    assert parts(ListOf(PAIR)) == 1


def test_arrays_are_found_at_any_depth() -> None:
    holder = Struct("Holder", (Field("inner", ListOf(Struct("Inner", (Field("x", FLOAT),)))),))
    assert not PAIR.has_arrays and not holder.has_arrays
    assert not has_arrays(ListOf(PRIMITIVES["time"], 10))
    assert has_arrays(ListOf(FLOAT)) and has_arrays(ListOf(PRIMITIVES["uint8"], 16))
    pose = Struct("Pose", (Field("covariance", ListOf(FLOAT, 36)),))
    deep = Struct("Deep", (Field("poses", ListOf(pose)),))
    assert deep.has_arrays and has_arrays(ListOf(deep, 2))


def test_types_read_as_they_are_written() -> None:
    assert str(ListOf(FLOAT)) == "float64[]"
    assert str(ListOf(PAIR, 2)) == "Pair[2]"


def test_numbers_are_told_from_other_primitives() -> None:
    names = {name for name, primitive in PRIMITIVES.items() if primitive.is_number}
    assert names == {*PRIMITIVES} - {"string", "wstring", "binary", "time", "duration"}
    assert Primitive("int32", "i", 4) == PRIMITIVES["int32"]
