"""What a service answers to the calls that Apache's library was recorded to make."""

import asyncio
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest
from support.thrift_module import SPELLINGS, apache, body, call, data, service
from support.wait import HANG

from yarpy.kits.thrift.apache import client
from yarpy.kits.thrift.apache.message import NOTHING, Answer, Call, Returned, fault_of
from yarpy.kits.thrift.apache.protocol import CALL, EXCEPTION, REPLY, Head

ANSWERS = {"echo": "echoed", "add": "added", "true": "false", "nothing": "done"}


@pytest.mark.parametrize("spelling", SPELLINGS)
@pytest.mark.parametrize("name", ANSWERS)
def test_the_answers_are_those_of_apache(name: str, spelling: str) -> None:
    found = service()(call(name, spelling))
    other = ANSWERS[name]
    assert found.kind == REPLY and found.body == data(other, spelling)[body(other, spelling) :]


def ask(server: Any, spelling: str, name: str, *values: Any) -> Any:
    """The answer to a call, as its client has it."""
    method = apache().Test._methods[name]
    asked = client.question(spelling, method, values)
    found = server(Call(spelling, Head(CALL, name, 1), asked.body, 0))
    return method, found


@pytest.mark.parametrize("spelling", SPELLINGS)
@pytest.mark.parametrize(("how", "name"), [(1, "bad"), (2, "worse")])
def test_declared_exceptions_are_results(spelling: str, how: int, name: str) -> None:
    _, found = ask(service(), spelling, "fail", how)
    assert (found.kind, found.body) == (REPLY, data(name, spelling)[body(name, spelling) :])


@pytest.mark.parametrize("spelling", SPELLINGS)
@pytest.mark.parametrize(
    ("name", "value", "kind", "text"),
    [
        ("fail", 3, 6, "no"),
        ("fail", 4, 6, "ValueError: oops"),
        ("fail", 5, 1, "Server does not have this method"),
        ("fail", 6, 6, "SystemExit: leaving"),
        ("missing", None, 5, "missing has no result"),
    ],
)
def test_other_exceptions_are_faults(
    spelling: str, name: str, value: int | None, kind: int, text: str
) -> None:
    values = [] if value is None else [value]
    with ThreadPoolExecutor(1) as threads:  # as at a port: sys.exit() in a main thread goes on
        _, found = threads.submit(ask, service(), spelling, name, *values).result(HANG)
    fault = fault_of(Returned(spelling, Head(EXCEPTION, name, 1), found.body, 0))
    assert (found.kind, fault.kind) == (EXCEPTION, kind) and text in fault.text


@pytest.mark.parametrize("spelling", SPELLINGS)
def test_arguments_that_are_not_there_have_their_defaults(spelling: str) -> None:
    found = service()(call("defaults", spelling))
    method = apache().Test._methods["add"]
    message = Returned(spelling, Head(REPLY, "add", 2), found.body, 0)
    assert client.result(method, message) == 11
    found = service()(Call(spelling, Head(CALL, "add", 2), b"\0", 0))
    assert client.result(method, Returned(spelling, Head(REPLY, "add", 2), found.body, 0)) == 10


@pytest.mark.parametrize("spelling", SPELLINGS)
def test_what_is_no_call_of_the_service(spelling: str) -> None:
    server = service()
    found = server(Call(spelling, Head(CALL, "what", 1), b"\0", 0))
    fault = fault_of(Returned(spelling, Head(EXCEPTION, "what", 1), found.body, 0))
    assert (fault.kind, fault.text) == (1, 'no method "what" in Server')
    found = server(Call(spelling, Head(CALL, "add", 1), b"\x05", 0))
    fault = fault_of(Returned(spelling, Head(EXCEPTION, "add", 1), found.body, 0))
    assert fault.kind == 7


@pytest.mark.parametrize("spelling", SPELLINGS)
def test_a_oneway_call_is_not_answered(spelling: str) -> None:
    server = service()
    assert server(call("fire", spelling)) is NOTHING and server.fired == ["x"]
    as_a_call = call("fire", spelling)
    as_a_call.head = Head(CALL, "fire", 3)  # as thriftpy2 does
    assert server(as_a_call) is NOTHING


def test_coroutine_functions() -> None:
    m = apache()

    class Server(m.Test):  # type: ignore[misc, name-defined]
        async def add(self, a: int, b: int) -> int:
            return a + b

        async def fail(self, how: int) -> str:
            raise m.Bad(5, "bad")

    async def main() -> None:
        found = await Server()(call("add", "binary"))
        assert isinstance(found, Answer)
        assert found.body == data("added", "binary")[body("added", "binary") :]
        found = await ask(Server(), "binary", "fail", 1)[1]
        assert found.body == data("bad", "binary")[body("bad", "binary") :]

    asyncio.run(main())


def test_loggers_read_what_it_would_be_on_the_wire_of_yarp() -> None:
    asked = call("add", "compact")
    answer = service()(asked)
    assert asked.value == ["add", 1, -2] and b"".join(answer.to_wire())[-4:] == b"\xff" * 4
