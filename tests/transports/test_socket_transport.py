"""What all sockets do alike: sending many buffers, waiting with a limit, being woken."""

from __future__ import annotations

import select
import socket
import sys
import threading
import time
from collections.abc import Iterator

import pytest
from support.lasted import lasted
from support.wait import HANG

from yarpy.transports.socket_transport import SocketTransport, address_of, send_all, timeval
from yarpy.wire.stream import Buffer

Pair = tuple[SocketTransport, SocketTransport]


@pytest.fixture
def pair() -> Iterator[Pair]:
    left, right = socket.socketpair()
    ends = SocketTransport(left), SocketTransport(right)
    yield ends
    for end in ends:
        end.close()


def receive(end: SocketTransport, count: int) -> bytes:
    data = bytearray()
    room = memoryview(bytearray(65536))
    while len(data) < count:
        got = end.recv_into(room)
        assert got
        data += room[:got]
    return bytes(data)


@pytest.mark.parametrize(
    "sizes",
    [[1], [5, 5], [1] * 10, [1] * 3000, [100_000, 1, 100_000], [0, 5, 0], [700_000, 700_000]],
    ids=str,
)
def test_buffers_arrive_in_order_and_whole(pair: Pair, sizes: list[int]) -> None:
    buffers = [bytes([number % 251]) * size for number, size in enumerate(sizes)]
    sender = threading.Thread(target=pair[0].send, args=(buffers,))
    sender.start()
    assert receive(pair[1], sum(sizes)) == b"".join(buffers)
    sender.join(HANG)


@pytest.mark.skipif(
    not hasattr(select, "poll"), reason="this system does not tell of an end behind unread bytes"
)
def test_an_end_behind_what_nobody_has_read(pair: Pair) -> None:
    left, right = pair
    right.send([b"x"])
    assert not left.hung_up()
    right.close()
    assert left.hung_up()
    assert not left.ended()  # there is something to read
    left.close()
    assert not left.hung_up()


def test_send_goes_on_where_the_kernel_stopped() -> None:
    """A socket that takes little at a time gets the rest from the middle of a buffer."""

    class Reluctant:
        def __init__(self) -> None:
            self.got = bytearray()

        def sendmsg(self, buffers: list[bytes]) -> int:
            data = b"".join(bytes(b) for b in buffers)[:7]
            self.got += data
            return len(data)

    sock = Reluctant()
    send_all(sock, [b"0123456789", b"", b"abc", memoryview(b"xyz" * 5)])  # type: ignore[arg-type]
    assert sock.got == b"0123456789abc" + b"xyz" * 5


def test_without_sendmsg_buffers_are_joined() -> None:
    class Windows:
        def __init__(self) -> None:
            self.got = b""

        def sendall(self, data: bytes) -> None:
            self.got += data

    sock = Windows()
    send_all(sock, [b"a", b"b"])  # type: ignore[arg-type]
    assert sock.got == b"ab"


def test_trying_does_not_wait(pair: Pair) -> None:
    room = memoryview(bytearray(10))
    assert pair[1].try_recv_into(room) == -1
    pair[0].send([b"abc"])
    assert pair[1].try_recv_into(room) == 3
    pair[0].close()
    assert pair[1].try_recv_into(room) == 0


def test_waiting_has_a_limit_that_can_be_lifted(pair: Pair) -> None:
    room = memoryview(bytearray(10))
    pair[1].limit_waiting(0.05)
    started = time.monotonic()
    with pytest.raises(BlockingIOError):
        pair[1].recv_into(room)
    assert time.monotonic() - started > 0.04 and lasted(started) < 10
    pair[1].limit_waiting(None)
    threading.Timer(0.1, pair[0].send, ([b"late"],)).start()
    assert pair[1].recv_into(room) == 4


def test_sending_has_the_same_limit(pair: Pair) -> None:
    pair[0].limit_waiting(0.05)
    with pytest.raises((BlockingIOError, TimeoutError)):
        pair[0].send([bytes(100_000_000)])


