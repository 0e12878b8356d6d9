"""Calls over HTTP: our port as the server, and servers that go wrong in each way there is."""

import asyncio
import logging
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import pytest
from support.listener import listening
from support.thrift_module import SPELLINGS, apache, data, service
from support.wait import HANG, wait_until

import yarpy
from yarpy.errors import (
    AddressError,
    LinkClosed,
    LocalProtocolError,
    PortClosed,
    RemoteProtocolError,
)
from yarpy.kits.thrift.apache.carrier import Thrift
from yarpy.kits.thrift.apache.post import Post, path_of
from yarpy.route import parse_carrier

WHOLE = data("added", "binary")  # the answer to the first call of a connection
OK = b"HTTP/1.1 200 OK\r\nContent-Type: application/x-thrift\r\n"


def request(sock: socket.socket) -> bytes:
    """A whole request."""
    found = b""
    while b"\r\n\r\n" not in found:
        found += sock.recv(1)
    head = found.lower()
    size = int(head.partition(b"content-length: ")[2].partition(b"\r")[0])
    while size:
        piece = sock.recv(size)
        size -= len(piece)
        found += piece
    return found


@contextmanager
def answering(*answers: bytes, hangs_up: bool = True) -> Iterator[tuple[str, list[bytes]]]:
    """A server that gives these answers, the last of them again and again: its address, and what it
    was asked."""
    heard: list[bytes] = []

    def serve(sock: socket.socket) -> None:
        heard.append(request(sock))
        sock.sendall(answers[min(len(heard), len(answers)) - 1])
        if hangs_up:
            sock.close()

    with listening(serve) as (port, _):
        yield f"127.0.0.1:{port}", heard


@pytest.mark.parametrize("spelling", SPELLINGS)
def test_all_calls_of_one_that_stays_go_over_one_connection(spelling: str) -> None:
    m, handler = apache(), service()
    way = "thrift+http" + ("+compact" if spelling == "compact" else "")
    with (
        yarpy.RpcServer("/thrift", handler, names=yarpy.LocalNames()) as server,
        m.Test.connect(f"{way}://{server.address}", timeout=HANG) as client,
    ):
        assert client.add(1, 2) == 3 and client.nothing() is None
        client.fire("x")
        client.fire("y")
        assert client.fail(0) == "x,y"
        with pytest.raises(m.Bad, match="bad"):
            client.fail(1)
        with pytest.raises(RemoteProtocolError, match="missing"):
            client.missing()
        assert client.numbers(100_000).sum() == 99_999 * 100_000 / 4
        assert len(server.stats.inputs) == 1


def test_the_path_is_said(caplog: pytest.LogCaptureFixture) -> None:
    with (
        answering(OK + b"Content-Length: %d\r\n\r\n" % len(WHOLE) + WHOLE) as (address, heard),
        apache().Test.connect(f"thrift+http+path.a/b?c=1://{address}", timeout=HANG) as client,
    ):
        assert client.add(1, -2) == -1
    head = heard[0].partition(b"\r\n\r\n")[0].decode().split("\r\n")
    assert head[0] == "POST /a/b?c=1 HTTP/1.1"
    assert f"Host: {address}" in head and "Content-Type: application/x-thrift" in head
    assert heard[0].endswith(data("add", "binary"))


def test_words_that_do_not_fit() -> None:
    assert Thrift.of(parse_carrier("thrift+http+compact+path.x")) is Post
    for words, why in (
        ("http+framed", "has no frame"),
        ("path.x", r"a path is said of thrift\+http"),
        ("http+path.a b", "write %20 for blanks"),
    ):
        with pytest.raises(LocalProtocolError, match=why):
            Thrift.of(parse_carrier(f"thrift+{words}"))
    assert path_of(parse_carrier("thrift+http")) == "/"
    for begin in (apache().Test.connect, apache().Test.connect_async):
        with pytest.raises(AddressError, match=r"thrift\+http\+path\.a/b://127\.0\.0\.1:9"):
            begin("thrift+http://127.0.0.1:9/a/b")


@pytest.mark.parametrize(
    ("answer", "why"),
    [
        (
            b"HTTP/1.1 404 Not Found\r\nContent-Length: 3\r\n\r\nno!",
            r'"404 Not Found": say the path',
        ),
        (b"HTTP/1.0 413 \r\n\r\n", 'answers "413": the call is larger than that server takes'),
        (
            b"HTTP/1.1 301 Moved\r\nLocation: /other\r\nContent-Length: 0\r\n\r\n",
            "the service is at /other, connect to that",
        ),
        (b"HTTP/1.1 500 Oops\r\nContent-Length: 0\r\n\r\n", '"500 Oops": its log may say why'),
        (
            b"HTTP/1.1 200 OK\r\nContent-Type: text/html\r\nContent-Length: 6\r\n\r\n<html>",
            "is no server of Thrift: its body of 6 bytes is text/html, not application/x-thrift",
        ),
        (OK + b"Content-Length: 0\r\n\r\n", "its body of 0 bytes is no message"),
        (
            OK + b"\r\n" + data("added", "compact"),
            r"answers in TCompactProtocol: connect to thrift\+http\+compact://",
        ),
        (OK + b"\r\n" + data("added", "binary").replace(b"add", b"sub"), "an answer to 'sub'"),
        (OK + b"\r\n" + data("echoed", "binary"), "an answer to the call 7, where 1 was asked"),
        (OK + b"\r\n" + WHOLE[:-8] + b"\x63\0\0\0\0\0\0\0", "no answer of http://.*99 is no type"),
        (b"\0\0\0\x10" + WHOLE + b"\r\n" * 4, "does not speak HTTP .* thrift://"),
        (b"HTTP/1.1 200 OK\r\nX: " + b"x" * 20_000, "does not speak HTTP"),
        (OK + b"Content-Length: " + b"9" * 5000 + b"\r\n\r\n", "does not speak HTTP"),
        (
            OK + b"Transfer-Encoding: chunked\r\n\r\n" + b"f" * 5000 + b"\r\n",
            r"\(illegal chunk .{,200}\): is",
        ),
        (OK + b"Content-Length: 999999999999\r\n\r\n", "an answer of 999999999999 bytes or more"),
        (
            OK + b"Transfer-Encoding: chunked\r\n\r\nffffff\r\n" + bytes(2000),
            "bytes or more is announced; the limit is 1000 bytes",
        ),
    ],
)
def test_what_is_no_answer(answer: bytes, why: str) -> None:
    with answering(answer) as (address, _):
        target = f"thrift+http://{address}"
        with apache().Test.connect(target, timeout=HANG, limit=1000) as client:
            for _ in range(2):  # and none of it is taken for the next one's answer
                with pytest.raises((RemoteProtocolError, yarpy.DecodeError), match=why):
                    client.add(1, -2)


