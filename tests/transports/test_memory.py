"""Memory transports: how the two sides meet, what is handed over, and strangers on the socket."""

from __future__ import annotations

import os
import socket
import struct
import threading
from collections.abc import Callable, Iterator

import pytest

from yarpy.errors import LocalProtocolError, RemoteProtocolError
from yarpy.transports import memory
from yarpy.transports.arena import LEDGER, PAGE, available, sealed_memory
from yarpy.transports.memory import MemoryTransport, SendingTransport, open_memory

pytestmark = pytest.mark.skipif(not available(), reason="this system has no such memory")


def met(name: str = "/test/out") -> tuple[MemoryTransport, MemoryTransport]:
    sending = open_memory(False, 0, name)
    assert sending is not None
    reading = open_memory(True, sending.port, "")
    assert reading is not None
    sending.ready()
    reading.ready()
    return sending, reading


@pytest.fixture
def pair() -> Iterator[tuple[MemoryTransport, MemoryTransport]]:
    both = met()
    yield both
    for one in both:
        one.close()


def test_bytes_go_both_ways(pair: tuple[MemoryTransport, MemoryTransport]) -> None:
    sending, reading = pair
    room = memoryview(bytearray(10))
    sending.send([b"there"])
    assert reading.recv_into(room) == 5
    reading.send([b"back"])
    assert sending.recv_into(room) == 4
    sending.close()
    assert reading.recv_into(room) == 0


def test_payloads_lie_in_memory(pair: tuple[MemoryTransport, MemoryTransport]) -> None:
    sending, reading = pair
    placed = sending.place([b"one", b"two"], 6)
    assert placed is not None
    assert sending.lend(placed)
    view = reading.take(placed.slot, placed.generation, placed.offset, placed.size)
    assert view == b"onetwo"
    assert reading.place([b"x"], 1) is None  # answers go through the socket
    with pytest.raises(RemoteProtocolError):
        sending.take(0, 1, 0, 1)


def test_views_outlive_both_ends() -> None:
    sending, reading = met()
    placed = sending.place([b"onetwo"], 6)
    assert placed is not None
    sending.lend(placed)
    view = reading.take(placed.slot, placed.generation, placed.offset, placed.size)
    arena = placed.arena
    del placed
    reading.close()
    sending.close()
    assert arena.used == 1
    assert bytes(view) == b"onetwo"
    del view
    assert arena.used == 0


def test_packets_of_no_network_have_any_priority(
    pair: tuple[MemoryTransport, MemoryTransport],
) -> None:
    sending, _ = pair
    sending.set_dscp(40)
    assert sending.tos() == 40


def test_nothing_is_left_behind() -> None:
    before = len(os.listdir("/proc/self/fd"))
    sending, reading = met()
    name = f"yarpy-memory-{sending.port:016x}"
    sending.close()
    reading.close()
    del sending, reading
    assert len(os.listdir("/proc/self/fd")) == before
    with open("/proc/net/unix") as sockets:
        assert name not in sockets.read()


def test_a_number_that_nobody_waits_at() -> None:
    assert open_memory(True, 12345, "") is None


def test_a_system_without_such_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "available", lambda: False)
    assert open_memory(True, 1, "") is None
    with pytest.raises(LocalProtocolError, match="use tcp"):
        open_memory(False, 0, "/out")


def test_a_reader_that_does_not_come(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "PATIENCE", 0.1)
    sending = SendingTransport("/out")
    with pytest.raises(TimeoutError):
        sending.ready()
    sending.close()


def test_a_reader_that_hangs_up_is_not_waited_for() -> None:
    class GoneError(Exception):
        pass

    def look() -> None:
        raise GoneError

    sending = SendingTransport("/out")
    with pytest.raises(GoneError):
        sending.ready(look)
    sending.close()


# -- strangers ------------------------------------------------------------------------------------


def test_a_program_of_another_user_is_not_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    sending = SendingTransport("/out")
    monkeypatch.setattr(os, "geteuid", lambda: 4711)
    assert open_memory(True, sending.port, "") is None
    sending.close()


@pytest.mark.skipif(os.getuid() != 0, reason="it takes root to be somebody else")
def test_another_user_who_comes_first_gets_nothing() -> None:
    sending = SendingTransport("/out")
    ready = threading.Thread(target=sending.ready)
    ready.start()
    read, write = os.pipe()
    child = os.fork()
    if not child:
        os.setuid(12345)
        with socket.socket(socket.AF_UNIX) as sock:
            sock.settimeout(5)
            sock.connect(memory._path(sending.port))
            os.write(write, b"%d" % len(sock.recv(100)))
        os._exit(0)
    os.waitpid(child, 0)
    assert os.read(read, 10) == b"0"
    reading = open_memory(True, sending.port, "")
    assert reading is not None
    ready.join(5)
    reading.ready()
    for one in (sending, reading):
        one.close()
    os.close(read)
    os.close(write)


Hostile = Callable[[socket.socket], None]


def wrong_word(sock: socket.socket) -> None:
    sock.send(b"YARPXXXX")


def no_descriptors(sock: socket.socket) -> None:
    sock.send(b"YARPYMEM")


def hangs_up(sock: socket.socket) -> None:
    pass


def many(sock: socket.socket) -> None:
    socket.send_fds(sock, [b"YARPYMEM"], [0] * 50)


def two(sock: socket.socket) -> None:
    socket.send_fds(sock, [b"YARPYMEM"], [0, 0])


def devices(sock: socket.socket) -> None:
    socket.send_fds(sock, [b"YARPYMEM"], [0, 0, 0])


def unsealed(sock: socket.socket) -> None:
    file, ledger = os.memfd_create("test"), sealed_memory("test", LEDGER)
    os.ftruncate(file, PAGE)
    ours, theirs = os.pipe()
    socket.send_fds(sock, [b"YARPYMEM"], [file, ledger, theirs])
    for number in (file, ledger, ours, theirs):
        os.close(number)


@pytest.mark.parametrize(
    "hostile", [wrong_word, no_descriptors, hangs_up, many, two, devices, unsealed]
)
def test_a_hostile_sender(hostile: Hostile) -> None:
    with socket.socket(socket.AF_UNIX) as listener:
        listener.bind(memory._path(99))
        listener.listen()
        before = len(os.listdir("/proc/self/fd"))
        reading = open_memory(True, 99, "")
        assert reading is not None
        sock, _ = listener.accept()
        with sock:
            hostile(sock)
        with pytest.raises((RemoteProtocolError, ConnectionError)):
            reading.ready()
        reading.close()
        assert len(os.listdir("/proc/self/fd")) == before


def test_a_sender_that_says_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "PATIENCE", 0.1)
    with socket.socket(socket.AF_UNIX) as listener:
        listener.bind(memory._path(98))
        listener.listen()
        reading = open_memory(True, 98, "")
        assert reading is not None
        with pytest.raises(TimeoutError):
            reading.ready()
        reading.close()


def test_credentials_are_those_of_the_system() -> None:
    one, other = socket.socketpair()
    with one, other:
        told = one.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, 12)
        assert struct.unpack("3i", told) == (os.getpid(), os.getuid(), os.getgid())
        assert memory._same_user(one)
