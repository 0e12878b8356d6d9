"""Peers that die without a word: what the kernel is asked for. What comes of it when a host is
switched off is in tests/chaos."""

from __future__ import annotations

import logging
import socket
import sys
import time
from collections.abc import Iterator

import pytest

from yarpy.transports.peer_timeout import SETTING, asked_timeout, peer_timeout
from yarpy.transports.tcp import TcpListener, TcpTransport, dial

linux = pytest.mark.skipif(sys.platform != "linux", reason="options of Linux")


@pytest.fixture
def pair() -> Iterator[tuple[TcpTransport, TcpTransport]]:
    """A connection: who dialled, who accepted."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        near = dial("127.0.0.1", listener.getsockname()[1])
        far = TcpTransport(listener.accept()[0])
    yield near, far
    near.close()
    far.close()


def option(transport: TcpTransport, name: str) -> int:
    return transport.sock.getsockopt(socket.IPPROTO_TCP, getattr(socket, name))


@linux
def test_both_sides_notice_within_half_a_minute(pair: tuple[TcpTransport, TcpTransport]) -> None:
    for side in pair:
        assert side.sock.getsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE)
        asked = option(side, "TCP_KEEPINTVL") * option(side, "TCP_KEEPCNT")
        assert option(side, "TCP_KEEPIDLE") + asked == 25
        assert option(side, "TCP_USER_TIMEOUT") == 25_000


@linux
def test_the_environment_says_how_soon(monkeypatch: pytest.MonkeyPatch) -> None:
    for said, limit in (("3", 3000), ("0.5", 500), ("0", 0)):
        monkeypatch.setenv(SETTING, said)
        listener = TcpListener()
        transport = dial("127.0.0.1", listener.port)
        assert option(transport, "TCP_USER_TIMEOUT") == limit
        assert bool(transport.sock.getsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE)) == (
            limit > 0
        )
        transport.close()
        listener.close()
        listener.release()


@pytest.mark.parametrize("said", ["soon", "-3", "nan", "1e300"])
def test_what_is_no_time_is_told_once(
    said: str, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setenv(SETTING, said)
    with caplog.at_level(logging.WARNING):
        assert peer_timeout() == peer_timeout() == 25
    assert caplog.text.count(SETTING) == 1


@linux
def test_a_connection_may_have_a_time_of_its_own(pair: tuple[TcpTransport, TcpTransport]) -> None:
    pair[0].limit_silence(60)
    assert [option(side, "TCP_USER_TIMEOUT") for side in pair] == [60_000, 25_000]


@pytest.mark.parametrize("said", ["0", "", "-3", "1.5", "86401", "9" * 5000, "²", "soon"])
def test_what_a_connection_cannot_ask_for(said: str) -> None:
    assert [asked_timeout("1"), asked_timeout("86400")] == [1, 86400]
    with pytest.raises(ValueError, match=r"tcp\+peer_timeout\.60"):
        asked_timeout(said)


@linux
@pytest.mark.parametrize("asked", [True, False])
def test_a_reader_that_takes_nothing_is_no_dead_host(
    asked: bool, pair: tuple[TcpTransport, TcpTransport], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The kernel alone would end the connection when the time is over."""
    near, far = pair
    if asked:
        near.limit_silence(1)
    else:
        monkeypatch.setenv(SETTING, "1")
    near.sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, 1000)
    sent = 0
    near.sock.setblocking(False)
    until = time.monotonic() + 4
    while time.monotonic() < until:
        try:
            sent += near.sock.send(bytes(1 << 16))
        except BlockingIOError:
            time.sleep(0.05)
        near.spare_slow_reader()
    assert option(near, "TCP_USER_TIMEOUT") == 0
    near.sock.setblocking(True)
    got = 0
    while got < sent:
        got += len(far.sock.recv(1 << 20))
    near.spare_slow_reader()
    assert option(near, "TCP_USER_TIMEOUT") == 1000
