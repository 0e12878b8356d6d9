"""mpi: bytes in a communicator of two, and the TCP connection that tells who has died.

MPI itself is a pair of lists here; `tests/interop/test_mpi.py` has the real ones.
"""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import pytest
from support.wait import HANG, wait_until

from yarpy.errors import LocalProtocolError, RemoteProtocolError
from yarpy.peers.mpi import bcast as mpi_bcast
from yarpy.peers.mpi import end as mpi_end
from yarpy.peers.mpi import transport
from yarpy.peers.mpi.transport import MpiTransport


class Failed(Exception):
    """What MPI raises."""


class Status:
    size = 0

    def Get_count(self, kind: object) -> int:  # noqa: N802
        return self.size


class Comm:
    """One side of two; `stuck` sends nothing off."""

    def __init__(self, rank: int, mine: list[bytes], others: list[bytes], size: int = 2) -> None:
        self.rank, self.mine, self.others, self.size = rank, mine, others, size
        self.stuck = self.failing = self.freed = False

    def Get_size(self) -> int:  # noqa: N802
        return self.size

    def Get_rank(self) -> int:  # noqa: N802
        return self.rank

    def Set_errhandler(self, handler: object) -> None:  # noqa: N802
        pass

    def Iprobe(self, source: int, tag: int, status: Status) -> bool:  # noqa: N802
        assert (source, tag) == (1 - self.rank, 0)
        if self.failing:
            raise Failed("broken")
        if self.mine:
            status.size = len(self.mine[0])
        return bool(self.mine)

    def Recv(self, where: Any, source: int, tag: int) -> None:  # noqa: N802
        where[0][: where[1]] = self.mine.pop(0)

    def Isend(self, what: Any, target: int, tag: int) -> SimpleNamespace:  # noqa: N802
        assert (target, tag) == (1 - self.rank, 0)
        if self.failing:
            raise Failed("broken")
        self.others.append(bytes(what[0]))
        return SimpleNamespace(Test=lambda: not self.stuck, Wait=self.wait)

    def wait(self) -> None:
        while self.stuck:
            time.sleep(0.01)

    def Free(self) -> None:  # noqa: N802
        self.freed = True


class Library:
    """As mpi_library has it."""

    program = "vm____pid____1"

    def __init__(self, meet: Any) -> None:
        alone = SimpleNamespace(
            Accept=lambda place: self.between(place, 0),
            Connect=lambda place: self.between(place, 1),
            Free=lambda: None,
        )
        self.meet = meet
        self.lost = 0
        self.mpi = SimpleNamespace(
            COMM_SELF=SimpleNamespace(Dup=lambda: alone),
            Exception=Failed,
            ERRORS_RETURN=None,
            BYTE=None,
            Status=Status,
            Open_port=lambda: "somewhere",
            Close_port=lambda place: None,
        )

    def between(self, place: str, rank: int) -> SimpleNamespace:
        assert place == "somewhere"
        comm = self.meet(rank)
        return SimpleNamespace(
            Set_errhandler=lambda handler: None,
            Merge=lambda high: comm if high == bool(rank) else None,
            Disconnect=lambda: None,
        )

    def lose(self, *kept: object) -> None:
        self.lost += 1


@pytest.fixture
def lines() -> Iterator[tuple[socket.socket, socket.socket]]:
    with (
        socket.create_server(("127.0.0.1", 0)) as server,
        socket.create_connection(server.getsockname()) as near,
        server.accept()[0] as far,
    ):
        yield near, far


def opened(listen: bool, sock: socket.socket) -> MpiTransport:
    end = mpi_bcast.open_end("mpi", listen, sock, "/in<-/out")
    assert isinstance(end, MpiTransport)
    end.place = "somewhere"
    return end


Ends = tuple[MpiTransport, MpiTransport]


@pytest.fixture
def pair(
    lines: tuple[socket.socket, socket.socket], monkeypatch: pytest.MonkeyPatch
) -> Iterator[Ends]:
    first: list[bytes] = []
    second: list[bytes] = []
    comms = Comm(0, first, second), Comm(1, second, first)
    library = Library(lambda rank: comms[rank])
    monkeypatch.setattr(mpi_bcast, "library", lambda: library)
    ends = opened(False, lines[0]), opened(True, lines[1])
    for sock, end in zip(lines, ends, strict=True):
        assert (end.local, end.remote) == (sock.getsockname(), sock.getpeername())
        sock.close()
    for end in ends:
        end.ready()
    yield ends
    for end in ends:
        end.close()


def take(end: MpiTransport, room: int = 100) -> bytes:
    view = memoryview(bytearray(room))
    return bytes(view[: end.recv_into(view)])


def test_both_ways(pair: Ends) -> None:
    pair[0].send([b"the", b"", b"re"])
    assert take(pair[1]) == b"there"
    pair[1].send([b"back"])
    assert take(pair[0]) == b"back"
    assert pair[0].try_recv_into(memoryview(bytearray(8))) == -1
    assert not pair[0].ended() and not pair[1].ended()


def test_where_messages_are_cut_means_nothing(pair: Ends) -> None:
    pair[0].send([bytes(range(10))])
    assert [take(pair[1], 4), take(pair[1], 4), take(pair[1], 4)] == [
        bytes(range(4)),
        bytes(range(4, 8)),
        bytes(range(8, 10)),
    ]


