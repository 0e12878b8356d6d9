"""bcast: ends that share a group, with bells and without, and one that dies.

MPI itself is pretended here; `tests/interop/test_mpi.py` has the real ones.
"""

from __future__ import annotations

import socket
import threading
from collections.abc import Iterator

import pytest
from support.mpi_hall import FakeLibrary, Hall
from support.wait import HANG, wait_until

from yarpy.errors import LocalProtocolError
from yarpy.peers.mpi import bcast as mpi_bcast
from yarpy.peers.mpi.bcast import BcastReader, BcastSender, open_end, open_mpi
from yarpy.wire import framing

QUIT = framing.encode_command("q")
Ends = tuple[BcastSender, BcastReader]


class Net:
    """Connections of the port /s."""

    def __init__(self) -> None:
        self.library = FakeLibrary(Hall())
        self.ends: list[BcastSender | BcastReader] = []
        self.server = socket.create_server(("127.0.0.1", 0))

    def connect(self, name: str, line: bool = True) -> Ends:
        near = socket.create_connection(self.server.getsockname())
        far, _ = self.server.accept()
        sender = open_end("bcast", False, near, f"{name}<-/s")
        reader = open_end("bcast", True, far, f"{name}<-/s")
        assert isinstance(sender, BcastSender) and isinstance(reader, BcastReader)
        near.close()
        far.close()
        reader.place = sender.place
        if not line:  # as with C++
            reader._line.close()
        thread = threading.Thread(target=reader.ready)
        thread.start()
        sender.ready()
        thread.join(HANG)
        self.ends += [sender, reader]
        return sender, reader


@pytest.fixture
def net(monkeypatch: pytest.MonkeyPatch) -> Iterator[Net]:
    net = Net()
    monkeypatch.setattr(mpi_bcast, "library", lambda: net.library)
    monkeypatch.setattr(mpi_bcast, "HESITATION", 0.02)
    yield net
    for end in net.ends:
        end.close()
    net.server.close()


def take(end: BcastReader, room: int = 100) -> bytes:
    view = memoryview(bytearray(room))
    return bytes(view[: end.recv_into(view)])


def test_one_sends_to_all(net: Net) -> None:
    first, one = net.connect("/one")
    first.send([b"to ", b"one"])
    assert take(one) == b"to one"
    second, two = net.connect("/two")
    first.send([b"to both"])
    assert (take(one), take(two)) == (b"to both", b"to both")
    first.close()
    assert (take(one), take(one)) == (QUIT, b"")
    second.send([b"to two"])
    assert (take(two, 3), take(two, 3)) == (b"to ", b"two")
    assert two.try_recv_into(memoryview(bytearray(8))) == -1
    second.close()
    assert (take(two), take(two)) == (QUIT, b"")
    assert net.library.lost == 0
    third, three = net.connect("/three")  # a new group
    third.send([b"again"])
    assert take(three) == b"again"


def test_without_bells(net: Net) -> None:
    sender, reader = net.connect("/cpp", line=False)
    sender.send([b"hello"])
    assert take(reader) == b"hello"
    sender.close()
    assert take(reader) == QUIT


def test_a_reader_that_dies_ends_all(net: Net) -> None:
    first, one = net.connect("/one")
    second, two = net.connect("/two")
    one._line.close()
    wait_until(first.ended, what="its end is seen")
    assert second.ended()
    with pytest.raises(OSError):
        second.send([b"x"])
    first.close()
    second.close()
    assert (take(two), take(two)) == (b"", b"")
    assert net.library.lost >= 1
    third, three = net.connect("/three")
    third.send([b"again"])
    assert take(three) == b"again"


def test_a_sender_that_dies(net: Net) -> None:
    sender, reader = net.connect("/one")
    sender._line.close()
    assert take(reader) == b""


def test_a_slow_reader_holds_its_sender(net: Net, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mpi_bcast, "AHEAD", 10)
    sender, reader = net.connect("/one")
    sender.send([bytes(20)])
    wait_until(lambda: reader._held == 20, what="it has come")
    sender.send([b"held back"])
    assert len(take(reader)) == 20
    assert take(reader) == b"held back"


def test_a_reader_that_is_closed_goes_on_in_the_group(net: Net) -> None:
    first, one = net.connect("/one")
    _, two = net.connect("/two")
    one.close()
    first.send([b"x"])
    assert take(two) == b"x"


def test_limits_and_interruption(net: Net) -> None:
    sender, reader = net.connect("/one")
    for end in (sender, reader):
        end.limit_waiting(0.01)
        with pytest.raises(BlockingIOError):
            end.recv_into(memoryview(bytearray(8)))
        end.interrupt()
        assert end.recv_into(memoryview(bytearray(8))) == 0
    with pytest.raises(OSError):
        sender.send([b"x"])
    reader.send([b"nothing goes that way"])
    assert reader.try_send([b"x"]) == [] and reader.wait_writable(1.0)


def test_a_sender_that_is_busy(net: Net) -> None:
    sender, _ = net.connect("/one")
    group = sender._group
    assert group is not None
    with group._lock:  # as MPI would
        assert sender.try_send([b"first"]) == []
        assert sender.try_send([b"next"]) == [b"next"]
        assert not sender.wait_writable(0.01)
        sender.limit_waiting(0.01)
        with pytest.raises(BlockingIOError):
            sender.send([b"next"])
    assert sender.wait_writable(20.0)


def test_not_over_other_things_than_tcp() -> None:
    with pytest.raises(LocalProtocolError, match="take tcp"):
        open_mpi("bcast", False, None, "/a<-/b")
