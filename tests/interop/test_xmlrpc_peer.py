"""Python's own XML-RPC client and server, and ROS's questions, with real ports."""

from __future__ import annotations

import os
import socket
import subprocess
import threading
import time
import xmlrpc.client
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any
from unittest.mock import ANY
from xmlrpc.server import SimpleXMLRPCRequestHandler, SimpleXMLRPCServer

import pytest
from support.peer import program
from support.wait import HANG, wait_until

import yarpy
from yarpy.carriers.base import Limits
from yarpy.carriers.web.xmlrpc import XmlRpc
from yarpy.data.value import Vocab
from yarpy.wire.message import Packet


def proxy(port: yarpy.Port | yarpy.RpcServer, path: str = "/RPC2") -> xmlrpc.client.ServerProxy:
    url = f"http://127.0.0.1:{port.contact.port}{path}"
    return xmlrpc.client.ServerProxy(url, use_builtin_types=True, allow_none=True)


def test_python_calls_a_port() -> None:
    def answer(message: yarpy.Message) -> object:
        return [Vocab("ok"), "echo", message.value]

    with (
        yarpy.RpcServer("/srv", answer, names=yarpy.LocalNames()) as server,
        proxy(server) as remote,
    ):
        for _ in range(3):
            assert remote.move(1, 2.5, "two words", [1, "x"], True, b"\0\1") == [
                "[ok]",
                "echo",
                ["move", 1, 2.5, "two words", [1, "x"], True, b"\0\1"],
            ]
        assert remote.get({"a": 1}) == ["[ok]", "echo", ["get", {"a": 1}]]
        assert len(server.inputs) == 1  # one connection for all
        assert server.inputs[0].source == "rpc"
        with pytest.raises(xmlrpc.client.ProtocolError):
            proxy(server, "/RPC2").big("x" * (17 << 20))
        assert remote.still("there")[1] == "echo"
    wait_until(lambda: not server.inputs)


def test_python_writes_to_a_port_that_says_nothing() -> None:
    """C++ leaves it waiting for ever."""
    with (
        yarpy.BufferedPort("/in", strict=True, names=yarpy.LocalNames()) as port,
        proxy(port) as remote,
    ):
        assert remote.hello(1) == ""
        assert remote.hello(2) == ""
        assert [port.read(timeout=HANG).value for _ in range(2)] == [["hello", 1], ["hello", 2]]


def test_questions_of_ros_nodes() -> None:
    with yarpy.Port("/talker", names=yarpy.LocalNames()) as port:
        for path in ("/", "/RPC2"):
            with proxy(port, path) as remote:
                assert remote.getPid("/rosnode") == [1, "", os.getpid()]
                assert remote.getBusInfo("/rosnode") == [1, "", []]
                assert remote.requestTopic("/rosnode", "/topic", [["TCPROS"]]) == [
                    1,
                    "/talker",
                    ["TCPROS", port.contact.host, port.contact.port],
                ]
                assert remote.publisherUpdate("/master", "/topic", ["http://x:1/"]) == [1, "ok"]


@pytest.mark.peer("curl")
def test_entity_bomb_is_refused_and_the_port_lives() -> None:
    bomb = (
        b'<!DOCTYPE b [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;">]>'
        b"<methodCall><methodName>&b;</methodName></methodCall>"
    )
    with yarpy.RpcServer("/srv", lambda m: ["fine"], names=yarpy.LocalNames()) as server:
        url = f"http://127.0.0.1:{server.contact.port}/RPC2"
        args = [
            program("curl"),
            "-s",
            "-m",
            "10",
            "-H",
            "Content-Type: text/xml",
            "--data-binary",
            "@-",
            url,
        ]
        said = subprocess.run(args, input=bomb, capture_output=True, timeout=HANG).stdout
        with pytest.raises(xmlrpc.client.Fault, match="not XML-RPC"):
            xmlrpc.client.loads(said)
        with proxy(server) as remote:
            assert remote.still() == "fine"


@pytest.mark.peer("curl")
def test_other_posts_still_reach_http() -> None:
    with yarpy.RpcServer("/srv", lambda m: ["fine", m.value], names=yarpy.LocalNames()) as server:
        url = f"http://127.0.0.1:{server.contact.port}/"
        kind = "Content-Type: application/json"
        args = [program("curl"), "-s", "-m", "10", "-H", kind, "-d", '["go", 1]', url]
        said = subprocess.run(args, capture_output=True, timeout=HANG).stdout
        assert b"fine" in said
        assert b"xml" not in said


class Handler(SimpleXMLRPCRequestHandler):
    protocol_version = "HTTP/1.1"  # keeps the connection


