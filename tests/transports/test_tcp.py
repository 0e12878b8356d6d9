"""TCP: dialling, listening, watching silent connections."""

from __future__ import annotations

import socket
import threading

import pytest
from support.port import free_port

from yarpy.errors import AddressError
from yarpy.transports.tcp import TcpListener, TcpTransport, dial, is_taken


def test_dial_reaches_a_listener_and_sends_without_delay() -> None:
    listener = TcpListener()
    near = dial("127.0.0.1", listener.port)
    assert listener.wait({}, 5) == [listener.sock.fileno()]
    sock, where = listener.accept()
    far = TcpTransport(sock)
    assert near.remote == far.local == ("127.0.0.1", listener.port)
    assert near.local == far.remote == where
    for end in (near, far):
        assert end.sock.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY)
        assert end.port == 0
    near.send([b"hello"])
    room = memoryview(bytearray(10))
    assert far.recv_into(room) == 5
    for end in (near, far):
        end.close()
    listener.close()
    listener.release()


def test_dscp_is_set_on_the_socket() -> None:
    listener = TcpListener()
    near = dial("127.0.0.1", listener.port)
    near.set_dscp(144)
    assert near.sock.getsockopt(socket.IPPROTO_IP, socket.IP_TOS) == 144
    near.close()
    listener.close()
    listener.release()


@pytest.mark.parametrize("port", [0, -1, 65536])
def test_impossible_numbers(port: int) -> None:
    with pytest.raises(AddressError, match="1 and 65535"):
        dial("127.0.0.1", port)


def test_impossible_host() -> None:
    with pytest.raises(AddressError, match="is no host name"):
        dial("x" * 70, 10000)


def test_nobody_there() -> None:
    with pytest.raises(ConnectionRefusedError):
        dial("127.0.0.1", free_port(), 2)


def test_number_that_is_taken() -> None:
    first = TcpListener()
    with pytest.raises(OSError, match=r".") as caught:
        TcpListener(first.port)
    assert caught.value.errno is not None
    first.close()
    first.release()


def test_silent_connections_are_watched_with_the_listener() -> None:
    listener = TcpListener()
    near = dial("127.0.0.1", listener.port)
    listener.wait({}, 5)
    sock, _ = listener.accept()
    silent = {sock.fileno(): sock}
    assert listener.wait(silent, 0.01) == []
    near.send([b"x"])
    assert listener.wait(silent, 5) == [sock.fileno()]
    near.close()
    sock.close()
    listener.close()
    listener.release()


def test_accept_does_not_wait() -> None:
    listener = TcpListener()
    with pytest.raises(BlockingIOError):
        listener.accept()
    listener.close()
    listener.release()


def test_close_wakes_who_waits() -> None:
    listener = TcpListener()
    done = threading.Event()

    def wait() -> None:
        while not listener.closed:
            listener.wait({}, None)
        listener.release()
        done.set()

    threading.Thread(target=wait, daemon=True).start()
    listener.close()
    listener.close()
    assert done.wait(5)
    assert listener.wait({}, 0) == []


def test_numbers_that_somebody_has() -> None:
    number = free_port()
    assert not is_taken(number)
    listener = TcpListener(number)
    assert is_taken(number)
    near = dial("127.0.0.1", number)
    assert is_taken(near.local[1]), "one dials from it"
    near.close()
    listener.close()
    listener.release()
    assert not is_taken(number)


def test_peer_that_vanishes_is_noticed() -> None:
    """By the kernel, which asks after ten seconds of silence (a cut cable cannot be had here)."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        transport = dial("127.0.0.1", listener.getsockname()[1])
        assert transport.sock.getsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE)
        if hasattr(socket, "TCP_KEEPIDLE"):
            assert transport.sock.getsockopt(socket.IPPROTO_TCP, socket.TCP_KEEPIDLE) == 10
        transport.close()