def test_large_ones_go_in_pieces(pair: Ends, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mpi_end, "MOST", 10)
    pair[0].send([bytes(7), b"0123456789", memoryview(b"abcdefghij" * 2)])
    came = b"".join(take(pair[1]) for _ in range(4))
    assert came == bytes(7) + b"0123456789" + b"abcdefghij" * 2


def test_a_peer_that_takes_nothing(pair: Ends) -> None:
    pair[0]._comm.stuck = True
    pair[0].send([b"first"])
    assert pair[0].try_send([b"next"]) == [b"next"]
    assert not pair[0].wait_writable(0.01)
    pair[0].limit_waiting(0.01)
    with pytest.raises(BlockingIOError):
        pair[0].send([b"next"])
    pair[0]._comm.stuck = False
    assert pair[0].wait_writable(60.0)


def test_a_time_limit(pair: Ends) -> None:
    pair[0].limit_waiting(0.01)
    with pytest.raises(BlockingIOError):
        take(pair[0])


@pytest.mark.parametrize("how", ["closes", "is interrupted"])
def test_the_end(pair: Ends, how: str) -> None:
    came: list[bytes] = []
    thread = threading.Thread(target=lambda: came.append(take(pair[1])))
    thread.start()
    if how == "closes":
        pair[0].send([b"last"])
        pair[0].close()
    else:
        pair[1].interrupt()
    thread.join(30)
    assert came == [b"last" if how == "closes" else b""]
    assert take(pair[1]) == b""
    with pytest.raises(OSError):
        (pair[0] if how == "closes" else pair[1]).send([b"x"])


def test_who_leaves_first_loses_nobody(pair: Ends) -> None:
    comms = pair[0]._comm, pair[1]._comm
    pair[0].close()
    pair[1].close()
    assert pair[0]._library.lost == 0  # type: ignore[attr-defined]
    assert comms[0].freed


def test_a_peer_that_dies(pair: Ends) -> None:
    """MPI says nothing, the line does. What MPI still sends is not waited for."""
    pair[0]._comm.stuck = True
    pair[0].send([b"on its way"])
    pair[1]._line.close()
    wait_until(pair[0].ended, what="the end of the line is seen")
    assert pair[0].wait_writable(HANG)
    for send in (pair[0].try_send, pair[0].send):
        with pytest.raises(OSError):
            send([b"x"])
    comm = pair[0]._comm
    pair[0].close()
    assert pair[0]._library.lost == 1  # type: ignore[attr-defined]
    comm.stuck = False


def test_mpi_fails(pair: Ends) -> None:
    pair[0]._comm.failing = True
    for action in (lambda: take(pair[0]), lambda: pair[0].send([b"x"])):
        with pytest.raises(ConnectionResetError, match="broken"):
            action()


def test_a_peer_that_does_not_come(
    lines: tuple[socket.socket, socket.socket], monkeypatch: pytest.MonkeyPatch
) -> None:
    event = threading.Event()
    library = Library(lambda rank: event.wait())
    monkeypatch.setattr(mpi_bcast, "library", lambda: library)
    monkeypatch.setattr(transport, "MEETING", 0.05)
    end = opened(False, lines[0])
    with pytest.raises(TimeoutError):
        end.ready()
    assert library.lost == 1
    event.set()
    end.close()


def test_too_many_come(
    lines: tuple[socket.socket, socket.socket], monkeypatch: pytest.MonkeyPatch
) -> None:
    library = Library(lambda rank: Comm(0, [], [], size=3))
    monkeypatch.setattr(mpi_bcast, "library", lambda: library)
    end = opened(False, lines[0])
    with pytest.raises(RemoteProtocolError, match="and not two"):
        end.ready()
    end.close()


def test_mpi_refuses(
    lines: tuple[socket.socket, socket.socket], monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(rank: int) -> None:
        raise Failed("Invalid communicator,\nerror stack:")

    monkeypatch.setattr(mpi_bcast, "library", lambda: Library(refuse))
    end = opened(True, lines[0])
    with pytest.raises(LocalProtocolError, match=r"Invalid communicator.*mpiexec -n 1"):
        end.ready()
    end.close()


def test_what_it_is_not(pair: Ends) -> None:
    with pytest.raises(LocalProtocolError, match="use tcp"):
        pair[0].set_dscp(8)
    assert (pair[0].tos(), pair[0].taken(1, 1)) == (0, None)


def test_a_signal_handler_closes_it_above_a_frame_that_is_in_mpi(
    pair: Ends, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It used to wait for ever for a lock of that frame, which still needs the communicator."""
    comm = pair[0]._comm
    send = comm.Isend

    def interrupted(*arguments: Any) -> Any:
        pair[0].close()
        assert not comm.freed
        return send(*arguments)

    monkeypatch.setattr(comm, "Isend", interrupted)
    failed: list[OSError] = []

    def act() -> None:
        try:
            pair[0].send([b"x"])
        except OSError as error:
            failed.append(error)

    sending = threading.Thread(target=act, daemon=True)
    sending.start()
    sending.join(HANG)
    assert not sending.is_alive() and failed
    assert pair[0]._library.lost == 1  # type: ignore[attr-defined]