@contextmanager
def python_server() -> Iterator[tuple[SimpleXMLRPCServer, list[Any]]]:
    heard: list[Any] = []
    server = SimpleXMLRPCServer(("127.0.0.1", 0), Handler, logRequests=False, allow_none=True)

    def add(*numbers: float) -> float:
        heard.append(numbers)
        return sum(numbers)

    server.register_function(add)
    server.register_function(lambda *a: list(a), "echo")
    server.register_function(lambda: {"a": 1}, "describe")
    thread = threading.Thread(target=server.serve_forever, args=(0.02,), daemon=True)
    thread.start()
    try:
        yield server, heard
    finally:
        server.shutdown()
        server.server_close()
        thread.join(HANG)


def test_port_calls_python() -> None:
    names = yarpy.LocalNames()
    with python_server() as (server, heard):
        names.register("/sum", "xmlrpc", "127.0.0.1", server.server_address[1])
        with yarpy.RpcClient(name="/client", names=names) as client:
            client.connect("/sum", "xmlrpc")
            assert client.ask(["add", 1, 2.5], timeout=HANG).value == [3.5]
            assert client.ask(["echo", 1, "two words", [1, "x", 2]], timeout=HANG).value == [
                *(1, "two words", [1, "x", 2])
            ]
            assert client.ask(["describe"], timeout=HANG).value == ["dict", ["a", 1]]
            fault = client.ask(["nothing"], timeout=HANG).value
            assert fault[0] == "dict"
            assert "not supported" in str(fault)
        with yarpy.Port("/out", names=names) as out:
            out.connect("/sum", "xmlrpc")
            for number in range(5):
                assert out.write(["add", number, 1], wait=True) == 1
        assert heard == [(1, 2.5), *((number, 1) for number in range(5))]


class Silent:
    """A server that reads calls and responds to none, as a C++ port whose reader does not reply;
    `respond` sends what it owes."""

    OK = xmlrpc.client.dumps(("",), methodresponse=True).encode()

    def __init__(self) -> None:
        self.heard = 0
        self.owed = 0
        self.lock = threading.Lock()
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.line: socket.socket | None = None
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Wake the thread, which waits for the next one, and let it end."""
        self.listener.shutdown(socket.SHUT_RDWR)
        self._thread.join(HANG)
        self.listener.close()

    def _run(self) -> None:
        while True:
            try:
                self.line, _ = self.listener.accept()
            except OSError:
                return
            while data := self.line.recv(1 << 16):
                with self.lock:
                    self.heard += data.count(b"</methodCall>")
                    self.owed += data.count(b"</methodCall>")
            self.line.close()

    def respond(self) -> None:
        with self.lock:
            head = b"HTTP/1.1 200 OK\r\nContent-Length: %d\r\n\r\n" % len(self.OK)
            assert self.line is not None
            self.line.sendall((head + self.OK) * self.owed)
            self.owed = 0


def test_reader_that_does_not_respond(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """The second message waited for the first one's response for ever."""
    monkeypatch.setattr(XmlRpc, "limits", Limits(ack_timeout=0.05))
    names, server = yarpy.LocalNames(), Silent()
    names.register("/mute", "xmlrpc", *server.listener.getsockname())
    with yarpy.Port("/out", names=names) as out:
        out.connect("/mute", "xmlrpc")
        for number in range(10):
            assert out.write(["add", number]) == 1
        wait_until(lambda: server.heard == 10)
        assert caplog.text.count('"/mute" does not respond') == 1
        with pytest.raises(yarpy.Timeout):
            out._hub.outputs.links[0].call(Packet(["add", 1], key="d"), time.monotonic() + 0.05)
        wait_until(lambda: out.stats.past.outputs.unconfirmed)
        assert out.stats.past.outputs.as_dict() == {
            "messages": 0, "bytes": ANY, "drops": 0, "replaced": 0, "unconfirmed": 10,
        }  # fmt: skip
    server.close()


def test_reader_that_responds_again_is_waited_for_again(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(XmlRpc, "limits", Limits(ack_timeout=0.05))
    names, server = yarpy.LocalNames(), Silent()
    names.register("/slow", "xmlrpc", *server.listener.getsockname())
    with yarpy.Port("/out", names=names) as out:
        out.connect("/slow", "xmlrpc")
        for number in range(3):
            out.write(["add", number])
        wait_until(lambda: server.heard == 3)
        server.respond()
        wait_until(lambda: not out.outputs[0].stats.unacknowledged)
        for number in range(2):
            out.write(["add", number])
        assert caplog.text.count('"/slow" does not respond') == 2
    server.close()


def test_buffered_writer_goes_on_as_well(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(XmlRpc, "limits", Limits(ack_timeout=0.05))
    names, server = yarpy.LocalNames(), Silent()
    names.register("/mute", "xmlrpc", *server.listener.getsockname())
    with yarpy.BufferedPort("/out", names=names) as out:
        out.connect("/mute", "xmlrpc")

        def arrived() -> bool:
            out.write(["add", 1])
            return server.heard >= 5

        wait_until(arrived)
    server.close()
