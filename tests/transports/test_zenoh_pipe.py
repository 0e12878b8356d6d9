"""A pipe through Zenoh, its two ends joined directly: order, room, loss, ends."""

from __future__ import annotations

import threading
from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.wait import wait_until

from yarpy.qos import tos_of
from yarpy.transports import zenoh_pipe
from yarpy.transports.zenoh_pipe import ZenohPipe, priority_of


class Wire:
    """Two ends, and what was sent between them; `lose` says which messages do not arrive."""

    def __init__(self, lose: Callable[[bytes], bool] = lambda data: False) -> None:
        self.sent: list[tuple[str, bytes]] = []
        self.left: list[str] = []
        self.finished: list[str] = []
        self.lose = lose
        self.one = ZenohPipe(("a", 0), ("b", 7), self._to("b"), lambda: self.left.append("a"))
        self.other = ZenohPipe(("b", 7), ("a", 0), self._to("a"), lambda: self.left.append("b"))

    def _to(
        self, name: str
    ) -> Callable[[str], tuple[Callable[[bytes], object], Callable[[], object]]]:
        def connect(priority: str) -> tuple[Callable[[bytes], object], Callable[[], object]]:
            def put(data: bytes) -> None:
                self.sent.append((priority, data))
                if not self.lose(data):
                    (self.other if name == "b" else self.one).deliver(data)

            return put, lambda: self.finished.append(priority)

        return connect


def read(pipe: ZenohPipe, count: int) -> bytes:
    view = memoryview(bytearray(count))
    done = 0
    while done < count:
        got = pipe.recv_into(view[done:])
        assert got
        done += got
    return bytes(view)


def test_bytes_on_the_wire() -> None:
    wire = Wire()
    wire.one.send([b"ab", memoryview(b"c")])
    wire.one.send([b"d"])
    wire.one.close()
    assert wire.sent == [
        ("DATA", b"\0\0\0\0\0abc"),
        ("DATA", b"\0\1\0\0\0d"),
        ("DATA", b"\2\2\0\0\0"),
    ]
    assert read(wire.other, 4) == b"abcd"
    assert wire.other.recv_into(memoryview(bytearray(3))) == 0 and wire.other.ended()
    assert wire.left == ["a"] and wire.finished == ["DATA"]


@given(st.lists(st.binary(max_size=300), max_size=20), st.integers(1, 200))
def test_whatever_goes_in_comes_out(messages: list[bytes], size: int) -> None:
    wire = Wire()
    for message in messages:
        wire.one.send([message[:10], message[10:]])
    whole = b"".join(messages)
    view = memoryview(bytearray(size))
    found = bytearray()
    while (count := wire.other.try_recv_into(view)) > 0:
        found += view[:count]
    assert found == whole and count == -1


