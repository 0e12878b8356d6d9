"""Clients: the requests of C++ programs, what answers mean, errors that name the method."""

import asyncio
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from support.thrift import CALLS
from support.wait import HANG

import yarpy
from yarpy import aio
from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.errors import DecodeError, LinkClosed, RemoteProtocolError, Timeout, UnknownName
from yarpy.kits.thrift.client import client_class, is_failure, version
from yarpy.kits.thrift.library import loads
from yarpy.wire.message import CALL, Message

FAILED = bytes.fromhex("09010000010000006661696c")


class Port:
    """Answers with the messages it was given, in their order."""

    def __init__(self, *answers: Any) -> None:
        self.answers = [*answers]
        self.asked: list[bytes] = []
        self.endings: list[Any] = []  # what finds the ends of the answers
        self.silent = True

    def ask(self, question: Any, timeout: float | None) -> Message | None:
        data = b"".join(_wire(question))
        if self.silent and b"getRemoteProtocolVersion" in data:
            return Message(CALL, FAILED)  # as C++ before 3.12
        self.asked.append(data)
        self.endings.append(getattr(question, "reply_end", None))
        answer = self.answers.pop(0)
        if isinstance(answer, Exception):
            raise answer
        return answer if answer is None or isinstance(answer, Message) else Message(CALL, answer)

    def tell(self, statement: Any) -> None:
        self.asked.append(b"".join(_wire(statement)))

    def close(self) -> None:
        self.answers = []


def _wire(value: Any) -> Any:
    from yarpy.data import codec

    return codec.encode(value)


def client(service: Any, *answers: Any) -> tuple[Any, Port]:
    port = Port(*answers)
    return client_class(service)(port, 2.0), port


def calls(capt: ModuleType) -> dict[str, tuple[str, tuple[Any, ...], Any]]:
    """What the recorded client called, and got."""
    point, color = capt.Point, capt.Color
    nest = point(1, 2), [point(3, 4), point(5, 6)], {"a": point(7, 8), "b": point(9, 10)}
    lists: tuple[Any, Any] = ([[1, 2], [], [3]], {"v": [1.5, 2.5], "w": []})
    anno = capt.Anno("set", 250, 65000, 4000000000, 10000000000, 1.25, 2.5, 9)
    return {
        "add": ("add", (2, 40), 42),
        "check_defaults": ("check_defaults", (), True),
        "check_defaults_7": ("check_defaults", (7,), False),
        "const_method": ("const_method", (), True),
        "get_long_method_name": ("get_long_method_name", (10, "abc"), 13),
        "no_result": ("no_result", ("some text",), None),
        "noargs": ("noargs", (), 77),
        "nothing": ("nothing", (), None),
        "r_anno": ("r_anno", (anno,), anno),
        "r_bool": ("r_bool", (True,), True),
        "r_bool_false": ("r_bool", (False,), False),
        "r_double": ("r_double", (3.25,), 3.25),
        "r_enum": ("r_enum", (color.DARK_BLUE,), color.DARK_BLUE),
        "r_float32": ("r_float32", (1.5,), 1.5),
        "r_i16": ("r_i16", (-300,), -300),
        "r_i32": ("r_i32", (123456,), 123456),
        "r_i64": ("r_i64", (5000000000,), 5000000000),
        "r_i8": ("r_i8", (-7,), -7),
        "r_lenum": ("r_lenum", ([color.RED, color.GREEN],), [color.RED, color.GREEN]),
        "r_lint": ("r_lint", ([1, 2, 3],), np.array([1, 2, 3])),
        "r_lint_empty": ("r_lint", ([],), np.array([])),
        "r_lbool": ("r_lbool", ([True, False],), np.array([True, False])),
        "r_ldouble": ("r_ldouble", ([1.5, 2.5],), np.array([1.5, 2.5])),
        "r_lstring": ("r_lstring", (["a", "b c"],), ["a", "b c"]),
        "r_llist": ("r_llist", ([[1, 2], [], [3]],), None),
        "r_lstruct": ("r_lstruct", ([point(1, 2), point(3, 4)],), [point(1, 2), point(3, 4)]),
        "r_mint": ("r_mint", ({"b": 2, "a": 1},), {"a": 1, "b": 2}),
        "r_mstruct": ("r_mstruct", ({"k": point(1, 2)},), {"k": point(1, 2)}),
        "r_nest": ("r_nest", (capt.Nest(*nest, *lists),), None),
        "r_one": ("r_one", (capt.One(1.5),), capt.One(1.5)),
        "r_string": ("r_string", ("two words",), "two words"),
        "r_string_empty": ("r_string", ("",), ""),
        "r_struct": ("r_struct", (point(4, 5),), point(4, 5)),
        "r_ui8": ("r_ui8", (200,), 200),
        "r_vocab": ("r_vocab", ("get",), "get"),
        "tail_defaults": ("tail_defaults", (1,), "1 2 5 def word"),
        "tail_defaults_all": ("tail_defaults", (1, color.RED, 9, "x y"), "1 1 9 x y"),
    }


