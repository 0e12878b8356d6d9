"""Values of a file against their types, and types where they are mentioned."""

import pytest

from yarpy.errors import DecodeError
from yarpy.kits.thrift.file.include import text_interface
from yarpy.kits.thrift.generate.module import python


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ("struct A { 1: i32 a = 'x' }", "f:1: expected a value for i32, found 'x'"),
        ("struct A { 1: i8 a = 300 }", r"f:1: 300 does not fit in i8"),
        ("struct A { 1: bool a = 2 }", "expected a value for bool, found 2"),
        ("struct A { 1: string a = 2 }", "expected a value for string"),
        ("struct A { 1: list<i32> a = 2 }", "expected a value for a list, found 2"),
        ("struct A { 1: map<i32, i32> a = [1] }", "expected a value for a map, found a list"),
        ("enum E { A }\nstruct S { 1: E e = E.B }", "f:2: E is one of A, not E.B"),
        ("enum E { A }\nstruct S { 1: E e = 'A' }", "expected a value for E, found 'A'"),
        ("enum E { A = 300 } (yarp.enumbase = 'int8_t')", r"E\.A \(300\) does not fit in i8"),
        ("const i32 A = B\nconst i32 B = 1", 'the constant "B" comes later'),
        ("const i32 A = C", 'no constant "C"'),
        ("struct S {}\nconst i32 A = S", '"S" is no constant'),
        ("struct S { 1: i32 a }\nconst S A = { 'b': 1 }", "S has no field 'b'"),
        ("struct S { 1: i32 a }\nconst S A = 5", "expected a value for S, found 5"),
    ],
)
def test_values_must_fit(text: str, error: str) -> None:
    with pytest.raises(DecodeError, match=error):
        python(text_interface(text, "f"))


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("struct A { 1: list<B> b }\nstruct B {}", '    b: list["B"] = thrift.new(list)'),
        (
            "struct A { 1: map<i16, list<i64>> b }",
            "    b: dict[thrift.i16, thrift.Int64s] = thrift",
        ),
        ("const list<bool> A = [true, 0]", "A: Final = [True, False]"),
        ("const set<string> A = []", "A: Final = set()"),
        ("const double A = 3", "A: Final = 3.0"),
        ("typedef i8 (yarp.type = 'uint8_t') u\nconst u A = 255", "A: Final = 255"),
        ("const i64 A = -9223372036854775808", "A: Final = -9223372036854775808"),
        ("enum E { X = 3 }\nconst i32 A = E.X", "A: Final = 3"),
    ],
)
def test_types_and_values(text: str, line: str) -> None:
    assert line in python(text_interface(text, "f"))
