"""shmem: how the two sides meet, what they see of each other, and what nobody leaves behind."""

from __future__ import annotations

import os
import signal
import socket
import struct
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from support.lasted import lasted
from support.wait import HANG, wait_until

from yarpy.errors import LocalProtocolError, RemoteProtocolError
from yarpy.transports.shared import shmem
from yarpy.transports.shared.ring import Ring
from yarpy.transports.shared.shmem import AHEAD, ShmemTransport, open_shmem
from yarpy.transports.shared.sysv import available

pytestmark = pytest.mark.skipif(not available(), reason="no memory of System V here")

HOST = "127.0.0.1"


def segments() -> list[int]:
    """Of this process, as far as they have a key."""
    lines = [
        line.split()
        for line in Path("/proc/sysvipc/shm").read_text(encoding="utf-8").splitlines()[1:]
    ]
    return [int(line[0]) for line in lines if int(line[4]) == os.getpid() and int(line[0])]


@pytest.fixture(autouse=True)
def directory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Where the mutexes lie; in the end nothing does."""
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    yield tmp_path
    assert [path.name for path in tmp_path.iterdir() if path.name.startswith("SHMEM")] == []
    assert segments() == []


def meet() -> tuple[ShmemTransport, ShmemTransport]:
    listening = open_shmem(True, (HOST, 10002), (HOST, 40000), 0)
    dialling = open_shmem(False, (HOST, 40000), (HOST, 10002), listening.port)
    thread = threading.Thread(target=listening.ready)
    thread.start()
    dialling.ready()
    thread.join(HANG)
    return listening, dialling


@pytest.fixture
def pair() -> Iterator[tuple[ShmemTransport, ShmemTransport]]:
    ends = meet()
    yield ends
    for end in ends:
        end.close()


def test_both_ways(pair: tuple[ShmemTransport, ShmemTransport]) -> None:
    listening, dialling = pair
    room = memoryview(bytearray(100))
    dialling.send([b"the", b"re"])
    assert bytes(room[: listening.recv_into(room)]) == b"there"
    listening.send([b"back"])
    assert bytes(room[: dialling.recv_into(room)]) == b"back"
    assert listening.try_recv_into(room) == -1
    assert (listening.remote, listening.local) == (dialling.local, dialling.remote)
    assert not listening.ended() and not dialling.ended()


def test_names_go_once_both_have_met(directory: Path) -> None:
    listening, dialling = meet()
    assert listening.try_recv_into(memoryview(bytearray(8))) == -1
    assert list(directory.iterdir()) == []
    assert segments() == []
    for end in (listening, dialling):
        end.close()


def test_the_end_is_seen(pair: tuple[ShmemTransport, ShmemTransport]) -> None:
    listening, dialling = pair
    dialling.send([b"last"])
    dialling.close()
    room = memoryview(bytearray(100))
    assert listening.recv_into(room) == 4
    assert listening.ended()
    assert listening.recv_into(room) == 0
    with pytest.raises(OSError):
        listening.send([b"x"])


def test_a_reader_is_interrupted(pair: tuple[ShmemTransport, ShmemTransport]) -> None:
    came: list[int] = []
    room = memoryview(bytearray(100))
    thread = threading.Thread(target=lambda: came.append(pair[0].recv_into(room)))
    thread.start()
    pair[0].interrupt()
    thread.join(HANG)
    assert came == [0]
    with pytest.raises(OSError):
        pair[0].send([b"x"])


def test_time_limits(pair: tuple[ShmemTransport, ShmemTransport]) -> None:
    pair[0].limit_waiting(0.01)
    with pytest.raises(BlockingIOError):
        pair[0].recv_into(memoryview(bytearray(8)))
    pair[0].send([bytes(AHEAD)])
    assert pair[0].try_send([b"x"]) == [b"x"]
    assert not pair[0].wait_writable(0.01)
    with pytest.raises(BlockingIOError):
        pair[0].send([b"x"])


def test_a_writer_waits_for_its_reader(pair: tuple[ShmemTransport, ShmemTransport]) -> None:
    listening, dialling = pair
    total, piece = 40 * AHEAD, bytes(AHEAD // 4)
    counted = 0

    def write() -> None:
        for _ in range(total // len(piece)):
            dialling.send([piece])

    thread = threading.Thread(target=write)
    thread.start()
    room = memoryview(bytearray(100000))
    while counted < total:
        assert dialling.taken(total, 0) is not None
        assert dialling._out.filled <= AHEAD
        counted += listening.recv_into(room)
    thread.join(HANG)
    assert dialling.taken(total, 0) == (total, False)


def test_a_message_may_be_larger(pair: tuple[ShmemTransport, ShmemTransport]) -> None:
    listening, dialling = pair
    data = os.urandom(3 * AHEAD)
    dialling.send([data])
    came = bytearray()
    room = memoryview(bytearray(1 << 20))
    while len(came) < len(data):
        came += room[: listening.recv_into(room)]
    assert came == data


def test_priority_is_kept_for_nobody(pair: tuple[ShmemTransport, ShmemTransport]) -> None:
    pair[0].set_dscp(40)
    assert pair[0].tos() == 40


def test_only_for_one_computer() -> None:
    for listen in (True, False):
        with pytest.raises(LocalProtocolError, match="one computer"):
            open_shmem(listen, (HOST, 10002), ("192.0.2.1", 40000), 10003)


def test_what_stands_in_the_way(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(number: int, create: bool, peer: object) -> None:
        raise FileExistsError("it is another program's")

    monkeypatch.setattr(shmem, "Ring", refuse)
    with pytest.raises(LocalProtocolError, match=r"another program's.*use memory"):
        open_shmem(True, (HOST, 10002), (HOST, 40000), 0)


def test_a_peer_that_never_comes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shmem, "TIMEOUT", 0.1)
    listening = open_shmem(True, (HOST, 10002), (HOST, 40000), 0)
    looks: list[int] = []
    with pytest.raises(TimeoutError):
        listening.ready(lambda: looks.append(1))
    assert looks
    listening.close()


HELLOS = {
    "nothing": b"",
    "half": bytes(4),
    "another command": struct.pack("<2i", 7, 4096),
    "no ring": struct.pack("<2i", 0, 4096),
}


@pytest.mark.parametrize("hello", HELLOS.values(), ids=HELLOS.keys())
def test_peers_that_know_half_of_it(hello: bytes) -> None:
    listening = open_shmem(True, (HOST, 10002), (HOST, 40000), 0)
    with socket.create_connection((HOST, listening.port)) as peer:
        peer.sendall(hello)
        peer.shutdown(socket.SHUT_WR)
        with pytest.raises(RemoteProtocolError):
            listening.ready()
    listening.close()


def test_a_ring_of_lies() -> None:
    """A peer that does all right, and then writes numbers that cannot be."""
    listening, dialling = meet()
    dialling._out._segment.numbers[5] = -7
    with pytest.raises(RemoteProtocolError):
        listening.recv_into(memoryview(bytearray(8)))
    dialling._out._segment.numbers[5] = 0
    for end in (listening, dialling):
        end.close()


def test_a_mutex_that_shrinks_ends_the_connection() -> None:
    """Its file has no name any more, but who has it open can still make it shorter."""
    listening = open_shmem(True, (HOST, 10002), (HOST, 40000), 0)
    dialling = open_shmem(False, (HOST, 40000), (HOST, 10002), listening.port)
    kept = os.open(dialling._out._access._path, os.O_RDWR)
    thread = threading.Thread(target=listening.ready)
    thread.start()
    dialling.ready()
    thread.join(HANG)
    dialling.send([b"abc"])
    os.truncate(kept, 0)
    os.close(kept)
    with pytest.raises(OSError, match="was changed"):
        listening.recv_into(memoryview(bytearray(8)))
    for end in (listening, dialling):
        end.close()


_PEER = """
import sys, time
from yarpy.transports.shared.shmem import open_shmem
end = open_shmem(False, ("127.0.0.1", 40000), ("127.0.0.1", 10002), int(sys.argv[1]))
end.ready()
end.send([bytes(20000)])
print("sent", flush=True)
time.sleep(600)
"""


def test_a_killed_peer_leaves_nothing() -> None:
    """The memory of both ends with them; the survivor sees the end soon."""
    listening = open_shmem(True, (HOST, 10002), (HOST, 40000), 0)
    with subprocess.Popen(
        [sys.executable, "-c", _PEER, str(listening.port)], stdout=subprocess.PIPE
    ) as peer:
        assert peer.stdout is not None
        try:
            listening.ready()
            peer.stdout.readline()
        finally:
            peer.send_signal(signal.SIGKILL)
    room = memoryview(bytearray(30000))
    assert listening.recv_into(room) == 20000
    started = time.monotonic()
    assert listening.recv_into(room) == 0
    assert lasted(started) < 30
    lines = Path("/proc/sysvipc/shm").read_text(encoding="utf-8").splitlines()[1:]
    assert not [line for line in lines if int(line.split()[4]) == peer.pid and line.split()[6] == 0]
    listening.close()


def test_a_peer_that_dies_with_the_mutex(pair: tuple[ShmemTransport, ShmemTransport]) -> None:
    listening, dialling = pair
    assert dialling._out._access.try_acquire()
    dialling._sock.shutdown(socket.SHUT_RDWR)
    with pytest.raises(OSError):
        dialling._out.write([b"x"], 1)
    assert listening.ended()
    assert isinstance(listening._in, Ring)
    thread = threading.Thread(target=listening.close)
    thread.start()
    wait_until(lambda: not thread.is_alive(), what="it closes all the same")