def test_calls_are_those_of_cpp(capt: ModuleType) -> None:
    checked = calls(capt)
    recorded = {name.removeprefix("tcp_") for name in CALLS if name.startswith("tcp_")}
    assert recorded - set(checked) == {"fire", "r_binary", "r_set"}
    for name, (method, arguments, result) in checked.items():
        row = CALLS[f"tcp_{name}"]
        made, port = client(capt.Capt, bytes.fromhex(row["reply"]))
        found = getattr(made, method)(*arguments)
        request = bytes.fromhex(row["request"])
        if method in ("r_bool", "r_anno"):  # to C++ 3.5 [r] [bool] [ok] is a name of three words
            word = method[2:].encode()
            vocab, string = bytes.fromhex("09000000"), bytes.fromhex("0400000004000000")
            request = request.replace(vocab + word, string + word)
        assert port.asked == [request], name
        if isinstance(result, np.ndarray):
            assert found.tolist() == result.tolist() and isinstance(found, np.ndarray)
        elif result is not None or name in ("nothing", "no_result"):
            assert found == result, name


def test_lists_of_lists_come_back(capt: ModuleType) -> None:
    row = CALLS["tcp_r_llist"]
    made, _ = client(capt.Capt, bytes.fromhex(row["reply"]))
    assert [each.tolist() for each in made.r_llist([[1, 2], [], [3]])] == [[1, 2], [], [3]]


def test_a_oneway_call_is_told(capt: ModuleType) -> None:
    made, port = client(capt.Capt)
    assert made.fire(5) is None
    assert port.asked == [bytes.fromhex(CALLS["tcp_fire"]["request"])]


def test_arguments_have_names_and_defaults(capt: ModuleType) -> None:
    made, port = client(capt.Capt, *[bytes.fromhex(CALLS["tcp_tail_defaults"]["reply"])] * 2)
    made.tail_defaults(1)
    made.tail_defaults(first=1, n=5)
    assert port.asked[0] == port.asked[1]
    with pytest.raises(TypeError, match="missing 1 required positional argument: 'b'"):
        made.add(1)


def test_wrong_values_are_named_before_anything_is_sent(capt: ModuleType) -> None:
    made, port = client(capt.Capt)
    with pytest.raises(TypeError, match=r"add\.b: expected an integer, got 'x'"):
        made.add(1, "x")
    with pytest.raises(TypeError, match=r"r_nest\.v\.ps\[0\]\.y: expected an integer, got 1\.5"):
        made.r_nest(capt.Nest(ps=[capt.Point(1, 1.5)]))
    assert not port.asked


def test_a_failure_is_an_error_with_the_reason_where_there_is_one(capt: ModuleType) -> None:
    made, port = client(capt.Capt, FAILED, Bottle(["disk full"]).to_bytes())
    with pytest.raises(RemoteProtocolError, match="the server refuses add: disk full"):
        made.add(1, 2)
    assert Bottle.from_bytes(port.asked[1]) == ["help_failure"]
    made, _ = client(capt.Capt, FAILED, FAILED)  # C++ has no such question
    with pytest.raises(RemoteProtocolError, match="refuses add; its log may say why"):
        made.add(1, 2)
    made, _ = client(capt.Capt, Bottle([Vocab("fail"), "no such joint"]).to_bytes())
    with pytest.raises(RemoteProtocolError, match="refuses add: no such joint"):
        made.add(1, 2)


