"""Memory transports: how the two sides meet, what is handed over, and strangers on the socket."""

from __future__ import annotations

import gc
import os
import socket
import struct
import threading
from collections.abc import Callable, Iterator

import pytest
from support import held
from support.system import NO_ROOT
from support.wait import HANG

from yarpy.errors import LocalProtocolError, RemoteProtocolError
from yarpy.transports.shared import memory
from yarpy.transports.shared.arena import PAGE, Arena, arena_of, tidy
from yarpy.transports.shared.borrowed import OTHERS
from yarpy.transports.shared.loan import LEDGER
from yarpy.transports.shared.memory import MemoryTransport, SendingTransport, open_memory
from yarpy.transports.shared.sealed import available, sealed_memory

pytestmark = pytest.mark.skipif(not available(), reason="this system has no such memory")


def sealed(name: str, size: int) -> int:
    """The descriptor of a file that keeps its size, to be given away."""
    file = sealed_memory(name, size)
    return os.dup(file.fileno())


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
    assert sending.lend(placed) == 0
    view = reading.take(0, placed.slot, placed.generation, placed.offset, placed.size)
    assert view == b"onetwo"
    assert reading.place([b"x"], 1) is None  # answers go through the socket
    with pytest.raises(RemoteProtocolError):
        sending.take(0, 0, 1, 0, 1)


def test_views_outlive_both_ends() -> None:
    sending, reading = met()
    placed = sending.place([b"onetwo"], 6)
    assert placed is not None
    sending.lend(placed)
    view = reading.take(0, placed.slot, placed.generation, placed.offset, placed.size)
    arena = placed.arena
    assert isinstance(arena, Arena)
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
    before = held.files()
    sending, reading = met()
    name = f"yarpy-memory-{sending.port:016x}"
    sending.close()
    reading.close()
    del sending, reading
    assert held.files() <= before
    with open("/proc/net/unix", encoding="utf-8") as sockets:
        assert name not in sockets.read()


def test_a_number_that_nobody_waits_at() -> None:
    assert open_memory(True, 12345, "") is None


def test_a_system_without_such_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "available", lambda: False)
    assert open_memory(True, 1, "") is None
    with pytest.raises(LocalProtocolError, match="use tcp"):
        open_memory(False, 0, "/out")


def test_a_program_without_descriptors_left(monkeypatch: pytest.MonkeyPatch) -> None:
    """None is closed twice, which could be one of another thread by then."""
    gc.collect()  # what earlier tests have left goes now
    before = held.files()
    sending = SendingTransport("/out")
    reading = open_memory(True, sending.port, "")
    assert reading is not None

    def fails(*arguments: object) -> None:
        raise OSError(24, "Too many open files")

    with monkeypatch.context() as patch:
        patch.setattr("yarpy.transports.shared.arena.mmap.mmap", fails)
        with pytest.raises(OSError, match="Too many"):
            sending.ready()
    sending.close()
    reading.close()
    assert held.files() <= before


def test_a_reader_that_does_not_come(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "TIMEOUT", 0.1)
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


# -- from program to program ----------------------------------------------------------------------


class Chain:
    """Three ports: what the first writes the second passes on to the third, as it has it."""

    def __init__(self) -> None:
        self.first, self.second = met("/first"), met("/second")

    def write(self, data: bytes) -> memoryview:
        """What the second program sees of it."""
        return self.pass_on(self.first, data)

    def relay(self, view: memoryview) -> memoryview:
        """What the third sees of what the second has."""
        return self.pass_on(self.second, view)

    def pass_on(
        self, pair: tuple[MemoryTransport, MemoryTransport], data: bytes | memoryview
    ) -> memoryview:
        sending, reading = pair
        placed = sending.place([data], len(data))
        assert placed is not None
        where = sending.lend(placed)
        self.own = placed.source is placed.arena
        return reading.take(where, placed.slot, placed.generation, placed.offset, placed.size)

    def close(self) -> None:
        for one in (*self.first, *self.second):
            one.close()


@pytest.fixture
def chain() -> Iterator[Chain]:
    chain = Chain()
    yield chain
    chain.close()


def test_what_was_received_is_passed_on_as_it_lies(chain: Chain) -> None:
    arena = arena_of("/first")
    for number in range(3):
        view = chain.relay(chain.write(bytes([number]) * 20000))
        assert not chain.own
        assert bytes(view) == bytes([number]) * 20000
        assert arena.used == 1  # the second program is done with it, the third is not
        arena.view[5] = 99  # the very same memory, as only a sender that breaks the rules shows
        assert view[5] == 99
        del view
        tidy()
        assert arena.used == 0


def test_a_part_of_it_is_passed_on_as_well(chain: Chain) -> None:
    view = chain.write(bytes(range(250)) * 200)
    assert bytes(chain.relay(view[100:30100])) == bytes(view[100:30100])
    assert not chain.own


