"""Interfaces: names, and the types that they stand for."""

import pytest

from yarpy.kits.thrift import kind as kinds
from yarpy.kits.thrift.file.document import EnumText, StructText
from yarpy.kits.thrift.file.include import text_interface
from yarpy.kits.thrift.file.interface import enum_base, external
from yarpy.kits.thrift.file.parse import parse
from yarpy.kits.thrift.library import loads


def test_types_behind_typedefs() -> None:
    found = text_interface(
        'typedef i32 (yarp.type="yarp::conf::vocab32_t") vocab\ntypedef vocab word\n'
        'typedef i16 (yarp.type="unsigned short") u\ntypedef list<u> us\n'
        'typedef double (yarp.type="yarp::conf::float64_t") d\nstruct S { 1: word w }'
    )
    types = {each.name: each.type for each in found.document.declarations[:5]}  # type: ignore[union-attr]
    kinds_of = {name: found.resolve(type_)[1] for name, type_ in types.items()}
    assert kinds_of["word"] is kinds.VOCAB and kinds_of["u"] is kinds.UI16
    assert kinds_of["d"] is kinds.DOUBLE


@pytest.mark.parametrize(
    ("given", "base"),
    [
        ("int8_t", kinds.I8),
        ("std::uint8_t", kinds.UI8),
        ("int16_t", kinds.I16),
        ("std::uint32_t", kinds.UI32),
        ("int64_t", kinds.I64),
        ("yarp::conf::vocab32_t", kinds.VOCAB),
        ("int", kinds.I32),
    ],
)
def test_bases_of_enums(given: str, base: kinds.Scalar) -> None:
    found = text_interface(f'enum E {{ A = 1 }} (yarp.enumbase = "{given}")')
    enum = found.document.declarations[0]
    assert isinstance(enum, EnumText) and enum_base(found, enum) is base


def test_types_of_cpp() -> None:
    def found(annotations: str) -> kinds.External | None:
        struct = parse(f"struct V {{ 1: list<double> c }} ({annotations})").declarations[0]
        assert isinstance(struct, StructText)
        return external(struct)

    assert found('yarp.name = "yarp::sig::Vector"') == kinds.External(
        "yarp::sig::Vector", 1, "yarpy.Vector"
    )
    assert found('yarp.name = "a::B" yarp.bottlesize = "3"') == kinds.External("a::B", 3)
    assert found('yarp.bottlesize = "0" cpp.name = "a"') == kinds.External("a", 1)
    assert found('x = "y"') is None


def test_lists_of_structs_of_lists_of_structs() -> None:
    lines = [f"struct S{n} {{ list<S{n + 1}> a }}" for n in range(3000)]
    found = loads("\n".join([*lines, "struct S3000 { i32 a }"]))
    data = b"".join(found.S0().to_wire())
    assert found.S0.from_wire(data) == found.S0()
