"""Calls of Apache's library in the body of a POST."""

from http.client import HTTPConnection

import pytest
from support.thrift_module import SPELLINGS, data, head, service
from support.wait import HANG

import yarpy
from yarpy.errors import DecodeError
from yarpy.kits.thrift.apache.body import KIND, Body
from yarpy.wire.message import Malformed

ANSWERS = {"echo": "echoed", "add": "added", "true": "false", "nothing": "done"}


@pytest.mark.parametrize("spelling", SPELLINGS)
@pytest.mark.parametrize("name", ANSWERS)
def test_the_answers_are_those_of_apache(name: str, spelling: str) -> None:
    body = Body(data(name, spelling))
    assert body.message.head == head(name)
    assert body.reply(service()(body.message)) == data(ANSWERS[name], spelling)


@pytest.mark.parametrize("spelling", SPELLINGS)
def test_what_has_no_answer(spelling: str) -> None:
    body = Body(data("fire", spelling))
    assert body.reply(service()(body.message)) == b"" == body.reply(None)
    body = Body(data("add", spelling))
    assert b"there is no service of Thrift at this port" in body.reply(None)
    assert b"at this port: why" in body.reply(Malformed("why"))


@pytest.mark.parametrize("found", [b"", b"{}", b"\x80\x01\0\1", data("added", "binary")])
def test_what_is_no_call(found: bytes) -> None:
    with pytest.raises(DecodeError):
        Body(found)


def post(address: str, path: str, body: bytes, kind: str = KIND) -> tuple[int, str | None, bytes]:
    """The status, the kind and the body of the response."""
    connection = HTTPConnection(address, timeout=HANG)
    try:
        connection.request("POST", path, body, {"Content-Type": kind})
        found = connection.getresponse()
        return found.status, found.getheader("Content-Type"), found.read()
    finally:
        connection.close()


@pytest.mark.parametrize("spelling", SPELLINGS)
@pytest.mark.parametrize("path", ["/", "/thrift", "/form"])
def test_a_port_answers_posts(path: str, spelling: str) -> None:
    handler = service()
    with yarpy.RpcServer("/thrift", handler, names=yarpy.LocalNames()) as server:
        found = post(server.address, path, data("add", spelling))
        assert found == (200, KIND, data("added", spelling))
        assert post(server.address, path, data("fire", spelling)) == (200, KIND, b"")
        assert handler.fired == ["x"]
        assert post(server.address, path, b"{}")[0] == 400
        assert post(server.address, "/", b"x", "application/x-other")[0] == 415


def test_a_port_without_a_service_says_so() -> None:
    with yarpy.RpcServer("/plain", lambda message: message.value, names=yarpy.LocalNames()) as port:
        status, kind, found = post(port.address, "/", data("add", "binary"))
    assert (status, kind) == (200, KIND) and b"there is no service of Thrift" in found