def test_large_messages_go_in_pieces_and_credit_comes_back() -> None:
    wire = Wire()
    data = bytes(range(256)) * (3 * zenoh_pipe.PIECE // 256)
    for _ in range(8):
        wire.one.send([b"head", data])
        assert read(wire.other, len(data) + 4) == b"head" + data
    assert max(len(sent) for _, sent in wire.sent) == zenoh_pipe.PIECE + 5


def test_a_sender_learns_what_was_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(zenoh_pipe, "SAY", 0.0)
    wire = Wire()
    wire.one.send([b"taken"])
    assert wire.one.taken(5, 0) == (0, False)
    read(wire.other, 5)
    assert wire.one.taken(5, 0) == (5, False)


def test_nobody_sends_more_than_is_wanted() -> None:
    wire = Wire()
    piece = bytes(zenoh_pipe.PIECE)
    for _ in range(zenoh_pipe.WINDOW // len(piece)):
        wire.one.send([piece])
    assert wire.one.try_send([b"", b"more"]) == [b"more"]
    assert not wire.one.wait_writable(0.01)
    wire.one.limit_waiting(0.01)
    with pytest.raises(BlockingIOError, match="does not read"):
        wire.one.send([b"more"])
    wire.one.limit_waiting(None)
    sender = threading.Thread(target=wire.one.send, args=([b"more"],))
    sender.start()
    read(wire.other, zenoh_pipe.WINDOW)
    sender.join(20)
    assert read(wire.other, 4) == b"more"


def test_a_sender_that_is_asked_for_too_much_is_not_believed() -> None:
    wire = Wire()
    wire.one.deliver(b"\1" + b"\xff" * 8)
    for _ in range(zenoh_pipe.WINDOW // zenoh_pipe.PIECE):
        wire.one.send([bytes(zenoh_pipe.PIECE)])
    assert wire.one.try_send([b"x"]) == [b"x"]


def test_what_is_lost_breaks_it() -> None:
    wire = Wire(lambda data: data[5:] == b"lost")
    for message in (b"came", b"lost", b"late"):
        wire.one.send([message])
    assert read(wire.other, 4) == b"came"
    assert wire.other.recv_into(memoryview(bytearray(1))) == 0
    wait_until(wire.one.ended)
    with pytest.raises(BrokenPipeError, match="gone"):
        wire.one.send([b"x"])


@pytest.mark.parametrize(
    "strange",
    [
        b"",
        b"\x09",
        b"\0",
        b"\0\0\0\0\0",
        b"\0\7\0\0\0x",
        b"\2\7\0\0\0",
        b"\1\0",
        b"\3",
        b"\xff" * 40,
    ],
)
def test_strange_messages_break_it(strange: bytes) -> None:
    wire = Wire()
    wire.other.deliver(strange)
    assert wire.other.ended()
    with pytest.raises(BrokenPipeError):
        wire.other.send([b"x"])


def test_too_much_breaks_it() -> None:
    wire = Wire()
    for number in range(zenoh_pipe.WINDOW // zenoh_pipe.PIECE + 1):
        head = b"\0" + number.to_bytes(4, "little")
        wire.other.deliver(head + bytes(zenoh_pipe.PIECE))
    assert wire.other.ended()


def test_waiting_has_an_end() -> None:
    wire = Wire()
    wire.one.limit_waiting(0.01, sends=False)
    with pytest.raises(BlockingIOError):
        wire.one.recv_into(memoryview(bytearray(1)))
    wire.one.limit_waiting(None)
    woken: list[int] = []
    reader = threading.Thread(
        target=lambda: woken.append(wire.one.recv_into(memoryview(bytearray(1))))
    )
    reader.start()
    wire.one.interrupt()
    reader.join(20)
    assert woken == [0]
    with pytest.raises(BrokenPipeError):
        wire.one.send([b"x"])
    wire.one.close()
    wire.one.close()
    assert wire.other.recv_into(memoryview(bytearray(1))) == 0


def test_the_first_byte_can_be_looked_at() -> None:
    wire = Wire()
    wire.one.send([b"xy"])
    assert wire.other.peek() == ord("x") and read(wire.other, 2) == b"xy"
    wire.one.close()
    assert wire.other.peek() == -1


@pytest.mark.parametrize(
    ("level", "priority"),
    [
        ("LOW", "DATA_LOW"),
        ("NORM", "DATA"),
        ("HIGH", "INTERACTIVE_HIGH"),
        ("CRIT", "REAL_TIME"),
        ("AF21", "DATA_HIGH"),
        ("AF31", "INTERACTIVE_LOW"),
        ("EF", "REAL_TIME"),
    ],
)
def test_priorities(level: str, priority: str) -> None:
    wire = Wire()
    wire.one.send([b"a"])
    wire.one.set_dscp(tos_of(level))
    wire.one.send([b"b"])
    assert priority_of(tos_of(level)) == wire.sent[-1][0] == priority
    assert wire.one.tos() == tos_of(level)
    assert read(wire.other, 2) == b"ab"


def test_a_priority_does_not_change_while_messages_are_on_their_way(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(zenoh_pipe, "CHANGE", 0.01)
    wire = Wire(lambda data: data[:1] == b"\4")
    with pytest.raises(TimeoutError):
        wire.one.set_dscp(tos_of("HIGH"))
    assert wire.one.tos() == 0
