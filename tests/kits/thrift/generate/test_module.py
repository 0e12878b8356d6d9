"""The text of modules: readable, typed, and what the file says."""

import subprocess
import sys
from importlib.util import find_spec
from inspect import cleandoc
from pathlib import Path

import pytest
from support.thrift import GOLDEN
from support.type_check import type_check
from support.wait import HANG

from yarpy.errors import DecodeError
from yarpy.kits.thrift.file.include import read_interface, text_interface
from yarpy.kits.thrift.generate.module import python, stubs
from yarpy.kits.thrift.library import load, loads

TEXT = """\
const i32 LIMIT = 4
const double HALF = 1
const string NAME = 'a "b"'
const list<string> WORDS = ["a", "b"]
const map<string, i32> COUNTS = { "a": LIMIT, "b": Way.BACK }
/** Which way. */
enum Way { LEFT = 1, BACK = 5, None = 7 } (yarp.enumbase = "int8_t")
/** Where it is.
 *  In metres. */
struct Point {
  /** To the right. */
  1: double x = 2,
  2: Way way = Way.BACK,
  3: list<i32> list_ = [1, 2],
  4: bool from = true,
  5: binary data = "abc",
  6: Way other = 5
}
const Point ORIGIN = { "x": 1.5, "way": Way.LEFT }
struct Vector {} (yarp.name = "yarp::sig::Vector")
struct Thing {} (yarp.name = "my::Thing")
struct Line { 1: Point begin, 2: Point end (yarp.nested = "true"), 3: Vector v, 4: Thing t }
service Robot {
  /** Goes there. */
  bool go(1: Line line, 2: Point to = { "x": 3.0 }, 3: list<double> speeds = [1.5]);
}
"""


def test_readable() -> None:
    text = python(text_interface(TEXT, "robot.thrift"))
    assert (
        text
        == '''\
"""The interface robot, written by `yarpy idl thrift`."""

from typing import Annotated, Final

import yarpy
from yarpy.kits import thrift

LIMIT: Final = 4
HALF: Final = 1.0
NAME: Final = 'a "b"'
WORDS: Final = ["a", "b"]
COUNTS: Final = {"a": LIMIT, "b": 5}


class Way(thrift.Enum, base=thrift.i8):
    """Which way."""

    LEFT = 1
    BACK = 5
    None_ = 7


class Point(thrift.Struct):
    """Where it is.
    In metres.
    """

    #: To the right.
    x: float = 2.0
    way: Way = Way.BACK
    list_: thrift.Int32s = thrift.new(lambda: [1, 2])
    from_: bool = True
    data: bytes = b"abc"
    other: Way = Way.BACK


ORIGIN: Final = Point(x=1.5, way=Way.LEFT)
Vector = Annotated[yarpy.Vector, thrift.External("yarp::sig::Vector", 1, "yarpy.Vector")]
Thing = Annotated[object, thrift.External("my::Thing")]


class Line(thrift.Struct):
    begin: Point = thrift.new(lambda: Point())
    end: thrift.Nested[Point] = thrift.new(lambda: Point())
    v: Vector = thrift.new(yarpy.Vector)
    t: Thing = thrift.new(yarpy.Bottle)


class Robot(thrift.Service):
    @thrift.method
    def go(
        self,
        line: Line,
        to: Point = thrift.new(lambda: Point(x=3.0)),
        speeds: thrift.Float64s = thrift.new(lambda: [1.5]),
    ) -> bool:
        """Goes there."""
        raise NotImplementedError


connect = Robot.connect
connect_async = Robot.connect_async
'''
    )


def test_it_runs_and_is_what_the_file_says() -> None:
    made = loads(TEXT, "robot")
    assert made.COUNTS == {"a": 4, "b": 5} and made.Point(1.5, made.Way.LEFT) == made.ORIGIN
    assert made.Line().to_text() == (
        "2.0 5 (1 2) [ok] {97 98 99} 5 (2.0 5 (1 2) [ok] {97 98 99} 5) () ()"
    )
    assert cleandoc(made.Point.__doc__) == "Where it is.\nIn metres."  # 3.13 does that by itself
    assert made.Robot().help("go")[0].startswith("bool go(Line line, Point to = Point(x=3.0,")


