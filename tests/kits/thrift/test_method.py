"""Methods: the words of their names, arguments, results."""

from types import ModuleType

import pytest

from yarpy.data.bottle import Bottle
from yarpy.data.sig.vector import Vector
from yarpy.errors import DecodeError
from yarpy.kits import thrift
from yarpy.kits.thrift.library import loads
from yarpy.kits.thrift.method import first_word, shown


def test_words_up_to_four_letters_are_vocabs(capt: ModuleType) -> None:
    head = capt.Capt._methods["get_long_method_name"].head
    assert head.hex() == (
        "00010000060000000900000067657400090000006c6f6e6704000000060000006d6574686f64"
        "090000006e616d65"
    )
    assert Bottle.from_bytes(capt.Capt._methods["noargs"].ask()) == ["noargs"]


def test_a_vocab_behind_a_name_is_no_word_of_it() -> None:
    made = loads(
        "struct B { 1: bool b }\nservice S { void set_on(1: bool on), void set_it(1: B b), "
        'void put_it(1: B b (yarp.nested = "true")), void set_long(1: i32 n, 2: bool on) }',
        "s",
    )
    methods = made.S._methods
    ask = {
        "set_on": methods["set_on"].ask(True),
        "set_it": methods["set_it"].ask(made.B()),
        "put_it": methods["put_it"].ask(made.B()),
        "set_long": methods["set_long"].ask(1, True),
    }
    last = {name: type(Bottle.from_bytes(data)[1]).__name__ for name, data in ask.items()}
    assert last == {"set_on": "str", "set_it": "str", "put_it": "Vocab", "set_long": "Vocab"}


def test_structs_are_spliced_in_unless_nested() -> None:
    made = loads(
        "struct P { 1: i32 x, 2: i32 y }\nservice S {"
        'bool flat(1: P p), bool own(1: P p (yarp.nested = "true")), P back(), list<P> all() }',
        "s",
    )
    point, methods = made.P(1, 2), made.S._methods
    assert Bottle.from_bytes(methods["flat"].ask(point)) == ["flat", 1, 2]
    assert Bottle.from_bytes(methods["own"].ask(point)) == ["own", [1, 2]]
    assert methods["flat"].ask(point)[4] == 3 and methods["own"].ask(point)[4] == 2
    assert (
        methods["back"].answer(point)
        == Bottle([1, 2, "x"]).to_bytes()[:8].replace(b"\3", b"\2")
        + Bottle([1, 2, "x"]).to_bytes()[8:24]
    )
    assert methods["back"].read_answer(Bottle([1, 2]).to_bytes()) == point
    assert methods["all"].read_answer(Bottle([[[1, 2]]]).to_bytes()) == [point]


def test_results_that_write_themselves_are_the_whole_answer() -> None:
    made = loads(
        'struct V {} (yarp.name = "yarp::sig::Vector")\nstruct T {} (yarp.name = "a::T")\n'
        "service S { V get(), T other() }",
        "s",
    )
    method = made.S._methods["get"]
    assert method.answer(Vector([1.0])) == Vector([1.0]).to_wire()[0]
    assert method.read_answer(method.answer(Vector([1.0]))) == Vector([1.0])
    assert made.S._methods["other"].read_answer(Bottle([1, "a"]).to_bytes()) == [1, "a"]


def test_methods_written_by_hand() -> None:
    class Camera(thrift.Service):
        @thrift.method
        def set_speed(self, speed: float, fast: bool = False) -> bool:
            """Sets it."""
            raise NotImplementedError

        @thrift.oneway
        def stop(self) -> None: ...

    assert (
        Camera._methods["set_speed"].prototype == "bool set_speed(double speed, bool fast = false)"
    )
    assert Camera._methods["stop"].prototype == "oneway void stop()"

    class Wrong(thrift.Service):
        @thrift.method
        def go(self, where) -> None:  # type: ignore[no-untyped-def]
            ...

    with pytest.raises(TypeError, match="go: the argument where needs a type: where: float"):
        _ = Wrong._methods["go"].parts


def test_words() -> None:
    data = Bottle(["set", 1]).to_bytes()
    assert first_word(data, 8) == ("set", 19, 4)
    with pytest.raises(DecodeError, match="the name of a method is a word"):
        first_word(data, 19)
    with pytest.raises(DecodeError):
        first_word(data, 40)


def test_defaults_as_thrift_spells_them(capt: ModuleType) -> None:
    assert [shown(v) for v in (True, "a", 1.5, capt.Color.RED)] == [
        "true",
        '"a"',
        "1.5",
        "Color.RED",
    ]