def test_end_of_the_peer_is_seen_without_reading(pair: Pair) -> None:
    assert not pair[1].ended()
    pair[0].send([b"last words"])
    assert not pair[1].ended()
    pair[0].close()
    assert not pair[1].ended()  # there is something left to read
    assert receive(pair[1], 10) == b"last words"
    assert pair[1].ended()


def test_interrupt_wakes_who_waits(pair: Pair) -> None:
    found: list[int] = []
    waiter = threading.Thread(
        target=lambda: found.append(pair[1].recv_into(memoryview(bytearray(10))))
    )
    waiter.start()
    time.sleep(0.05)
    pair[1].interrupt()
    waiter.join(HANG)
    assert found == [0]
    pair[1].interrupt()  # again does no harm
    pair[1].close()
    pair[1].interrupt()
    pair[1].close()


def test_limit_of_a_closed_socket_is_no_error(pair: Pair) -> None:
    pair[0].close()
    pair[0].limit_waiting(1.0)
    pair[0].limit_waiting(None)


@pytest.mark.parametrize(
    ("raw", "wanted"),
    [
        (("127.0.0.1", 80), ("127.0.0.1", 80)),
        (("::ffff:10.0.0.1", 80, 0, 0), ("10.0.0.1", 80)),
        (("fe80::1", 80, 0, 2), ("fe80::1%2", 80)),
        (("fe80::1%eth0", 80, 0, 2), ("fe80::1%eth0", 80)),
        ("/path", ("/path", 0)),
    ],
)
def test_addresses(raw: object, wanted: tuple[str, int]) -> None:
    assert address_of(raw) == wanted


def test_time_limits_are_never_nothing() -> None:
    """Zero would mean for ever."""
    assert timeval(None) == bytes(len(timeval(None)))
    for seconds in (0.0, 1e-9, 0.5, 3.25):
        assert timeval(seconds) != timeval(None)


@pytest.mark.parametrize(
    "sizes", [[1], [3_000_000], [1_000_000, 0, 5, 2_000_000], [2000] * 1500], ids=str
)
def test_what_finds_no_room_is_left(pair: Pair, sizes: list[int]) -> None:
    left, right = pair
    wanted = [bytes([number % 256]) * size for number, size in enumerate(sizes)]
    rest: list[Buffer] = list(wanted)
    found = b""
    waits = 0
    while rest := left.try_send(rest):
        assert not left.wait_writable(0.01)
        waits += 1
        have = sum(sizes) - len(found) - sum(map(len, rest))
        assert have
        found += receive(right, have)
        assert left.wait_writable(5.0)
    # Windows takes all of it where there is any room.
    assert waits or sum(sizes) < 1000 or sys.platform == "win32"
    found += receive(right, sum(sizes) - len(found)) if len(found) < sum(sizes) else b""
    assert found == b"".join(wanted)


def test_end_is_told_to_who_waits_for_room(pair: Pair) -> None:
    left, _ = pair
    assert left.try_send([bytes(5_000_000)])
    threading.Timer(0.1, left.interrupt).start()
    started = time.monotonic()
    assert left.wait_writable(20.0)
    assert lasted(started) < 10
    with pytest.raises(OSError, match=r"pipe|10058"):
        left.try_send([b"more"])
    left.close()
    assert left.wait_writable(20.0)
    with pytest.raises(OSError, match=r"descriptor|10038"):
        left.try_send([b"more"])


def test_waiting_for_something_to_read(pair: Pair) -> None:
    left, right = pair
    assert not left.wait_readable(0.01)
    right.send([b"x"])
    assert left.wait_readable(5.0)
    assert left.recv_into(memoryview(bytearray(1))) == 1
    threading.Timer(0.1, left.interrupt).start()
    assert left.wait_readable(20.0)
    left.close()
    assert left.wait_readable(20.0)