def test_members_with_the_names_of_types(tmp_path: Path) -> None:
    text = (
        "struct Point { 1: double x }\nenum Mode { OFF, ON }\n"
        "struct A { 1: i32 bytes, 2: binary data, 3: string str, 4: string name,\n"
        "5: Point Point, 6: Point p, 7: Mode Mode, 8: Mode m = Mode.ON, 9: i32 thrift, 10: i32 n,\n"
        "11: list<string> dict, 12: map<string, string> map_, 13: base.Point base,\n"
        "14: list<base.Point> others }\n"
        "service S { string str(1: string s); string other(1: string s, 2: Mode m = Mode.ON);\n"
        "Mode Mode(1: Mode m = Mode.ON) }"
    )
    (tmp_path / "base.thrift").write_text("struct Point { 1: i32 y }")
    (tmp_path / "top.thrift").write_text('include "base.thrift"\n' + text)
    found = load(tmp_path / "top.thrift")
    a = found.A(5, b"d", "s", "n", Mode=found.Mode.ON, thrift=3, others=[found.base.Point(1)])
    assert found.A.from_bottle(a.to_bottle()) == a
    assert (a.Point, a.p, a.base) == (found.Point(), found.Point(), found.base.Point())
    assert found.S._methods["other"].prototype == "string other(string s, Mode m = Mode.ON)"
    lines = stubs(read_interface(tmp_path / "top.thrift")).splitlines()
    assert "    data: _bytes = ..." in lines and "_bytes = bytes" in lines
    assert "    base: _base.Point = ..." in lines and "_base = base" in lines


