"""A pipe through Zenoh, its two ends joined directly: order, room, loss, ends."""

from __future__ import annotations

import threading

import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.wait import HANG, wait_until
from support.zenoh import Line, Wire

from yarpy.peers.zenoh.spare import LARGE
from yarpy.peers.zenoh.tunnel import pipe as zenoh_pipe
from yarpy.peers.zenoh.tunnel.pipe import ZenohPipe, priority_of
from yarpy.qos import tos_of
from yarpy.wire.lending_stream import LendingStream


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
        ("DATA", b"\1\2\0\0\0"),
    ]
    assert read(wire.other, 4) == b"abcd"
    assert wire.other.recv_into(memoryview(bytearray(3))) == 0 and wire.other.ended()
    assert wire.said == [b"\4", b"\3" + b"\3" + bytes(7) + b"\1" + bytes(3)]
    assert wire.lines[0].closed


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
    data = bytes(range(256)) * (3 * zenoh_pipe.FRAGMENT // 256)
    for _ in range(8):
        wire.one.send([b"head", data])
        assert read(wire.other, len(data) + 4) == b"head" + data
    assert max(len(sent) for _, sent in wire.sent) == zenoh_pipe.FRAGMENT + 5


def test_large_messages_of_all_sizes_follow_each_other() -> None:
    wire = Wire()
    large = LARGE
    for size in (large, large + 1, large, 2 * large, 3 * large, large - 1, large):
        data = bytes([size % 251]) * size
        wire.one.send([data[:10], memoryview(data)[10:]])
        assert read(wire.other, size) == data


def test_large_messages_are_lent_where_they_lie() -> None:
    wire = Wire()
    data = bytes(range(256)) * 400
    wire.one.send([b"head", data, b"tail"])
    assert wire.other.borrow(10, 0) is None  # nothing has come yet
    first = read(wire.other, 100)
    lent = wire.other.borrow(len(data), 96)
    assert first[:4] == b"head" and lent is not None and lent.readonly and lent == data
    assert read(wire.other, 4) == b"tail"
    assert wire.other._taken == len(data) + 8


def test_what_would_keep_much_more_than_itself_is_not_lent() -> None:
    wire = Wire()
    data = bytes(1000)
    wire.one.send([data])
    wire.one.send([data])
    assert read(wire.other, 10) == data[:10]
    assert wire.other.borrow(400, 0) is None
    assert wire.other.borrow(1000, 0) is None  # a part of it comes later
    assert wire.other.borrow(600, 11) is None  # so much has not come
    lent = wire.other.borrow(600, 10)
    assert lent == data[:600] and read(wire.other, 1400) == data + data[:400]


@given(
    st.lists(st.sampled_from((1, 100, 20_000, 70_000, 150_000)), max_size=8),
    st.lists(st.integers(1, 200_000), max_size=8),
)
def test_a_stream_reads_the_same_whether_it_is_lent_or_copied(
    reads: list[int], cuts: list[int]
) -> None:
    wire = Wire()
    stream = LendingStream(wire.other.borrow)
    data = bytes(i % 251 for i in range(997)) * (sum(reads) // 997 + 1)
    data = data[: sum(reads)]
    begin = 0
    for cut in (*cuts, len(data)):
        wire.one.send([data[begin : begin + cut]])
        begin += cut
    found = []
    for count in reads:
        steps = stream.read_exact(count)
        try:
            while True:
                next(steps)
                got = wire.other.try_recv_into(stream.get_buffer())
                assert got > 0
                stream.buffer_updated(got)
        except StopIteration as stop:
            found.append(bytes(stop.value))
    assert b"".join(found) == data and not stream.waiting
    assert wire.other._taken == len(data)


def test_a_sender_learns_what_was_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(zenoh_pipe, "CREDIT_INTERVAL", 0.0)
    wire = Wire()
    wire.one.send([b"taken"])
    assert wire.one.taken(5, 0) == (0, False)
    read(wire.other, 5)
    assert wire.one.taken(5, 0) == (5, False)


def test_nobody_sends_more_than_is_wanted() -> None:
    wire = Wire()
    piece = bytes(zenoh_pipe.FRAGMENT)
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
    sender.join(HANG)
    assert read(wire.other, 4) == b"more"


def test_a_sender_that_is_asked_for_too_much_is_not_believed() -> None:
    wire = Wire()
    wire.one.told(b"\3" + b"\xff" * 12)
    for _ in range(zenoh_pipe.WINDOW // zenoh_pipe.FRAGMENT):
        wire.one.send([bytes(zenoh_pipe.FRAGMENT)])
    assert wire.one.try_send([b"x"]) == [b"x"]


def test_small_messages_are_counted_too() -> None:
    wire = Wire()
    for _ in range(zenoh_pipe.MESSAGES):
        assert wire.one.try_send([b"x"]) == []
    assert wire.one.try_send([b"x"]) == [b"x"]
    read(wire.other, zenoh_pipe.MESSAGES)
    assert wire.one.try_send([b"x"]) == []


def test_what_is_lost_breaks_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(zenoh_pipe, "REORDER_TIMEOUT", 0.02)
    wire = Wire(lambda data: data[5:] == b"lost")
    for message in (b"came", b"lost", b"late"):
        wire.one.send([message])
    assert read(wire.other, 4) == b"came"
    assert wire.other.recv_into(memoryview(bytearray(1))) == 0
    assert wire.one.ended() and wire.said[-1] == b"\5"
    with pytest.raises(BrokenPipeError, match="gone"):
        wire.one.send([b"x"])


def test_what_comes_too_early_waits() -> None:
    wire = Wire()
    for number in (2, 0, 1, 3):
        wire.lines[1].inbox.put(b"\0" + bytes([number, 0, 0, 0]) + b"abcd"[number : number + 1])
    assert read(wire.other, 4) == b"abcd"
    wire.lines[1].inbox.put(b"\1\5\0\0\0")
    wire.lines[1].inbox.put(b"\0\4\0\0\0e")
    assert read(wire.other, 1) == b"e"
    assert wire.other.recv_into(memoryview(bytearray(1))) == 0


@pytest.mark.parametrize("strange", [b"\x09", b"\0", b"\0\0\0\0", b"\3\0\0\0\0x", b"\xff" * 9])
def test_strange_messages_break_it(strange: bytes) -> None:
    wire = Wire()
    wire.lines[1].inbox.put(strange)
    assert wire.other.recv_into(memoryview(bytearray(1))) == 0 and wire.other.ended()
    with pytest.raises(BrokenPipeError):
        wire.other.send([b"x"])


@pytest.mark.parametrize("strange", [b"", b"\3\0", b"\0", b"\5", b"\xff" * 40])
def test_strange_reports_break_it(strange: bytes) -> None:
    wire = Wire()
    wire.other.told(strange)
    assert wire.other.ended() and wire.other.recv_into(memoryview(bytearray(1))) == 0


def test_too_much_that_does_not_follow_breaks_it() -> None:
    wire = Wire()
    for number in range(1, zenoh_pipe.MESSAGES + 3):
        wire.lines[1].inbox.put(b"\0" + number.to_bytes(4, "little") + b"x")
    assert wire.other.recv_into(memoryview(bytearray(1))) == 0


def test_nobody_sends_to_who_has_hung_up() -> None:
    wire = Wire()
    wire.other.send([b"last words"])
    wire.other.close()
    assert wire.one.ended()
    with pytest.raises(BrokenPipeError):
        wire.one.send([b"x"])
    assert read(wire.one, 10) == b"last words"


def test_the_other_end_of_a_broken_pipe_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(zenoh_pipe, "RESET_RESEND", 0.01)
    wire = Wire()
    wire.one.break_off("for a test")
    wire.one.close()
    assert wire.other.ended()
    wait_until(lambda: wire.said == [b"\5", b"\5"])


def test_a_session_that_was_closed_ends_it() -> None:
    class Closed(Line):
        def put(self, data: bytes | bytearray) -> None:
            raise RuntimeError("closed")

        def recv(self) -> bytes:
            raise RuntimeError("closed")

        tell = put

    pipe = ZenohPipe(("a", 0), ("b", 1), Closed(Wire(), "a"))
    assert pipe.recv_into(memoryview(bytearray(1))) == 0
    with pytest.raises(BrokenPipeError, match="closed"):
        pipe.send([b"x"])
    pipe.close()


def test_waiting_has_an_end() -> None:
    wire = Wire()
    wire.one.limit_waiting(0.01, sends=False)
    for _ in range(3):
        with pytest.raises(BlockingIOError):
            wire.one.recv_into(memoryview(bytearray(1)))
    wire.one.limit_waiting(None)
    woken: list[int] = []
    reader = threading.Thread(
        target=lambda: woken.append(wire.one.recv_into(memoryview(bytearray(1))))
    )
    reader.start()
    wire.one.interrupt()
    reader.join(HANG)
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


def test_a_signal_handler_closes_it_above_a_frame_that_sends(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """It used to wait for ever for a lock of that frame. The other end gets no goodbye: it cannot
    know whether that message came."""
    wire = Wire()
    put = wire.lines[0].put

    def interrupted(data: bytes | bytearray) -> None:
        wire.one.close()
        put(data)

    monkeypatch.setattr(wire.lines[0], "put", interrupted)
    sending = threading.Thread(target=wire.one.send, args=([b"ab"],), daemon=True)
    sending.start()
    sending.join(HANG)
    assert not sending.is_alive()
    assert wire.lines[0].closed and wire.other.ended()
    with pytest.raises(BrokenPipeError):
        wire.one.send([b"c"])
