"""Services: requests as C++ programs and people send them, and the answers."""

import asyncio
import logging
from types import ModuleType
from typing import Any

import pytest
from support.thrift import CALLS, asked, reply

from yarpy.data import codec
from yarpy.data.bottle import Bottle
from yarpy.data.value import Int8, Vocab
from yarpy.kits.thrift.library import loads

FAILED = bytes.fromhex("09010000010000006661696c")
# Where C++ errs: it writes sets wrong, takes `(4)` for the default x and the y of a struct, and
# does not know the names of its enums. Its prototypes are those of C++.
OURS = ("tcp_r_set", "raw_struct_short", "raw_enum_as_string", "raw_help_one")
SERVED = [name for name in CALLS if name not in OURS]


@pytest.mark.parametrize("name", SERVED)
def test_answers_as_cpp_does(name: str, server: Any) -> None:
    row = CALLS[name]
    answer = reply(server, bytes.fromhex(row["request"]))
    expected = bytes.fromhex(row["reply"])
    if expected == FAILED:  # whoever spells names as people do is told why
        found = Bottle.from_bytes(answer)
        assert found[0] == "fail" and all(isinstance(each, str) for each in found)
    elif row["key"] == "D" or name == "tcp_fire":
        assert expected in (b"", answer)
    else:
        assert answer == expected


def test_programs_are_not_told_more_than_they_can_read(server: Any, capt: ModuleType) -> None:
    for request in ([Vocab("add"), 1], [Vocab("nope")], [Vocab("add"), 1, 2, 3], ["nothing", 1]):
        assert reply(server, Bottle(request).to_bytes()) == FAILED
    assert reply(server, Bottle(["help_failure"]).to_bytes()).endswith(b"it takes nothing")


def test_a_short_argument_is_no_sign_of_a_person(server: Any) -> None:
    """C++ calls a method that is not here with a string: it could not read a reason."""
    for request in (["unknown", "x"], ["unknown", "x", "y"], [Vocab("nope"), "x"]):
        assert reply(server, Bottle([*request, 1]).to_bytes()) == FAILED
    assert reply(server, Bottle(["add", 1]).to_bytes()) != FAILED


def test_errors_are_short(server: Any) -> None:
    assert len(reply(server, "x" * 100_000 + " 1")) < 300


def test_sets_are_read_as_cpp_writes_them_and_written_as_bottles(server: Any) -> None:
    request = bytes.fromhex(CALLS["tcp_r_set"]["request"])
    assert Bottle.from_bytes(reply(server, request)) == [[1, 2, 3]]


def test_people_type_lines(server: Any) -> None:
    assert reply(server, "add 1 2") == "3"
    assert reply(server, "r_enum DARK_BLUE") == "7"
    assert reply(server, "r lint (1 2 3)") == "(1 2 3)"
    assert reply(server, "r_ldouble (1 2.5)") == "(1.0 2.5)"
    assert reply(server, "r_llist ((1 2) () (3))") == "((1 2) () (3))"
    assert reply(server, "r_mint ((a 1) (b 2))") == "((a 1) (b 2))"
    assert reply(server, "r_set (3 1 3)") == "(1 3)"
    assert reply(server, "fire 5") == "[done]"
    assert reply(server, "nothing") == ""
    assert reply(server, "getRemoteProtocolVersion") == "0 3 12 0"


def test_people_get_errors_that_help(server: Any) -> None:
    assert reply(server, "add 1") == '[fail] "add.b is missing"'
    assert reply(server, "add 1 x") == "[fail] \"add.b: expected an integer (i32), got 'x'\""
    assert "too many values: 8 bytes are left over; it takes a, b" in reply(server, "add 1 2 3")
    assert "Color is one of RED, GREEN, DARK_BLUE, not 'PINK'" in reply(server, "r_enum PINK")
    assert 'no method \\"nope\\": there are add, r_i8' in reply(server, "nope 1")
    assert "300 does not fit in i8" in reply(server, "r_i8 300")
    assert "r_nest.v.ps[1].y" in reply(server, "r_nest 1 2 ((1 2) (1 x)) () () ()")
    assert reply(server, "").startswith("[fail]")


def test_help(server: Any) -> None:
    assert reply(server, "help").startswith('[many] ("*** Available commands:" add r_i8')
    assert reply(server, "help add") == '[many] ("i32 add(i32 a, i32 b)" "Adds two numbers.")'
    shown = server.help("tail_defaults")[0]
    assert shown == (
        'string tail_defaults(i32 first, Color c = Color.GREEN, i32 n = 5, string s = "def word")'
    )
    assert server.help("zzz") == ["Command not found"]


def test_version_is_bytes_without_tags() -> None:
    made = loads("const i16 protocol_version = 7\nservice S { void f() }", "s")
    answer = reply(made.S(), Bottle(["getRemoteProtocolVersion"]).to_bytes())
    assert answer == bytes.fromhex("00010000 01000000 0700 0300 0c00 0000")