def test_false_is_no_failure_but_fail_for_a_number_is(capt: ModuleType) -> None:
    methods = capt.Capt._methods
    false = bytes.fromhex("000100000100000009000000 6661696c")
    assert not is_failure(false, methods["r_bool"], text=False)
    assert is_failure(false, methods["add"], text=False)
    assert is_failure(FAILED, methods["r_bool"], text=False)
    assert not is_failure(FAILED, methods["r_bool"], text=True)
    assert not is_failure(b"\0\1\0\0\0\0\0\0", methods["nothing"], text=False)


def test_errors_name_the_method(capt: ModuleType) -> None:
    gone = [LinkClosed("gone"), UnknownName("nobody")]
    made, _ = client(capt.Capt, Timeout("late"), *gone, Bottle(["x"]).to_bytes())
    with pytest.raises(Timeout, match=r"add: no answer within 2\.0 s"):
        made.add(1, 2)
    with pytest.raises(LinkClosed, match="add: gone"):
        made.add(1, 2)
    with pytest.raises(UnknownName, match="add: nobody"):
        made.add(1, 2)
    with pytest.raises(DecodeError, match="the result of add: expected an integer"):
        made.add(1, 2)


def test_versions(capt: ModuleType) -> None:
    answer = bytes.fromhex("00010000010000000000 0300 0c00 0000")
    made, port = client(capt.Capt, answer, FAILED, Bottle([0, 4, 0, 0]).to_bytes())
    port.silent = False
    assert made.remote_version() == (0, 3, 12, 0)
    assert made.remote_version() is None
    assert made.remote_version() == (0, 4, 0, 0)
    assert version(b"rubbish") is None
    assert version(bytes.fromhex("00010000 01000000 01000000 05000400")) is None  # one number


@pytest.mark.parametrize("answer", ["no idea", ["no idea"], [["a", 1]], [], b"blob", True])
def test_peers_that_know_nothing_of_thrift_are_asked_as_yarp_3(answer: Any) -> None:
    module = loads("service Arm { double twice(1: double x) }")
    names = yarpy.LocalNames()
    asked: list[Any] = []

    def handle(message: yarpy.Message) -> Any:
        asked.append(message.value)
        return answer if len(asked) == 1 else [3.0]

    with yarpy.RpcServer("/other", handle, names=names):
        arm = module.Arm.connect("/other", names=names, timeout=HANG)
        assert [arm.twice(1.5), arm.twice(1.5)] == [3.0, 3.0]
        arm.close()
    assert asked[1:] == [["twice", 1.5]] * 2


def test_clients_of_event_loops(capt: ModuleType) -> None:
    class Loop(Port):
        async def ask(self, question: Any, timeout: float | None) -> Any:  # type: ignore[override]
            return Port.ask(self, question, timeout)

        async def tell(self, statement: Any) -> None:  # type: ignore[override]
            Port.tell(self, statement)

        async def open(self) -> None:
            pass

        async def close(self) -> None:  # type: ignore[override]
            pass

    async def run() -> None:
        port = Loop(Bottle([3]).to_bytes(), FAILED, Bottle(["why"]).to_bytes(), Timeout("late"))
        async with client_class(capt.Capt, waits=True)(port, 1.0) as made:
            assert await made.add(1, 2) == 3
            assert await made.fire(1) is None
            with pytest.raises(RemoteProtocolError, match="add: why"):
                await made.add(1, 2)
            with pytest.raises(Timeout, match="add: no answer"):
                await made.add(1, 2)

    asyncio.run(run())


def test_names_that_python_needs() -> None:
    made = loads("service S { i32 close(1: i32 from), void import() }", "s")
    answer = Bottle([3]).to_bytes()
    user, port = client(made.S, answer, b"\0\1\0\0\0\0\0\0")
    assert user.close_(from_=2) == 3 and user.import_() is None
    assert Bottle.from_bytes(port.asked[0]) == ["close", 2]
    assert Bottle.from_bytes(port.asked[1]) == ["import"]
    user.close()
    assert repr(user) == "<client of S>"


# -- YARP 4.0 ----------------------------------------------------------------------------------

VERSION_4 = bytes.fromhex("00010000010000000000 0400 0000 0000")


