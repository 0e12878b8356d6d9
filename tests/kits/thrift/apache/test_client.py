"""A client's calls are those of Apache's library, and its answers are read."""

import pytest
from support.thrift_module import ROWS, SPELLINGS, apache, body, data, everything, returned

from yarpy.errors import DecodeError
from yarpy.kits.thrift.apache import client
from yarpy.kits.thrift.apache.message import Returned
from yarpy.kits.thrift.apache.protocol import REPLY, Fault, Head


@pytest.mark.parametrize("spelling", SPELLINGS)
@pytest.mark.parametrize(
    ("name", "values"),
    [("add", (1, -2)), ("true", (True,)), ("nothing", ()), ("fire", ("x",)), ("echo", None)],
)
def test_questions(name: str, spelling: str, values: tuple[object, ...] | None) -> None:
    method = apache().Test._methods[ROWS[name]["method"]]
    asked = client.question(spelling, method, (everything(),) if values is None else values)
    assert asked.body == data(name, spelling)[body(name, spelling) :]
    assert (asked.kind, asked.name) == (ROWS[name]["kind"], ROWS[name]["method"])
    with pytest.raises(TypeError, match=r"add.a: expected an integer, got 'x'"):
        client.question(spelling, apache().Test._methods["add"], ("x", 1))


@pytest.mark.parametrize("spelling", SPELLINGS)
def test_answers(spelling: str) -> None:
    methods = apache().Test._methods
    assert client.result(methods["echo"], returned("echoed", spelling)) == everything()
    assert client.result(methods["add"], returned("added", spelling)) == -1
    assert client.result(methods["is_on"], returned("false", spelling)) is False
    assert client.result(methods["nothing"], returned("done", spelling)) is None
    with pytest.raises(apache().Bad) as bad:
        client.result(methods["fail"], returned("bad", spelling))
    assert (bad.value.code, str(bad.value)) == (5, "bad")
    with pytest.raises(apache().Worse, match=r"Worse\(why='worse'\)"):
        client.result(methods["fail"], returned("worse", spelling))
    message = returned("unknown", spelling)
    message.head = Head(3, "add", 1)
    with pytest.raises(Fault, match="the server refuses add: no method") as fault:
        client.result(methods["add"], message)
    assert fault.value.kind == 1


def test_answers_that_are_none() -> None:
    method = apache().Test._methods["add"]
    with pytest.raises(Fault, match="it gives no result"):
        client.result(method, Returned("binary", Head(REPLY, "add", 1), b"\0", 0))
    with pytest.raises(Fault, match="gives no answer"):
        client.result(method, None)
    with pytest.raises(DecodeError, match="an answer to 'sub', where add was asked"):
        client.result(method, Returned("binary", Head(REPLY, "sub", 1), b"\0", 0))


@pytest.mark.parametrize(
    ("target", "carrier", "spelling"),
    [
        ("thrift://127.0.0.1:9090", "", "binary"),
        ("thrift+compact+framed://127.0.0.1:9090", "", "compact"),
        ("/thrift+framed://127.0.0.1:9090", "", "binary"),
        ("/cam/rpc", "thrift+compact", "compact"),
        ("/cam/rpc", "", ""),
        ("tcp://127.0.0.1:9090", "", ""),
        ("thrifty://127.0.0.1:9090", "", ""),
    ],
)
def test_what_is_spoken_to_whom(target: str, carrier: str, spelling: str) -> None:
    assert client.spelling(target, carrier) == spelling
