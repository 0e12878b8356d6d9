"""One connection to a name server, over a pair of sockets: commands, replies, their limits."""

from __future__ import annotations

import socket
import time
from collections.abc import Iterator

import pytest

from yarpy.errors import RemoteProtocolError
from yarpy.names import line as module
from yarpy.names.line import Gone, Line, acknowledged, old_style


@pytest.fixture
def pair() -> Iterator[tuple[Line, socket.socket]]:
    here, there = socket.socketpair()
    with there:
        line = Line(here, "lines")
        line.until = time.monotonic() + 30
        yield line, there
        line.close()


def test_old_style(pair: tuple[Line, socket.socket]) -> None:
    line, server = pair
    server.sendall(
        b"registration name /a ip 1.2.3.4 port 5 type tcp\r\n*** end of message\r\n[ok]\n"
    )
    (said,) = old_style(line, "query /a")
    assert said == "registration name /a ip 1.2.3.4 port 5 type tcp"
    assert server.recv(100) == b"NAME_SERVER query /a\n"
    assert not line.clean  # somebody else's, or the end of another reply
    assert line.line() == "[ok]" and line.clean


@pytest.mark.parametrize(
    ("reply", "said"), [(b"[ok]\n", []), (b'[fail] "not here"\n', ["not here"]), (b"[(\n", [])]
)
def test_news_about_a_port_is_one_line(
    pair: tuple[Line, socket.socket], reply: bytes, said: list[str]
) -> None:
    line, server = pair
    server.sendall(reply)
    assert old_style(line, "announce /a 1") == said


def test_several_commands_go_in_one_piece(pair: tuple[Line, socket.socket]) -> None:
    line, server = pair
    server.sendall(b"one\r\ntwo\r\n<ACK>\r\n<ACK>\r\n")
    assert acknowledged(line, "a", "b") == [["one", "two"], []]
    assert server.recv(100) == b"d\r\na\r\nd\r\nb\r\n"


@pytest.mark.parametrize("ask", [old_style, acknowledged])
@pytest.mark.parametrize("reply", [b"x" * 150, b"xxxx\n" * 30])
def test_no_reply_is_endless(
    monkeypatch: pytest.MonkeyPatch, pair: tuple[Line, socket.socket], ask, reply: bytes
) -> None:
    monkeypatch.setattr(module, "NAME_REPLY", 100)
    line, server = pair
    server.sendall(reply)
    with pytest.raises(RemoteProtocolError, match="more than 100 bytes"):
        ask(line, "list")


def test_its_end(pair: tuple[Line, socket.socket]) -> None:
    line, server = pair
    server.close()
    with pytest.raises(Gone):
        line.line()


def test_its_deadline(pair: tuple[Line, socket.socket]) -> None:
    line, _ = pair
    line.until = time.monotonic() + 0.02
    with pytest.raises(TimeoutError):
        line.line()
    with pytest.raises(TimeoutError):  # which is over
        line.send(b"x")


def test_another_thread_frees_who_waits(pair: tuple[Line, socket.socket]) -> None:
    line, _ = pair
    line.wake()
    with pytest.raises(Gone):
        line.line()
