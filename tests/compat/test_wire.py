"""Wire: a service that answers a port; answers for a writer; names and carriers of a program."""

import threading
from collections.abc import Iterator
from typing import Any

import pytest
from support.wait import HANG

import yarp
import yarpy
from yarpy.registry import carriers


class Doubler(yarp.Wire):
    def read(self, reader: Any) -> bool:
        question, answer = yarp.Bottle(), yarp.Bottle()
        if not question.read(reader):
            return False
        answer.addInt32(2 * question.get(0).asInt32())
        writer = reader.getWriter()
        if writer is not None:
            answer.write(writer)
        return True


@pytest.fixture
def local() -> Iterator[None]:
    yarp.Network.setLocalMode(True)
    yield
    yarp.Network.setLocalMode(False)


@pytest.fixture
def ports(local: None) -> Iterator[tuple[yarp.Port, yarp.Port]]:
    server, client = yarp.Port(), yarp.Port()
    assert server.open("/server") and client.open("/client")
    assert yarp.Network.connect("/client", "/server")
    yield server, client
    client.close()
    server.close()


def test_a_service_at_a_port(ports: tuple[yarp.Port, yarp.Port]) -> None:
    service, caller = Doubler(), yarp.Wire()
    assert not service.yarp().isValid()
    assert service.yarp().attachAsServer(ports[0]) and caller.yarp().attachAsClient(ports[1])
    assert service.yarp().isValid() and service.yarp().canRead() and not service.yarp().canWrite()
    assert caller.yarp().canWrite() and not caller.yarp().canRead()
    answer = yarp.Bottle()
    assert caller.yarp().write(yarp.Bottle("21"), answer) and answer.get(0).asInt32() == 42
    assert caller.yarp().setStreamingMode(True)
    untouched = yarp.Bottle("7")
    assert not caller.yarp().write(yarp.Bottle("1"), untouched)
    assert untouched.get(0).asInt32() == 7


def test_a_service_of_the_same_program() -> None:
    link, got = yarp.WireLink(), yarp.Bottle()
    answer = yarp.Bottle()
    assert not link.write(yarp.Bottle("1")) and not link.write(yarp.Bottle("1"), answer)
    assert not link.attachAsServer(object())
    assert link.attachAsClient(got) and link.canWrite()
    assert link.write(yarp.Bottle("1 2")) and got.toString() == "1 2"


def test_messages_that_come_later() -> None:
    came: list[str] = []
    done = threading.Event()

    class Reader(yarp.PortReader):
        def read(self, reader: Any) -> bool:
            found = yarp.Bottle()
            found.read(reader)
            came.append(found.toString())
            if len(came) == 1:
                raise ValueError("of a test")
            if len(came) == 3:
                done.set()
            return True

    link, reader = yarp.WireLink(), Reader()
    assert link.callback(yarp.Bottle("1"), reader)
    assert link.callback(yarp.Bottle("2 3"), reader, "tag")
    assert link.callback(yarp.Bottle("4"), reader)
    assert done.wait(HANG)
    assert came == ["1", "tag 2 3", "4"]


def test_a_writer_that_wants_an_answer(ports: tuple[yarp.Port, yarp.Port]) -> None:
    class Question(yarp.Portable):
        def __init__(self) -> None:
            self.answer = yarp.Bottle()

        def write(self, writer: yarp.ConnectionWriter) -> bool:
            writer.setReplyHandler(self.answer)
            return yarp.Bottle("4").write(writer)

    service = Doubler()
    service.yarp().attachAsServer(ports[0])
    question = Question()
    assert ports[1].write(question) and question.answer.get(0).asInt32() == 8
    asker = yarp.RpcClient()
    try:
        assert asker.open("/asker") and yarp.Network.connect("/asker", "/server")
        other = Question()
        assert asker.write(other) and other.answer.get(0).asInt32() == 8
    finally:
        asker.close()


def test_names_of_a_program(local: None) -> None:
    class Store(yarp.NameStore):
        def query(self, name: str) -> yarp.Contact:
            if name == "/elsewhere":
                return yarp.Contact("/elsewhere", "tcp", "10.0.0.7", 1234)
            return yarp.Contact()

    port = yarp.Port()
    try:
        assert port.open("/here")
        yarp.Network.queryBypass(Store())
        found = yarp.Network.queryName("/elsewhere")
        assert (found.getHost(), found.getPort()) == ("10.0.0.7", 1234)
        assert not yarp.Network.queryName("/here").isValid()
        registered = yarp.Port()
        assert registered.open("/later")
        registered.close()
        yarp.Network.queryBypass(None)
        assert yarp.Network.queryName("/here").isValid()
    finally:
        yarp.Network.queryBypass(None)
        port.close()
    store = yarp.NameStore()
    assert not store.announce("/here", 1) and not store.process(None, None, yarp.Contact())
    with pytest.raises(NotImplementedError, match="has to define query"):
        store.query("/here")


def test_a_carrier_of_a_program() -> None:
    try:
        assert yarp.Network.registerCarrier("mine", "yarpy.carriers.own.tcp:FastTcp")
        assert carriers.load("mine") is yarpy.registry.carriers.load("fast_tcp")
    finally:
        carriers.remove("mine")
    assert not yarp.Network.registerCarrier("mine", "yarpy.carriers.own.tcp:Nothing")
    assert not yarp.Network.registerCarrier("mine", "no_package_of_that_name:Carrier")
    assert not yarp.Network.registerCarrier("mine", "yarpy.errors:YarpError")
    assert "mine" not in carriers.names()
