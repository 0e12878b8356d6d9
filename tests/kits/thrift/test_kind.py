"""Kinds: what annotations mean, and how much room a value takes."""

from types import GenericAlias, ModuleType
from typing import Annotated

import pytest

from yarpy.data.value import Vocab
from yarpy.kits.thrift import kind as kinds
from yarpy.kits.thrift.kind import (
    ARRAYS,
    External,
    ListOf,
    MapOf,
    SetOf,
    flat,
    has_floats,
    has_sets,
    kind_of,
    list_code,
    name_of,
)


def test_annotations(capt: ModuleType) -> None:
    names = {"Point": capt.Point, "list": list, "kinds": kinds}
    for annotation, expected in {
        bool: kinds.BOOL,
        int: kinds.I32,
        float: kinds.DOUBLE,
        str: kinds.TEXT,
        bytes: kinds.BINARY,
        Vocab: kinds.VOCAB,
        kinds.ui16: kinds.UI16,
        kinds.Float64s: ListOf(kinds.DOUBLE),
        list[str]: ListOf(kinds.TEXT),
        set[kinds.i64]: SetOf(kinds.I64),
        dict[str, capt.Point]: MapOf(kinds.TEXT, capt.Point),
        capt.Color: capt.Color,
        "Point": capt.Point,
        "list[Point]": ListOf(capt.Point),
        GenericAlias(list, ("Point",)): ListOf(capt.Point),
        Annotated[object, External("a::B")]: External("a::B"),
    }.items():
        assert kind_of(annotation, names) == (expected, False)
    assert kind_of(kinds.Nested[capt.Point], names) == (capt.Point, True)


@pytest.mark.parametrize("annotation", [complex, list, object, tuple[int, int], None])
def test_what_thrift_has_no_type_for(annotation: object) -> None:
    with pytest.raises(TypeError, match="is no type of Thrift: use int, float"):
        kind_of(annotation, {})


def test_structs_take_the_room_of_their_fields(capt: ModuleType) -> None:
    assert flat(capt.Nest) == 6 and flat(capt.Deep) == 7 and flat(kinds.I32) == 1
    assert flat(External("a::B", 3)) == 3 and flat(ListOf(capt.Nest)) == 1


def test_codes_of_lists(capt: ModuleType) -> None:
    assert list_code(kinds.DOUBLE) == 10 and list_code(kinds.UI8) == 32
    assert list_code(capt.Color) == 1 and list_code(capt.Point) == 0
    assert list_code(ListOf(SetOf(kinds.I64))) == 17  # of what is within
    assert list_code(ListOf(capt.Point)) == 0 and list_code(MapOf(kinds.I32, kinds.I32)) == 0


def test_names() -> None:
    assert name_of(MapOf(kinds.TEXT, ListOf(kinds.SIZE))) == "map<string, list<size_t>>"
    assert name_of(External("yarp::sig::Vector")) == "yarp::sig::Vector"
    assert all(hasattr(kinds, name) for name in ARRAYS.values())


def test_who_has_sets(capt: ModuleType) -> None:
    assert has_sets([capt.Sets]) and has_sets([ListOf(capt.Sets)])
    assert has_sets([MapOf(kinds.I32, SetOf(kinds.I32))])
    assert not has_sets([capt.Nest, kinds.I32])


def test_who_has_floats(capt: ModuleType) -> None:
    assert has_floats([kinds.DOUBLE]) and has_floats([ListOf(kinds.FLOAT)])
    assert has_floats([MapOf(kinds.I32, capt.One)]) and has_floats([External("Vector")])
    assert not has_floats([capt.Point, kinds.I32, SetOf(kinds.TEXT)])