def test_small_parts_are_copied(chain: Chain) -> None:
    assert bytes(chain.relay(chain.write(b"x" * 20000)[:100])) == b"x" * 100
    assert chain.own


def test_what_is_looked_at_outlives_who_passed_it_on(chain: Chain) -> None:
    arena = arena_of("/first")
    view = chain.relay(chain.write(b"x" * 20000))
    chain.close()
    tidy()
    assert arena.used == 1
    assert bytes(view) == b"x" * 20000
    del view
    tidy()
    assert arena.used == 0


def test_memory_of_many_programs_in_turn(chain: Chain) -> None:
    """A connection knows some of them at a time."""
    pairs = [met(f"/source/{number}") for number in range(OTHERS + 3)]
    for _ in range(2):
        for number, pair in enumerate(pairs):
            view = chain.relay(chain.pass_on(pair, bytes([number]) * 20000))
            assert not chain.own
            assert bytes(view) == bytes([number]) * 20000
    for pair in pairs:
        for one in pair:
            one.close()


def test_a_reader_that_takes_no_descriptors_gets_copies(chain: Chain) -> None:
    sending, _ = chain.second
    assert isinstance(sending, SendingTransport)
    assert sending._aside is not None
    sending._aside.close()
    view = chain.write(b"x" * 20000)
    placed = sending.place([view], len(view))
    assert placed is not None
    assert sending.lend(placed) < 0
    del placed, view
    assert arena_of("/second").used == 0
    tidy()
    assert arena_of("/first").used == 0


@pytest.mark.parametrize("where", [0x101, 0x100, 0x1FF, 0xFFFF, 1])
def test_memory_that_does_not_come(
    pair: tuple[MemoryTransport, MemoryTransport], where: int
) -> None:
    with pytest.raises(RemoteProtocolError, match="memory number"):
        pair[1].take(where, 0, 1, 0, 1)


@pytest.mark.parametrize("said", [b"\2", b"\1\1", b""])
@pytest.mark.parametrize("count", [0, 1, 3])
def test_descriptors_that_come_in_a_wrong_way(
    pair: tuple[MemoryTransport, MemoryTransport], said: bytes, count: int
) -> None:
    sending, reading = pair
    assert isinstance(sending, SendingTransport)
    assert sending._aside is not None
    before = held.files()
    if count:
        socket.send_fds(sending._aside, [said], [0] * count)
    else:
        sending._aside.send(said)
    with pytest.raises(RemoteProtocolError, match="memory number 1"):
        reading.take(0x101, 0, 1, 0, 1)
    assert held.files() <= before


def test_other_memory_is_looked_at_as_closely(
    pair: tuple[MemoryTransport, MemoryTransport],
) -> None:
    sending, reading = pair
    assert isinstance(sending, SendingTransport)
    assert sending._aside is not None
    unsealed = os.memfd_create("test", os.MFD_ALLOW_SEALING)
    os.ftruncate(unsealed, PAGE)
    socket.send_fds(sending._aside, [b"\1"], [unsealed])
    os.close(unsealed)
    with pytest.raises(RemoteProtocolError, match="may become shorter"):
        reading.take(0x101, 0, 1, 0, 1)


# -- strangers ------------------------------------------------------------------------------------


def test_a_program_of_another_user_is_not_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    sending = SendingTransport("/out")
    monkeypatch.setattr(os, "geteuid", lambda: 4711)
    assert open_memory(True, sending.port, "") is None
    sending.close()


@pytest.mark.skipif(bool(NO_ROOT), reason=NO_ROOT)
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
    ready.join(HANG)
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
    socket.send_fds(sock, [b"YARPYMEM"], [0, 0, 0, 0])


def unsealed(sock: socket.socket) -> None:
    file, ledger = os.memfd_create("test"), sealed("test", LEDGER)
    os.ftruncate(file, PAGE)
    ours, theirs = os.pipe()
    aside, other = socket.socketpair()
    socket.send_fds(sock, [b"YARPYMEM"], [file, ledger, theirs, aside.fileno()])
    for number in (file, ledger, ours, theirs, aside.detach(), other.detach()):
        os.close(number)


@pytest.mark.parametrize(
    "hostile", [wrong_word, no_descriptors, hangs_up, many, two, devices, unsealed]
)
def test_a_hostile_sender(hostile: Hostile) -> None:
    with socket.socket(socket.AF_UNIX) as listener:
        listener.bind(memory._path(99))
        listener.listen()
        before = held.files()
        reading = open_memory(True, 99, "")
        assert reading is not None
        sock, _ = listener.accept()
        with sock:
            hostile(sock)
        with pytest.raises((RemoteProtocolError, ConnectionError)):
            reading.ready()
        reading.close()
        assert held.files() <= before


def test_a_sender_that_says_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "TIMEOUT", 0.1)
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
