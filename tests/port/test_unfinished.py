"""Peers that begin something and do not end it: every carrier lets them go, and the port goes on.

Rules: each row says how a connection begins; then its peer is silent, or sends a byte now and then.
The limits are shortened, so that nothing here waits for long.
"""

from __future__ import annotations

import socket
import time
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

import pytest
from support.tls import prepare
from support.wait import HANG, wait_until

from yarpy.carriers.web import xmlrpc
from yarpy.carriers.web.http import exchange as http
from yarpy.link.begin import handshake
from yarpy.link.begin.greeting import driver_of
from yarpy.link.begin.handshake import greet
from yarpy.link.driver import Driver
from yarpy.nameserver.local import LocalNames
from yarpy.port.port import Port
from yarpy.registry import carriers
from yarpy.route import Route
from yarpy.transports.socket_transport import SocketTransport
from yarpy.wire import framing
from yarpy.wire.message import Packet

SHORT = 0.2  # seconds in place of 30, and of what a request and a greeting may take
PAUSE = 0.02  # between two bytes of a peer that trickles
BIG = 1 << 24

HEADER = b"".join(map(bytes, framing.encode(Packet(b"\0" * BIG))))[:54]
TEXT = b"Host: 127.0.0.1\r\nContent-Type: text/xml\r\nContent-Length: 1000\r\n\r\n<?xml"
SOCKETS = (
    b"GET /?ws HTTP/1.1\r\nHost: 127.0.0.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
    b"Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Version: 13\r\n"
)

# What a peer says in the clear before it stops.
RAW = {
    "tcp greeting": framing.number(7777 + 131) + b"\x40\0\0\0/slow",
    "text greeting": b"CONNECT /slow",
    "http head": b"GET / HTTP/1.1\r\nHost:",
    "http body": b"POST /form HTTP/1.1\r\n" + TEXT,
    "http second head": b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\nGET /",
    "xmlrpc head": b"POST /RPC2 HTTP/1.1\r\nHost:",
    "xmlrpc body": b"POST /RPC2 HTTP/1.1\r\n" + TEXT,
    "mjpeg head": b"GET /?action=stream HTTP/1.1\r\nHost:",
    "websocket head": SOCKETS,
    "websocket frame": SOCKETS + b"\r\n\x82\xff\0\0\0\0\1\0\0\0\0\0\0\0abc",
    "websocket json": SOCKETS
    + b"Sec-WebSocket-Protocol: yarp.json\r\n\r\n\x01\xff\0\0\0\0\1\0\0\0",
    "name_ser line": b"NAME_SERVER lis",
    "tls handshake": b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03",
}
# What it says once it is connected with a carrier.
GREETED = {
    "tcp": HEADER,
    "fast_tcp": HEADER,
    "tcp payload": HEADER + b"x" * 100_000,
    "text": b"d\r\n(1 2 ",
    "text command": b"/a",
    "text_ack": b"d\r\n(1 2 ",
    "unix_stream": b"\0\0\0\0~D\0\1" + HEADER[-8:],
    "websocket": b"\x82\xfe\1\0\0\0\0\0\0\0\0\0~",
    "tls": HEADER,
}


@pytest.fixture(autouse=True)
def _short(monkeypatch: pytest.MonkeyPatch) -> None:
    for kind in carriers:
        if kind.limits.message_timeout is not None:
            limits = replace(kind.limits, message_timeout=SHORT)
            monkeypatch.setattr(kind, "limits", limits)
    monkeypatch.setattr(http, "TIME", SHORT)
    monkeypatch.setattr(xmlrpc, "TIME", SHORT)


def dialled(port: Port, what: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Driver:
    """A connection in the middle of something."""
    if what in RAW:
        monkeypatch.setattr(handshake, "TIMEOUT", SHORT)  # not for those that do greet
        if "tls" in what:
            prepare(tmp_path, monkeypatch)
        sock = socket.create_connection(("127.0.0.1", port.contact.port), HANG)
        driver, said = driver_of(SocketTransport(sock)), RAW[what]
    else:
        name, said = what.split()[0], GREETED[what]
        if name == "tls":
            prepare(tmp_path, monkeypatch)
        driver, _ = greet(port.contact, Route("/slow", "/port", name), timeout=HANG)
    driver.transport.send([said])
    return driver


def is_ended(driver: Driver) -> bool:
    """Whether the other side has hung up; what it said before is swallowed."""
    store = memoryview(bytearray(1 << 16))
    try:
        while (count := driver.transport.try_recv_into(store)) > 0:
            pass
    except OSError:
        return True
    return count == 0


@pytest.mark.parametrize("trickles", [False, True], ids=["silent", "trickles"])
@pytest.mark.parametrize("what", [*RAW, *GREETED])
def test_message_that_does_not_come_along_ends_its_connection(
    what: str,
    trickles: bool,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
) -> None:
    with Port("/port", names=LocalNames()) as port:
        driver = dialled(port, what, tmp_path, monkeypatch)
        try:

            def look() -> bool:
                if trickles:
                    try:
                        driver.transport.send([b"1"])
                    except OSError:
                        return True
                    time.sleep(PAUSE)
                return is_ended(driver)

            wait_until(look)
        finally:
            driver.transport.close()
        wait_until(lambda: not port.inputs)
        wait_until(lambda: any("/port" in record.getMessage() for record in caplog.records
                               if record.levelname == "WARNING"))  # fmt: skip


@pytest.mark.parametrize("carrier", ["tcp", "fast_tcp", "text", "text_ack", "unix_stream",
                                     "websocket", "tls"])  # fmt: skip
def test_established_connection_may_be_silent(
    carrier: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also after a message that took several reads."""
    if carrier == "tls":
        prepare(tmp_path, monkeypatch)
    names = LocalNames()
    with Port("/in", names=names) as reader, Port("/out", names=names) as writer:
        writer.connect("/in", carrier)
        for size in (10, 300_000, 10):
            writer.write("x" * size)
            assert len(str(reader.read(timeout=HANG).value)) >= size
            time.sleep(3 * SHORT)
        assert len(reader.inputs) == 1
        assert reader.stats.past.inputs.messages == 0


def test_lost_message_is_counted() -> None:
    with Port("/port", names=LocalNames()) as port:
        driver, _ = greet(port.contact, Route("/slow", "/port", "fast_tcp"))
        driver.transport.send([HEADER])
        wait_until(lambda: port.stats.past.inputs.drops == 1)
        driver.transport.close()


def test_readers_have_a_limit(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """Who dials a port to read from it costs no thread of those that serve, but one for sending."""
    monkeypatch.setenv("YARPY_CONNECTIONS", "4")
    asking = b"GET /r HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"
    with Port("/port", names=LocalNames()) as port, ExitStack() as stack:
        for count in range(1, 8):
            sock = socket.create_connection(("127.0.0.1", port.contact.port), HANG)
            stack.enter_context(sock)
            sock.sendall(asking)
            if count <= 4:
                wait_until(lambda: len(port.outputs) == count)  # noqa: B023
        wait_until(lambda: "more are refused" in caplog.text)
        assert len(port.outputs) == 4
        assert caplog.text.count("more are refused") == 1
