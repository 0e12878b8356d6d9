"""Connections that are passed on between TCP and Zenoh, whose side is played by joined pipes."""

from __future__ import annotations

import contextlib
import socket
import threading
from collections.abc import Iterator

import pytest
from support.wait import HANG, wait_until
from support.zenoh import Wire

from yarpy.peers.zenoh.tunnel import gateway as zenoh_gateway
from yarpy.peers.zenoh.tunnel.gateway import Gateway, bring
from yarpy.peers.zenoh.tunnel.pipe import ZenohPipe


def pipes() -> tuple[ZenohPipe, ZenohPipe]:
    """The two ends of a pipe."""
    wire = Wire()
    return wire.one, wire.other


def read(pipe: ZenohPipe) -> bytes:
    pipe.limit_waiting(20)
    view = memoryview(bytearray(100))
    return bytes(view[: pipe.recv_into(view)])


@pytest.fixture
def called() -> list[ZenohPipe]:
    return []


@pytest.fixture
def gateway(called: list[ZenohPipe]) -> Iterator[Gateway]:
    def call(host: str, port: int, timeout: float) -> ZenohPipe:
        if port == 404:
            raise ConnectionRefusedError("nobody")
        one, other = pipes()
        called.append(other)
        return one

    made = Gateway(call)
    yield made
    made.close()


@contextlib.contextmanager
def dialled(number: int) -> Iterator[socket.socket]:
    with socket.create_connection(("127.0.0.1", number), 20) as sock:
        yield sock


def test_bytes_go_both_ways_until_one_side_ends(gateway: Gateway, called: list[ZenohPipe]) -> None:
    number = gateway.number("ab.zenoh", 5)
    assert gateway.number("ab.zenoh", 5) == number != gateway.number("ab.zenoh", 6)
    with dialled(number) as sock:
        sock.sendall(b"to zenoh")
        wait_until(lambda: called)
        assert read(called[0]) == b"to zenoh"
        called[0].send([b"to ", b"tcp"])
        assert sock.recv(100) == b"to tcp"
        sock.sendall(b"last")
    assert read(called[0]) == b"last" and read(called[0]) == b""
    with dialled(number) as sock:
        wait_until(lambda: len(called) == 2)
        called[1].send([b"bye"])
        called[1].close()
        assert sock.recv(100) == b"bye" and sock.recv(100) == b""


def test_no_way(gateway: Gateway) -> None:
    with dialled(gateway.number("ab.zenoh", 404)) as sock:
        assert sock.recv(100) == b""


def test_a_closed_gateway_listens_no_more(gateway: Gateway) -> None:
    number = gateway.number("ab.zenoh", 5)
    gateway.close()

    def refused() -> bool:
        try:
            with dialled(number) as sock:
                return sock.recv(1) == b""
        except OSError:
            return True

    wait_until(refused)


def test_there_are_not_too_many(gateway: Gateway, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(zenoh_gateway, "MOST", 1)
    gateway.number("ab.zenoh", 5)
    with pytest.raises(OSError, match="already"):
        gateway.number("ab.zenoh", 6)
    monkeypatch.setattr(zenoh_gateway, "_room", threading.Semaphore(0))
    with dialled(gateway.number("ab.zenoh", 5)) as sock:
        assert sock.recv(100) == b""


def test_who_comes_out_of_zenoh_is_brought_to_a_port() -> None:
    one, other = pipes()
    with socket.create_server(("127.0.0.1", 0)) as server:
        number = server.getsockname()[1]
        thread = threading.Thread(target=bring, args=(one, "127.0.0.1", number))
        thread.start()
        sock, _ = server.accept()
        with sock:
            other.send([b"hello"])
            assert sock.recv(100) == b"hello"
            sock.sendall(b"back")
            assert read(other) == b"back"
        thread.join(HANG)
    one, other = pipes()
    bring(one, "127.0.0.1", number)  # nobody listens there any more
    assert read(other) == b""
