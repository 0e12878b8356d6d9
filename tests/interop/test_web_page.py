"""WebSockets to real ports, with wsproto's client in the place of a browser."""

from __future__ import annotations

import json
import socket
import time
from collections.abc import Iterator
from contextlib import contextmanager

import pytest
from support.wait import HANG, wait_until
from wsproto import ConnectionType, WSConnection
from wsproto.events import AcceptConnection, CloseConnection, Event, Ping, Pong, Request
from wsproto.events import BytesMessage as Bytes
from wsproto.events import TextMessage as Text

import yarpy
from yarpy import network
from yarpy.data.bottle import Bottle


class Page:
    """A WebSocket as a page has it."""

    def __init__(self, port: yarpy.Port, options: str = "", *protocols: str) -> None:
        where = port.contact.host, port.contact.port
        self.sock = socket.create_connection(where, HANG)
        self.ws = WSConnection(ConnectionType.CLIENT)
        host, target = port.contact.address, f"/?ws{options}"
        self.say(Request(host=host, target=target, subprotocols=list(protocols)))
        assert isinstance(self.hear(), AcceptConnection)

    def say(self, event: Event) -> None:
        self.sock.sendall(self.ws.send(event))

    def hear(self) -> Event:
        while True:
            for event in self.ws.events():
                return event
            data = self.sock.recv(1 << 16)
            self.ws.receive_data(data or None)

    def text(self) -> object:
        """The next whole message in JSON."""
        found = ""
        while True:
            event = self.hear()
            assert isinstance(event, Text), event
            found += event.data
            if event.message_finished:
                return json.loads(found)

    def bytes(self) -> bytes:
        """The next frame."""
        found = b""
        while True:
            event = self.hear()
            assert isinstance(event, Bytes), event
            found += bytes(event.data)
            if event.message_finished:
                return found


@contextmanager
def page(port: yarpy.Port, options: str = "", *protocols: str) -> Iterator[Page]:
    found = Page(port, options, *protocols)
    try:
        yield found
    finally:
        found.sock.close()


def echo(message: yarpy.Message) -> object:
    return ["echo", message.value]


def test_questions_in_json() -> None:
    with (
        yarpy.RpcServer("/echo", echo, names=yarpy.LocalNames()) as server,
        page(server, "", "yarp.json") as web,
    ):
        for number in range(20):
            web.say(Text(json.dumps([number, "two words", [2.5]])))
            assert web.text() == ["echo", [number, "two words", [2.5]]]
        web.say(Text("no json"))
        assert web.text()[0] == "fail"
        web.say(Ping(b"hello"))
        assert web.hear() == Pong(b"hello")
        web.say(Text("[1]"))
        assert web.text() == ["echo", [1]]
        web.say(CloseConnection(code=1000))
        assert isinstance(web.hear(), CloseConnection)
        assert web.sock.recv(10) == b""
        wait_until(lambda: not server.inputs)


@pytest.mark.parametrize("protocols", [(), ("yarp.json",)], ids=["binary", "json"])
def test_many_messages_in_one_segment(protocols: tuple[str, ...]) -> None:
    with (
        yarpy.BufferedPort("/in", strict=True, names=yarpy.LocalNames()) as port,
        page(port, "", *protocols) as web,
    ):
        data = b""
        for number in range(100):
            command = bytes.fromhex("00 00 00 00 7e 44 00 01")
            binary = Bytes(command + Bottle([number]).to_bytes())
            data += web.ws.send(Text(f"[{number}]") if protocols else binary)
        web.sock.sendall(data)
        found = [port.read(timeout=HANG) for _ in range(100)]
        assert [message.value for message in found if message] == [[n] for n in range(100)]


def test_administration_in_json() -> None:
    with (
        yarpy.Port("/p", names=yarpy.LocalNames()) as port,
        page(port, "&admin", "yarp.json") as web,
    ):
        web.say(Text('["ver"]'))
        assert web.text() == ["ver", 1, 2, 3]


def test_questions_in_binary() -> None:
    with (
        yarpy.RpcServer("/echo", echo, names=yarpy.LocalNames()) as server,
        page(server) as web,
    ):
        web.say(Bytes(bytes.fromhex("00 00 00 00 7e 64 00 01") + Bottle([5]).to_bytes()))
        assert Bottle.from_bytes(web.bytes()) == ["echo", [5]]


def test_reading_in_both_ways() -> None:
    with (
        yarpy.Port("/out", names=yarpy.LocalNames()) as port,
        page(port, "&read&envelope", "yarp.json") as web,
        page(port) as binary,
    ):
        binary.say(Bytes(bytes.fromhex("00 00 00 00 7e 72 00 01")))
        wait_until(lambda: len(port.outputs) == 2)
        assert {link.target for link in port.outputs} == {"web"}
        port.write([1, "x"], yarpy.Stamp(7, 1.5))
        assert web.text() == {"envelope": "7 1.5", "data": [1, "x"]}
        assert binary.bytes().endswith(b"D 7 1.5\0")
        assert Bottle.from_bytes(binary.bytes()) == [1, "x"]


def test_reader_is_answered_and_may_leave() -> None:
    with (
        yarpy.Port("/out", names=yarpy.LocalNames()) as port,
        page(port, "&read", "yarp.json") as web,
    ):
        wait_until(lambda: port.outputs)
        for number in range(3):
            port.write([number])
            assert web.text() == [number]
        web.say(Ping(b"x"))
        assert web.hear() == Pong(b"x")
        web.say(CloseConnection(code=1001))
        assert isinstance(web.hear(), CloseConnection)
        wait_until(lambda: not port.outputs)
        assert web.sock.recv(10) == b""


def test_port_that_closes_says_so() -> None:
    with yarpy.Port("/out", names=yarpy.LocalNames()) as port:
        web = Page(port, "&read", "yarp.json")
        wait_until(lambda: port.outputs)
    assert isinstance(web.hear(), CloseConnection)
    web.sock.close()


@pytest.mark.parametrize("protocols", [(), ("yarp.json",)], ids=["binary", "json"])
def test_page_that_does_not_read_costs_its_port_nothing(protocols: tuple[str, ...]) -> None:
    with (
        yarpy.Port("/out", names=yarpy.LocalNames()) as port,
        page(port, "&read", *protocols),
    ):
        wait_until(lambda: port.outputs)
        longest = 0.0
        value = ["x" * 100_000]
        for _ in range(300):
            started = time.perf_counter()
            port.write(value)
            longest = max(longest, time.perf_counter() - started)
        assert longest < 5
        assert port.outputs[0].stats.replaced > 50


def test_between_two_ports() -> None:
    names = yarpy.LocalNames()
    with (
        yarpy.Port("/out", names=names) as out,
        yarpy.BufferedPort("/in", strict=True, names=names) as in_,
    ):
        network.connect("/out", "/in", "websocket", names=names)
        for number in range(50):
            out.write([number, bytes(number * 1000)])
        for number in range(50):
            message = in_.read(timeout=HANG)
            assert message is not None
            assert message.value == [number, bytes(number * 1000)]
        assert network.disconnect("/out", "/in", names=names)
        wait_until(lambda: not in_.inputs)
