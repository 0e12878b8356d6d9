"""What the ends of MPI have in common: the line that tells of the other one, and its bells."""

from __future__ import annotations

import socket
from collections.abc import Iterator

import pytest
from support.wait import wait_until

from yarpy.errors import AccessRefused, LocalProtocolError, RemoteProtocolError
from yarpy.peers.mpi import end as mpi_end
from yarpy.peers.mpi.end import Line, explained, pieces
from yarpy.wire import framing


@pytest.fixture
def lines() -> Iterator[tuple[socket.socket, socket.socket]]:
    with (
        socket.create_server(("127.0.0.1", 0)) as server,
        socket.create_connection(server.getsockname()) as near,
        server.accept()[0] as far,
    ):
        yield near, far


def test_a_program_of_yarpy_keeps_the_line(lines: tuple[socket.socket, socket.socket]) -> None:
    near, far = Line(lines[0]), Line(lines[1])
    for sock in lines:
        sock.close()
    near.settle()
    far.settle()
    assert not near.cut and not far.cut
    far.close()
    wait_until(lambda: near.cut, what="its end is seen")
    near.close()
    assert not near.cut


def test_bells(lines: tuple[socket.socket, socket.socket]) -> None:
    near, far = Line(lines[0]), Line(lines[1])
    for sock in lines:
        sock.close()
    assert far.hear(0.01) is None
    near.settle()
    near.ring()
    near.ring()
    assert [far.hear(5.0) for _ in range(3)] == [b"\n", b".", b"."]
    assert not far.cut
    near.close()
    assert far.hear(5.0) == b""
    near.ring()  # nobody is left to hear it
    far.close()
    assert far.hear(5.0) == b""


def test_cpp_does_not_keep_the_line(lines: tuple[socket.socket, socket.socket]) -> None:
    """So its end says nothing."""
    line = Line(lines[0])
    line.settle()
    assert not line.cut
    lines[1].close()
    assert not line.cut
    assert line._sock is None or not line.cut
    line.close()


def test_a_peer_that_refuses(lines: tuple[socket.socket, socket.socket]) -> None:
    line = Line(lines[0])
    line.watch()
    lines[1].sendall(framing.encode_refusal("it has no MPI"))
    with pytest.raises(RemoteProtocolError, match="it has no MPI"):
        wait_until(lambda: line.watch(), what="it is told")
    line.close()


def test_a_peer_that_we_may_not_talk_to(lines: tuple[socket.socket, socket.socket]) -> None:
    line = Line(lines[0])
    lines[1].sendall(framing.encode_refusal(f"{framing.REFUSED}: no"))
    with pytest.raises(AccessRefused):
        wait_until(lambda: line.watch(), what="it is told")
    line.close()


def test_a_peer_that_hangs_up(
    lines: tuple[socket.socket, socket.socket], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(mpi_end, "LATE", 0.05)
    line = Line(lines[0])
    lines[1].close()
    with pytest.raises(RemoteProtocolError, match="could not begin, as its log says"):
        wait_until(lambda: line.watch(), what="it is noticed")
    line.close()


def test_pieces(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mpi_end, "MOST", 10)
    assert pieces([b"abc", b"", b"def"]) == (b"abcdef", [])
    data, left = pieces([b"abc", b"0123456789", b"xyz"])
    assert (data, b"".join(left)) == (b"abc0123456", b"789xyz")


def test_what_mpi_says() -> None:
    told = explained(ValueError("Invalid\ncommunicator " + 500 * "x"))
    assert isinstance(told, LocalProtocolError)
    assert str(told).startswith('MPI says "Invalid communicator x')
    assert "openmpi-bin" in str(told) and len(str(told)) < 500
