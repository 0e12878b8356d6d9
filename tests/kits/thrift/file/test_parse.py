"""Texts of `.thrift` files, right and wrong."""

import sys

import pytest
from support.thrift import GOLDEN

from yarpy.errors import DecodeError, UnknownPlugin
from yarpy.kits.thrift.file.document import (
    ConstText,
    EnumText,
    Name,
    Pairs,
    ServiceText,
    StructText,
    TypedefText,
)
from yarpy.kits.thrift.file.parse import parse
from yarpy.limit import THRIFT_TEXT

TEXT = """\
// comment
# another
/* and another: struct Not {} */
include "geometry.thrift"
cpp_include "x.h"
namespace yarp robot.arm
namespace * all

/** How far. */
const double FAR = 2.5e3
const map<string, list<i32>> TABLE = {'a': [1, -2], "b": [0x10]}
typedef list<geometry.Point> (a.b = "c", d) Points
/**
 * Which way.
 *
 * Not a direction.
 */
enum Way { LEFT, RIGHT = 5; BACK } (yarp.enumbase = "int8_t")
union Either {
  1: i32 a; 2: required string b = "x\\ty";
  optional Way c = Way.LEFT (yarp.nested = "true")
}
exception Oops { 1: string why }
/** Does things. */
service Arm extends geometry.Base {
  /** Moves. */
  bool move(1: i32 joint = 3, 2: double angle) throws (1: Oops oops) (yarp.qualifier = "const"),
  oneway void stop();
  void nothing()
} (yarp.monitor = "true")
"""


def test_everything_in_a_file() -> None:
    found = parse(TEXT, "arm.thrift")
    assert found.includes == (("geometry.thrift", 4),)
    assert found.namespaces == {"yarp": "robot.arm", "*": "all"}
    far, table, points, way, either, oops, arm = found.declarations
    assert isinstance(far, ConstText) and (far.value, far.doc, far.line) == (2500.0, "How far.", 10)
    assert isinstance(table, ConstText)
    assert table.value == Pairs((("a", [1, -2]), ("b", [16])))
    assert isinstance(points, TypedefText) and points.type.inner[0].name == "geometry.Point"
    assert points.type.annotations == {"a.b": "c", "d": "1"}
    assert isinstance(way, EnumText) and way.doc == "Which way.\n\nNot a direction."
    assert [(each.name, each.number) for each in way.values] == [
        ("LEFT", 0),
        ("RIGHT", 5),
        ("BACK", 6),
    ]
    assert way.annotations == {"yarp.enumbase": "int8_t"}
    assert isinstance(either, StructText)
    assert [each.number for each in either.fields] == [1, 2, None]
    assert either.fields[1].default == "x\ty" and isinstance(either.fields[2].default, Name)
    assert either.fields[2].annotations == {"yarp.nested": "true"}
    assert isinstance(oops, StructText) and isinstance(arm, ServiceText)
    assert (arm.extends, arm.doc, arm.annotations) == (
        "geometry.Base",
        "Does things.",
        {"yarp.monitor": "true"},
    )
    move, stop, nothing = arm.methods
    assert move.doc == "Moves." and move.result is not None and move.arguments[0].default == 3
    assert move.annotations == {"yarp.qualifier": "const"}
    assert stop.oneway and stop.result is None and not nothing.oneway


def test_the_recorded_interface() -> None:
    found = parse((GOLDEN / "capt.thrift").read_text(), "capt.thrift")
    assert len(found.declarations) == 21


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ("struct A { 1: i32 x = }", 'f:1:23: expected .* or a text in quotes, found "}"'),
        ("struct A {\n", 'f:1:10: expected .*"}".*, found the end of the file'),
        ("struct A { 1: i32 a.b }", '"a.b" is no name: it has a dot in it'),
        ("service S { i32 f(1: i32 a }", r'f:1:28: expected "\)", .* found "}"'),
        ("\n\nstrukt A {}", 'f:3:1: expected "const", .*, found "strukt"'),
        ('include "a', "expected a text in quotes, found a text without its second quote"),
        ("/* foo", "found a comment without its end"),
        ("struct A { 1: @ }", 'found "@"'),
        ("const i32 A = 99999999999999999999", "does not fit in 64 bits"),
        ("const i32 A = 9999999999999999999999999999999", "is too large"),
        ("enum E { A = x }", "expected a number, found"),
        ("typedef i32", "expected .*a name.*, found the end of the file"),
        ("struct 1A {}", 'expected a name, found "1"'),
    ],
)
def test_errors_say_where_and_what(text: str, error: str) -> None:
    with pytest.raises(DecodeError, match=error):
        parse(text, "f")


def test_what_is_too_large_or_too_deep() -> None:
    with pytest.raises(DecodeError, match="types are nested more than 20 deep"):
        parse("typedef " + "list<" * 3000 + "i32" + ">" * 3000 + " x")
    with pytest.raises(DecodeError, match="values are nested more than 20 deep"):
        parse("const list<i32> x = " + "[" * 3000 + "]" * 3000)
    with pytest.raises(DecodeError, match="characters, more than"):
        parse(" " * (THRIFT_TEXT + 1))


def test_without_lark_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "lark", None)
    with pytest.raises(UnknownPlugin, match=r"pip install 'yarpy\[thrift\]'"):
        parse("")