def test_fractions_for_yarp_4_have_its_tags() -> None:
    module = loads("""
        struct Pair { 1: double min, 2: double max }
        service Four {
          Pair turn(1: double angle, 2: list<double> more, 3: i32 joint);
          double now(); double far(1: i32 joint);
          list<list<double>> grid(1: list<list<double>> grid);
        }
    """)
    pair = bytes.fromhex("00010000 02000000 14000000 000000000000f83f 14000000 0000000000000440")
    made, port = client(module.Four, VERSION_4, pair, pair[:8] + pair[8:])
    port.silent = False
    assert made.turn(1.5, [1.5, 2.5], 3) == module.Pair(1.5, 2.5)
    asked, request = port.asked
    assert b"getRemoteProtocolVersion" in asked
    assert request == bytes.fromhex(
        "00010000 04000000 09000000 7475726e"
        "14000000 000000000000f83f"
        "14010000 02000000 000000000000f83f 0000000000000440"
        "01000000 03000000"
    )
    made.turn(2.5, [], 1)
    assert len(port.asked) == 3  # asked for the version once


def test_a_float32_is_awaited_as_the_server_spells_it() -> None:
    """Which one of YARP 4 would not be seen to end, beside an acknowledgement."""
    module = loads("""
        typedef double ( yarp.type = "yarp::conf::float32_t" ) float32
        service Narrow { float32 now(); }
    """)
    answer = bytes.fromhex("00010000 01000000 0a000000 00005040")
    made, port = client(module.Narrow, VERSION_4, answer, answer)
    port.silent = False
    assert made.now() == 3.25 == made.now()
    assert [b"getRemoteProtocolVersion" in asked for asked in port.asked] == [True, False, False]
    assert port.endings[-1] is not None
    walk = port.endings[-1](1000)
    assert walk.advance(answer + b"YA\0\0\0\0RP") == len(answer) and walk.done
    older, port = client(module.Narrow, bytes.fromhex("00010000 01000000 80000000 00005040"))
    assert older.now() == 3.25 and port.endings == [None]


def test_what_has_no_fractions_asks_for_no_version(capt: ModuleType) -> None:
    made, port = client(capt.Capt, bytes.fromhex("00010000010000000100000003000000"))
    port.silent = False
    assert made.add(1, 2) == 3
    assert len(port.asked) == 1


def test_answers_of_yarp_4_are_read_by_their_tags(capt: ModuleType) -> None:
    answer = bytes.fromhex("00010000 01000000 14000000 0000000000000a40")
    made, _ = client(capt.Capt, answer)
    assert made.r_double(1.0) == 3.25
    floats = bytes.fromhex("00010000 01000000 0a000000 00005040")
    made, _ = client(capt.Capt, floats)
    assert made.r_float32(1.0) == 3.25
    lists = bytes.fromhex("00010000 01000000 14010000 01000000 0000000000000a40")
    made, _ = client(capt.Capt, lists)
    assert made.r_ldouble([1.0]).tolist() == [3.25]
    made, _ = client(capt.Capt, bytes.fromhex("14010000 01000000 0000000000000a40"))
    assert made.r_double(1.0) == 3.25
    made, _ = client(capt.Capt, bytes.fromhex("00010000 01000000 80000000 00005040 01"))
    with pytest.raises(DecodeError, match="bytes are left over"):
        made.r_float32(1.0)


def test_a_client_of_a_service_has_its_methods(capt: ModuleType, server: Any) -> None:
    names = yarpy.LocalNames()
    with (
        yarpy.RpcServer("/capt", server, names=names),
        yarpy.RpcClient[capt.Capt]("/capt", names=names, timeout=HANG) as client,
    ):
        assert client.remote.add(1, 2) == 3
        assert client.call("add", 2, 3) == 5
        assert repr(client).startswith("<RpcClient[Capt] ")
    with (
        yarpy.RpcClient(names=names) as client,
        pytest.raises(TypeError, match="not the client of a service"),
    ):
        _ = client.remote


def test_and_in_an_event_loop(capt: ModuleType, server: Any) -> None:
    names = yarpy.LocalNames()

    async def add() -> object:
        async with aio.RpcClient[capt.Capt]("/capt", names=names, timeout=HANG) as client:
            return await client.remote.add(1, 2)

    with yarpy.RpcServer("/capt", server, names=names):
        assert asyncio.run(add()) == 3
