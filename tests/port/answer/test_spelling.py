"""Answers are spelled as who asks spells, else as the name server says."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator

import pytest
from support.wait import HANG
from support.yarp4 import administer_as_yarp4

import yarpy.aio
from yarpy.data.bottle import Bottle
from yarpy.data.yarp4 import to_yarp4
from yarpy.names.base import NameClient
from yarpy.nameserver.local import LocalNames
from yarpy.nameserver.server import NameServer
from yarpy.port.answer import spelling
from yarpy.port.connect import probe
from yarpy.port.rpc import RpcClient, RpcServer
from yarpy.wire.message import Encoded

OLD = bytes(Bottle([0.5, [1.5, 2.5], "word"]).to_bytes())
NEW = bytes(to_yarp4(OLD))
SILENT = Bottle(["which"])  # it does not tell


@pytest.fixture
def network(monkeypatch: pytest.MonkeyPatch) -> Iterator[NameClient]:
    monkeypatch.setattr(spelling, "_known", {})
    monkeypatch.setattr(spelling, "_silent", {})
    with NameServer() as server:
        yield server.client


def answer_to(client: RpcClient, question: object) -> bytes:
    reply = client.ask(question, timeout=HANG)
    assert reply is not None
    return bytes(reply.to_bytes())


@pytest.mark.parametrize("carrier", ["tcp", "fast_tcp", "unix_stream"])
def test_as_the_question(carrier: str, names: LocalNames) -> None:
    with (
        RpcServer("/server", lambda message: Bottle([0.5, [1.5, 2.5], "word"]), names=names),
        RpcClient("/server", carrier=carrier, names=names) as new,
        RpcClient("/server", carrier=carrier, names=names) as old,
    ):
        assert answer_to(new, Encoded(NEW)) == answer_to(new, SILENT) == NEW
        assert answer_to(old, Encoded(OLD)) == answer_to(old, SILENT) == OLD


def test_as_a_later_question(names: LocalNames) -> None:
    """Whose value the program looks at; to it both are the same."""

    def answer(message: yarpy.Message) -> list[object]:
        message.as_(Bottle) if asked else message.value
        asked.append(message.value)
        return Bottle([0.5, [1.5, 2.5], "word"])

    asked: list[object] = []
    for _ in range(2):
        with (
            RpcServer("/server", answer, names=names),
            RpcClient("/server", carrier="tcp", names=names) as client,
        ):
            assert answer_to(client, SILENT) == OLD
            assert answer_to(client, Encoded(NEW)) == answer_to(client, SILENT) == NEW
    assert asked[1] == [0.5, [1.5, 2.5], "word"]


def test_in_an_event_loop(names: LocalNames) -> None:
    async def serve() -> list[bytes]:
        async with yarpy.aio.Port("/server", names=names) as server:
            with RpcClient("/server", carrier="tcp", names=names) as client:
                replies = []
                for question in (Encoded(NEW), SILENT):
                    asking = asyncio.create_task(asyncio.to_thread(answer_to, client, question))
                    message = await server.read(HANG)
                    assert message.value
                    message.reply(Encoded(OLD))
                    replies.append(await asking)
                return replies

    assert asyncio.run(serve()) == [NEW, NEW]


def test_as_the_name_server(network: NameClient, monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as patch:
        administer_as_yarp4(patch)
        assert spelling.is_yarp4(network, "/who") is True
    with (
        RpcServer("/server", lambda message: Encoded(OLD), names=network),
        RpcClient("/server", carrier="tcp", names=network) as new,
        RpcClient("/server", carrier="tcp", names=network) as old,
    ):
        assert answer_to(new, SILENT) == answer_to(new, Encoded(NEW)) == NEW
        assert answer_to(old, SILENT) == NEW
        assert answer_to(old, Encoded(OLD)) == answer_to(old, SILENT) == OLD
    monkeypatch.setattr(probe, "introduce", lambda *given: pytest.fail("it was asked before"))
    assert spelling.is_yarp4(network, "/who") is True


def test_a_name_server_of_yarpy_is_none_of_yarp_4(network: NameClient) -> None:
    assert spelling.is_yarp4(network, "/who") is False
    with (
        RpcServer("/server", lambda message: Encoded(OLD), names=network),
        RpcClient("/server", carrier="tcp", names=network) as client,
    ):
        assert answer_to(client, SILENT) == OLD


def test_as_the_name_server_knows_who_asks(network: NameClient) -> None:
    with (
        RpcServer("/server", lambda message: Encoded(OLD), names=network),
        RpcClient("/server", name="/new", carrier="tcp", names=network) as new,
        RpcClient("/server", name="/old", carrier="tcp", names=network) as old,
    ):
        network.set("/new", spelling.PROPERTY, spelling.YARP4)
        assert answer_to(new, SILENT) == NEW
        assert answer_to(old, SILENT) == OLD
        assert answer_to(new, Encoded(OLD)) == answer_to(new, SILENT) == OLD


def test_a_name_server_that_is_silent_is_left_alone_for_a_while(
    network: NameClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[str] = []

    def get(name: str, key: str) -> list[str]:
        asked.append(name)
        raise yarpy.Timeout("it is silent")

    monkeypatch.setattr(network, "get", get)
    for _ in range(3):
        assert not spelling.is_yarp4(network, "/who")
    assert asked == ["/who"]
    monkeypatch.setattr(spelling, "_silent", {})
    assert not spelling.is_yarp4(network, "admin")  # which is no name
    assert asked == ["/who"]


def test_a_name_server_that_is_gone(network: NameClient, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*given: object) -> None:
        raise yarpy.LinkClosed("nobody listens")

    monkeypatch.setattr(probe, "introduce", refuse)
    assert spelling.is_yarp4(network, "/who") is spelling.is_yarp4(LocalNames(), "/who") is False
