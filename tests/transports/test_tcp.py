"""TCP: dialling and listening."""

from __future__ import annotations

import select
import socket
import sys
import threading
import time

import pytest
from support.port import free_port
from support.system import NO_MARKS
from support.wait import HANG, wait_until

from yarpy.errors import AddressError
from yarpy.transports.tcp import NEAR, TcpListener, TcpTransport, dial, is_taken


def readable(listener: TcpListener, timeout: float | None) -> bool:
    return bool(select.select([listener.sock], [], [], timeout)[0])


def test_dial_reaches_a_listener_and_sends_without_delay() -> None:
    listener = TcpListener()
    near = dial("127.0.0.1", listener.port)
    assert readable(listener, 5)
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


@pytest.mark.skipif(sys.platform != "linux", reason="other systems have other caches")
@pytest.mark.parametrize("size", [1, 70_000, 8_000_000])
def test_little_is_under_way_on_one_computer(size: int) -> None:
    listener = TcpListener()
    near = dial("127.0.0.1", listener.port)
    assert readable(listener, 5)
    far = TcpTransport(listener.accept()[0])
    for end in (near, far):
        assert end.sock.getsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF) == 2 * NEAR
    sent = bytes(range(256)) * (size // 256) + bytes(size % 256)
    sender = threading.Thread(target=near.send, args=([sent],))
    sender.start()
    room, filled = memoryview(bytearray(size)), 0
    while filled < size:
        filled += far.recv_into(room[filled:])
    sender.join(HANG)
    assert room == sent
    for end in (near, far):
        end.close()
    listener.close()
    listener.release()


def test_packets_that_need_no_mark_are_refused_nowhere() -> None:
    listener = TcpListener()
    near = dial("127.0.0.1", listener.port)
    near.set_dscp(0)
    assert near.tos() == 0
    near.close()
    listener.close()
    listener.release()


@pytest.mark.skipif(bool(NO_MARKS), reason=NO_MARKS)
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


def test_accept_does_not_wait() -> None:
    listener = TcpListener()
    with pytest.raises(BlockingIOError):
        listener.accept()
    listener.close()
    listener.release()


def test_who_reads_from_what_was_accepted_waits() -> None:
    listener = TcpListener()
    with socket.create_connection(("127.0.0.1", listener.port), HANG) as caller:
        assert readable(listener, HANG)
        sock, _ = listener.accept()
        later = threading.Timer(0.05, caller.sendall, (b"words",))
        later.start()
        with sock:
            assert sock.recv(5) == b"words"
        later.join()
    listener.close()
    listener.release()


def test_close_wakes_who_waits() -> None:
    listener = TcpListener()
    done = threading.Event()

    def wait() -> None:
        while not listener.closed:
            readable(listener, None)
        listener.release()
        done.set()

    threading.Thread(target=wait, daemon=True).start()
    listener.close()
    listener.close()
    assert done.wait(HANG)


def test_numbers_that_somebody_has() -> None:
    number = free_port()
    assert not is_taken(number)
    listener = TcpListener(number)
    assert is_taken(number)
    near = dial("127.0.0.1", number)
    # (wine lets a number be taken from which one dials)
    assert is_taken(near.local[1]) or sys.platform == "win32", "one dials from it"
    near.close()
    listener.close()
    listener.release()
    assert not is_taken(number)


def pair() -> tuple[TcpTransport, socket.socket]:
    """Our end of a connection, and the other one."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        near = socket.create_connection(listener.getsockname())
        far, _ = listener.accept()
    return TcpTransport(near), far


def certain(transport: TcpTransport, received: int) -> bool:
    taken = transport.taken(100, received)
    return taken is not None and taken[1]


@pytest.mark.skipif(sys.platform != "linux", reason="the system does not tell")
def test_what_a_peer_had_read_when_it_hung_up() -> None:
    transport, far = pair()
    transport.send([b"x" * 100])
    assert len(far.recv(100, socket.MSG_WAITALL)) == 100
    far.send(b"abc")
    assert not certain(transport, 0), "it has not hung up"
    far.close()
    assert not certain(transport, 0), "we have not read all of it"
    assert transport.recv_into(memoryview(bytearray(9))) == 3
    wait_until(lambda: transport.ended())
    assert transport.taken(100, 3) == (100, True)
    with pytest.raises(OSError):
        for _ in range(1000):
            transport.send([b"too late"])
            time.sleep(0.001)
    assert transport.taken(100, 3) == (100, True)
    transport.close()
    assert transport.taken(100, 3) is None


WITH_ERROR = pytest.param(
    True,
    marks=pytest.mark.skipif(
        sys.platform == "win32", reason="Windows tells of a reset by reading and writing alone"
    ),
)


@pytest.mark.parametrize("consume", [WITH_ERROR, False])
def test_peer_that_had_not_read_all(consume: bool) -> None:
    """How much it had read, nobody can say."""
    transport, far = pair()
    transport.send([b"x" * 100])
    select.select([far], [], [], 5)
    far.close()
    wait_until(lambda: select.select([transport.sock], [], [], 0)[0])
    if consume:  # whoever looked first got the error
        assert transport.sock.getsockopt(socket.SOL_SOCKET, socket.SO_ERROR)
    assert not certain(transport, 0)
    transport.close()


def test_our_own_end_tells_nothing_about_the_peer() -> None:
    transport, far = pair()
    transport.send([b"x" * 100])
    transport.interrupt()
    assert not certain(transport, 0)
    transport.close()
    far.close()