@pytest.mark.skipif(find_spec("ruff") is None, reason="ruff reads it: pip install ruff")
@pytest.mark.timeout(250)  # mypy reads numpy's types
def test_the_linter_likes_it_and_types_are_right(tmp_path: Path) -> None:
    """`ruff format` leaves it alone, mypy checks it and a program that uses it."""
    for name, interface in (
        ("robot", text_interface(TEXT, "robot.thrift")),
        ("capt", read_interface(GOLDEN / "capt.thrift")),
    ):
        (tmp_path / f"{name}.py").write_text(python(interface))
    config = str(Path(__file__).parents[4] / "pyproject.toml")
    run = [sys.executable, "-m"]
    done = subprocess.run(
        [*run, "ruff", "format", "--diff", "--config", config, "."],
        cwd=tmp_path, capture_output=True, text=True, timeout=4 * HANG,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    for name in ("robot", "capt"):
        interface = (
            text_interface(TEXT, "robot.thrift")
            if name == "robot"
            else read_interface(GOLDEN / "capt.thrift")
        )
        (tmp_path / f"{name}.pyi").write_text(stubs(interface))
    pair = text_interface(
        "service A { list<double> f(1: list<double> v) }\nservice B extends A { i32 g() }", "p"
    )
    (tmp_path / "pair.py").write_text(python(pair))
    (tmp_path / "pair.pyi").write_text(stubs(pair))
    odd = text_interface(ODD, "odd")
    (tmp_path / "odd.py").write_text(python(odd))
    (tmp_path / "odd.pyi").write_text(stubs(odd))
    (tmp_path / "use.py").write_text(
        "import capt\nimport odd\nimport pair\nimport robot\nfrom yarpy.kits import thrift\n\n"
        "line: robot.Line = robot.Line(robot.Point(x=1.0, list_=[1, 2]))\n"
        "good: bool = robot.connect('/r').go(line, speeds=[1.5, 2])\n"
        "total: int = capt.connect('/c').add(1, 2)\n"
        "mean: float = capt.Lists(ld=[1.0]).ld.mean()\n"
        "bad: str = capt.connect('/c').add(1, 2)  # type: ignore[assignment]\n"
        "capt.connect('/c').add('one', 2)  # type: ignore[arg-type]\n"
        "capt.connect('/c').r_ldouble([1, 2]).mean()\n"
        "version: tuple[int, ...] | None = capt.connect('/c').remote_version()\n"
        "class Server(capt.Capt):\n"
        "    def r_ldouble(self, v: thrift.Float64s) -> thrift.Float64s:\n"
        "        return v * 2\n"
        "    def r_bool(self, v: int) -> str:  # type: ignore[override]\n"
        "        return ''\n"
        "text: str = odd.str_(1, 'a').s\n"
        "word: odd.str_ = odd.connect('/o').get(odd.float_(1.5), odd.dict_.B, {'a': 1}, {'b'})\n"
        "pair.B.connect('/x').f([1]).sum()\n"
        "number: int = pair.B.connect('/x').g()\n"
        "async def main() -> int:\n"
        "    async with pair.B.connect_async('/x') as both:\n"
        "        (await both.f([1])).sum()\n"
        "    async with capt.connect_async('/c', timeout=1.0) as client:\n"
        "        await client.r_bool('x')  # type: ignore[arg-type]\n"
        "        return await client.add(1, 2)\n"
    )
    done = type_check(tmp_path, "use.py")
    assert done.returncode == 0, done.stdout + done.stderr


def test_nothing_in_a_file_becomes_code() -> None:
    evil = '*/ """ + str(print("x")) + """ \\\\'
    text = (
        f"/** {evil[3:]} \n second \x07 \u2028 line */\n"
        f'struct A {{ /** {evil[3:]} */ 1: string a = \'""" {evil[3:15]}\' }}\n'
    )
    made = loads(text, "evil")
    assert made.A().a.startswith('""" ')
    assert 'print("x")' in made.A.__doc__


def test_names_that_would_hide_what_a_module_needs() -> None:
    made = loads(
        "enum thrift { A }\nstruct yarpy { 1: thrift t, 2: V v }\n"
        'struct V {} (yarp.name = "yarp::sig::Vector")\nservice connect { thrift f() }',
        "x",
    )
    assert made.yarpy().t is made.thrift.A
    assert made.connect._methods["f"].prototype == "thrift f()"


ODD = (
    "struct str { 1: i32 x, 2: string s }\nstruct float { 1: double v, 2: list<i32> all }\n"
    "enum dict { B }\nstruct tuple { 1: str s, 2: bool flag, 3: binary data }\n"
    "service object { str get(1: float b, 2: dict c, 3: map<string, i32> m, 4: set<string> s) }"
)


def test_types_with_the_names_of_pythons() -> None:
    made = loads(ODD, "odd")
    assert made.str_(1, "a").to_text() == "1 a"
    assert made.tuple_(made.str_(1, "a"), True, b"x").s == made.str_(1, "a")
    assert made.object_._methods["get"].parts[1].kind is made.dict_


def test_types_that_come_later() -> None:
    made = loads(
        "struct A { 1: list<B> bs, 2: B b, 3: E e, 4: E f = E.Y }\ntypedef list<B> Bs\n"
        "struct B { 1: i32 x = 3 }\nenum E { X, Y }\nstruct C { 1: Bs bs }",
        "x",
    )
    made_a = made.A(bs=[made.B(1)])
    assert made.A.from_wire(made_a.to_wire()[0]) == made_a and made_a.f is made.E.Y
    assert made.C(bs=[made.B()]).to_text() == "((3))"


@pytest.mark.parametrize(
    "doc",
    [
        '"""',
        '""""',
        '""',
        '"',
        "\\",
        '\\"',
        '\\"""',
        '""" "" "',
        "'''",
        '"""\n"""',
        '\\\n"',
        '"\n\\',
    ],
)
def test_comments_that_end_in_quotes(doc: str) -> None:
    lines = "\n".join(f" * {line}" for line in doc.split("\n"))
    text = f"/**\n{lines}\n*/ service S {{ /**\n{lines}\n*/ void f() }}"
    found = loads(text).S
    assert cleandoc(found.__doc__) == cleandoc(found.f.__doc__) == doc
    if "\n" not in doc:
        assert cleandoc(loads(f"/** {doc} */ service S {{}}").S.__doc__) == doc


@pytest.mark.parametrize("text", ["const double x = 1e999", "struct S { double x = -1e999 }"])
def test_numbers_that_no_double_can_be(text: str) -> None:
    with pytest.raises(DecodeError, match="1: the number does not fit in double"):
        loads(text)
    assert loads("const double x = 1e308").x == 1e308
