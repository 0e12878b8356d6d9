"""The rules of a file: what breaks them is refused with its line, what is odd is told."""

import pytest

from yarpy.errors import DecodeError
from yarpy.kits.thrift.file.include import text_interface


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ("struct A { 1: Pont p }\nstruct Point {}", 'f:1: no type "Pont": did you mean "Point"?'),
        ("struct A {}\n\nenum A { B }", 'f:3: "A" is there already, in line 1'),
        ("struct A { 1: i32 a, 2: i32 a }", 'f:1: "a" is there twice in A'),
        ("struct A { 1: i32 a, 1: i32 b }", '"b" and "a" in A have the same number, 1'),
        ("struct A { 1: A a }", 'f:1: "A" contains itself: make it optional, or put'),
        ("struct A { 1: B b }\nstruct B { 1: A a }", "contains itself"),
        ("typedef b a\ntypedef a b", "is defined by itself"),
        ("enum A { B, B }", '"B" is there twice in A'),
        ('enum A { B } (yarp.enumbase = "float")', '"float" is no type of integers'),
        ('typedef i64 (yarp.type = "yarp::conf::vocab32_t") a', ""),
        ("struct __ {}", '"__" has no letter'),
        ("struct S { 1: i32 _a, 2: i32 a_ }", '"a_" and "_a" are both a_ in Python'),
        ("struct _A {}\nstruct A_ {}", 'f:2: "A_" and "_A" are both A_ in Python'),
        ("service A extends B {}", 'f:1: no service "B"'),
        ("struct B {}\nservice A extends B {}", 'f:2: "B" is no service'),
        ("service A extends A {}", '"A" extends itself'),
        ("service A { void help_me() }", "the word help is taken"),
        ("service A { void help() }", "the word help is taken"),
        ("service A { void a__b() }", "cannot call names with __"),
        ("service A { void a_() }", "with _ at their end"),
        ("service A { oneway i32 a() }", '"a" is oneway, so its result must be void'),
        ("service A { void a(1: i32 x, 2: i32 x) }", '"x" is there twice in a'),
        ("service A { void a() }\nservice B extends A { void a() }", "that B extends has it, too"),
        ("service A { i33 a() }", 'no type "i33": did you mean'),
        ("service A {}\nstruct S { 1: A a }", '"A" is no type'),
        ("struct S {}\nstruct T { 1: map<S, map<list<S>, i32>> m }", ""),
        ("struct S { 1: optional S s, 2: S& t }\nunion U { 1: U u }", ""),
        ('include "a.thrift"', "a text cannot include"),
    ],
)
def test_rules(text: str, error: str) -> None:
    if not error:
        assert text_interface(text, "f")
        return
    with pytest.raises(DecodeError) as caught:
        text_interface(text, "f")
    assert error in str(caught.value) and str(caught.value).startswith("f:")


def test_many_values_are_refused_in_time() -> None:
    lines = ["struct S0 { 1: i32 a, 2: i32 b }"]
    lines += [f"struct S{at} {{ 1: S{at - 1} a, 2: S{at - 1} b }}" for at in range(1, 60)]
    with pytest.raises(DecodeError, match="has more than 10000 values"):
        text_interface("\n".join(lines))


def test_names_and_depths_have_limits() -> None:
    with pytest.raises(DecodeError, match="is longer than 200 characters"):
        text_interface(f"service S {{ void {'a_' * 1000}b() }}")
    lines = ["struct S0 { 1: i32 a }"]
    lines += [f"struct S{at} {{ 1: S{at - 1} a }}" for at in range(1, 1000)]
    with pytest.raises(DecodeError, match="structs are nested more than 100 deep"):
        text_interface("\n".join(reversed(lines)))


def test_an_annotation_in_the_wrong_place_is_told(caplog: pytest.LogCaptureFixture) -> None:
    text_interface(
        'struct A {\n 1: i32 (yarp.type = "size_t") a,\n 2: i32 b (yarp.type = "size_t") }\n'
        'service S { void f(1: double c (yarp.type = "yarp::conf::float32_t")) }',
        "x",
    )
    assert [record.getMessage().split(" does")[0] for record in caplog.records] == [
        'x:3: yarp.type behind the name "b"',
        'x:4: yarp.type behind the name "c"',
    ]


def test_every_object_that_a_struct_begins_with_is_counted() -> None:
    """Nested or not, and whether there is anything in it."""
    for end in ('(yarp.nested = "true")', ""):
        for first in ("1: i32 a", ""):
            lines = [f"struct S0 {{ {first} }}"]
            lines += [f"struct S{n} {{ S{n - 1} a {end}; S{n - 1} b {end} }}" for n in range(1, 25)]
            with pytest.raises(DecodeError, match="has more than 10000 values"):
                text_interface("\n".join(lines))
    text_interface('struct A { 1: i32 a } struct B { A a (yarp.nested="true"); list<B> more }')


def test_types_of_types_are_nested_as_deep_as_others() -> None:
    lines = ["typedef list<i32> A0", *(f"typedef list<A{n - 1}> A{n}" for n in range(1, 2000))]
    with pytest.raises(DecodeError, match="nested more than 20 deep"):
        text_interface("\n".join(lines))
    text_interface("\n".join([*lines[:19], "struct S { A18 a }"]))


def test_services_that_extend_many() -> None:
    lines = ["service S0 { void m0() }"]
    lines += [f"service S{n} extends S{n - 1} {{ void m{n}() }}" for n in range(1, 4000)]
    with pytest.raises(DecodeError, match="extends more than 100 others"):
        text_interface("\n".join(lines))
    text_interface("\n".join(lines[:100]))
    twice = "\n".join([*lines[:50], "service T extends S49 { void m0() }"])
    with pytest.raises(DecodeError, match='"m0": a service that T extends has it'):
        text_interface(twice)
    with pytest.raises(DecodeError, match='"A" extends itself'):
        text_interface("service A extends B {} service B extends A {}")


def test_a_name_that_begins_as_another(caplog: pytest.LogCaptureFixture) -> None:
    assert text_interface("service A { void get() }\nservice B extends A { void get_all() }", "f")
    assert 'f:2: the compiler of C++ YARP refuses "get_all" beside "get"' in caplog.text


def test_types_behind_typedefs_are_counted() -> None:
    lines = ["typedef list<i32> t0"]
    lines += [f"typedef map<t{at}, t{at}> t{at + 1}" for at in range(15)]
    with pytest.raises(DecodeError, match="a type of more than 1000 others"):
        text_interface("\n".join(lines))