def test_what_a_method_raises_is_logged_and_answered(
    server: Any, caplog: pytest.LogCaptureFixture
) -> None:
    def fails(a: int, b: int) -> int:
        raise ValueError("no more")

    server.add = fails
    with caplog.at_level(logging.ERROR):
        assert reply(server, "add 1 2") == '[fail] "ValueError: no more" (raised ValueError)'
    assert "no more" in caplog.text
    server.add = lambda a, b: "three"
    assert "the result of add: expected an integer, got 'three'" in reply(server, "add 1 2")


def test_a_method_that_was_not_written_says_so(capt: ModuleType) -> None:
    assert reply(capt.Capt(), "add 1 2") == '[fail] "Capt does not have this method"'


def test_inherited_methods_are_called() -> None:
    made = loads(
        "service A { i32 base_op(1: i32 x) }\nservice B extends A { i32 own(1: i32 x) }", "s"
    )

    class Both(made.B):  # type: ignore[misc, name-defined]
        def base_op(self, x: int) -> int:
            return x + 1

        def own(self, x: int) -> int:
            return x - 1

    assert reply(Both(), "base_op 3") == "4" and reply(Both(), "base op 3") == "4"
    assert reply(Both(), "own 3") == "2"
    assert Both().help()[1:3] == ["base_op", "own"]


def test_a_oneway_call_is_answered_before_it_is_done(server: Any) -> None:
    message, answers = asked(b"fire 5", "text")
    seen: list[int] = []
    server.fire = lambda x: seen.append(len(answers))
    assert server(message) is None
    assert seen == [1]
    message, answers = asked(b"fire 5", "text", wants=False)
    assert server(message) is None and not answers


def test_direct_calls_are_calls(server: Any) -> None:
    assert reply(server, "__direct__ add 1 2") == "3"


def test_methods_may_be_coroutines(server: Any) -> None:
    async def add(a: int, b: int) -> int:
        await asyncio.sleep(0)
        if b == 0:
            raise ValueError("zero")
        return a + b

    server.add = add
    for line, expected in (
        ("add 1 2", "3"),
        ("add 1 0", '[fail] "ValueError: zero" (raised ValueError)'),
    ):
        message, _ = asked(line.encode(), "text")
        answer = asyncio.run(server(message))
        assert codec.encode_text(answer).decode() == expected


def test_memory_of_failures_is_bounded(server: Any) -> None:
    for number in range(300):
        message, _ = asked(Bottle([Vocab("add"), Int8(1)]).to_bytes())
        message.source = f"/client{number}"
        server(message)
    assert len(server._failures) == 100


def test_page_is_for_the_root(server: Any) -> None:
    assert "<form" in server.page("/", {})
    assert server.page("/else", {}) is None


def test_closing_a_server_is_refused(server: Any) -> None:
    from yarpy.errors import LocalProtocolError

    with pytest.raises(LocalProtocolError, match="is no client"):
        server.close()


# -- YARP 4.0 ----------------------------------------------------------------------------------

VERSION = Bottle(["getRemoteProtocolVersion"]).to_bytes()


def test_fractions_are_answered_as_they_came() -> None:
    module = loads("""
        service Four {
          double half(1: double value); double last();
          list<double> all(1: list<double> values); float32 small(1: float32 value);
        }
        typedef double (yarp.type="yarp::conf::float32_t") float32
    """)

    class Four(module.Four):  # type: ignore[misc, name-defined]
        def half(self, value: float) -> float:
            return value / 2

        def last(self) -> float:
            return 1.5

        def all(self, values: Any) -> Any:
            return values

        def small(self, value: float) -> float:
            return value

    server = Four()
    three = bytes.fromhex("00010000 01000000 0a000000 000000000000f83f")
    four = bytes.fromhex("00010000 01000000 14000000 000000000000f83f")
    last = Bottle([Vocab("last")]).to_bytes()
    half = "00010000 02000000 09000000 68616c66 {}000000 0000000000000840"
    assert reply(server, last) == three
    assert reply(server, bytes.fromhex(half.format("14"))) == four
    assert reply(server, last) == four  # the same client
    assert reply(server, bytes.fromhex(half.format("0a"))) == three
    assert reply(server, last) == three
    lists = "00010000 02000000 09000000 616c6c00 {}010000 01000000 0000000000000840"
    assert reply(server, bytes.fromhex(lists.format("14"))).hex()[16:24] == "14010000"
    assert reply(server, bytes.fromhex(lists.format("0a"))).hex()[16:24] == "0a010000"
    small = bytes.fromhex("00010000 02000000 04000000 05000000 736d616c6c 0a000000 00002040")
    assert reply(server, small).hex()[16:] == "0a00000000002040"
    reply(server, VERSION)
    assert reply(server, last) == four  # who asks for it is of YARP 4
    assert reply(server, "last") == "1.5"
    assert reply(server, bytes.fromhex(half.format("0b"))) == FAILED