@pytest.mark.parametrize(
    "answer",
    [
        b"",
        b"HTTP/1.1 200",
        OK + b"\r\n",
        OK + b"\r\n" + WHOLE[:-1],
        OK + b"Content-Length: 99\r\n\r\n" + WHOLE,
        OK + b"Transfer-Encoding: chunked\r\n\r\n4\r\n" + WHOLE[:4],
    ],
)
def test_a_server_that_goes_within_its_answer(answer: bytes) -> None:
    wholly = OK + b"\r\n" + WHOLE
    with (
        answering(answer, wholly) as (address, heard),
        apache().Test.connect(f"thrift+http://{address}", timeout=HANG) as client,
    ):
        with pytest.raises((LinkClosed, RemoteProtocolError)) as error:
            client.add(1, -2)
        empty = answer == OK + b"\r\n"  # no message at all: that is the answer of a oneway call
        assert isinstance(error.value, LinkClosed) != empty
        assert len(heard) == 1  # it may have done what it was told: it is not asked again
        assert client.add(1, -2) == -1


def test_one_that_ends_the_connection_later_is_dialled_anew() -> None:
    """The end that it has announced has not come when the next call is made."""
    whole = b"HTTP/1.0 200 OK\r\nContent-Length: %d\r\n\r\n" % len(WHOLE) + WHOLE
    oneway = b"HTTP/1.0 200 OK\r\n\r\n"
    with answering(whole, whole, oneway, oneway, whole, hangs_up=False) as (address, heard):
        with apache().Test.connect(f"thrift+http://{address}", timeout=HANG) as client:
            assert client.add(1, -2) == -1 and client.add(1, -2) == -1
            client.fire("x")
            client.fire("y")
            assert client.add(1, -2) == -1
        wait_until(lambda: len(heard) == 5)


def test_a_oneway_call_that_is_refused_is_logged(caplog: pytest.LogCaptureFixture) -> None:
    gone = b"HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\n\r\n"
    whole = OK + b"Connection: close\r\n\r\n" + WHOLE
    with (
        answering(gone, whole) as (address, _),
        caplog.at_level(logging.WARNING, "yarpy"),
        apache().Test.connect(f"thrift+http://{address}", timeout=HANG) as client,
    ):
        client.fire("x")
        assert client.add(1, -2) == -1
    assert "a oneway call: http://" in caplog.text and "404 Not Found" in caplog.text


@contextmanager
def silent() -> Iterator[tuple[str, threading.Event]]:
    """A server that answers nothing: its address, and whether it was asked."""
    asked = threading.Event()

    def serve(sock: socket.socket) -> None:
        request(sock)
        asked.set()

    with listening(serve) as (port, _):
        yield f"thrift+http://127.0.0.1:{port}", asked


def test_an_answer_that_does_not_come() -> None:
    with silent() as (target, _), apache().Test.connect(target) as client:
        client.timeout = 0.2
        with pytest.raises(yarpy.Timeout, match=r"add: no answer within 0\.2 s"):
            client.add(1, 2)


def test_a_client_that_is_closed_meanwhile() -> None:
    with silent() as (target, asked), apache().Test.connect(target) as client:

        def close() -> None:
            assert asked.wait(HANG)
            client.close()

        thread = threading.Thread(target=close)
        thread.start()
        with pytest.raises(PortClosed):
            client.add(1, 2)
        thread.join()


def test_a_call_in_a_loop_is_given_up() -> None:
    """Its end is no end of an answer that ends with the connection."""

    async def main(target: str, asked: threading.Event) -> None:
        async with apache().Test.connect_async(target) as client:
            call = asyncio.create_task(client.add(1, 2))
            await asyncio.to_thread(asked.wait, HANG)
            call.cancel()
            with pytest.raises(asyncio.CancelledError):
                await call

    with silent() as (target, asked):
        asyncio.run(main(target, asked))


def test_a_client_in_a_loop() -> None:
    async def main(address: str) -> None:
        async with apache().Test.connect_async(f"thrift+http://{address}", timeout=HANG) as client:
            for _ in range(3):
                await client.fire("x")
            assert await client.add(3, 4) == 7

    made: Callable[[], object] = service
    with yarpy.RpcServer("/thrift", made(), names=yarpy.LocalNames()) as server:  # type: ignore[arg-type]
        asyncio.run(main(server.address))
