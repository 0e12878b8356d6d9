"""ByteStream: reads in any pieces, large reads without a copy, memory only for what has come."""

from __future__ import annotations

import contextlib
import sys
import time
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.steps import chop, finish, is_waiting, measured, output

from yarpy.errors import LinkClosed, RemoteProtocolError
from yarpy.wire.steps import Steps
from yarpy.wire.stream import (
    BUFFER_SIZE,
    FIRST_GRANT,
    KEPT,
    LARGE,
    ByteStream,
    DatagramStream,
    ObjectStream,
    run,
)

# ---------------------------------------------------------------------------------- read_exact


@pytest.mark.parametrize("piece", [0, 1, 3, 1000])
@pytest.mark.parametrize("count", [0, 1, 8, LARGE, LARGE + 1, BUFFER_SIZE, 3 * BUFFER_SIZE + 7])
def test_read_exact_in_any_pieces(count: int, piece: int) -> None:
    data = bytes(i % 251 for i in range(count))
    stream = ByteStream()
    assert bytes(run(stream.read_exact(count), stream, chop(data, piece))) == data


def test_reads_follow_each_other_across_the_end_of_the_buffer() -> None:
    stream = ByteStream(size=16)
    data = bytes(range(200))
    steps = [stream.read_exact(7) for _ in range(20)]
    got = b""
    feeds = iter(chop(data, 5))
    for step in steps:
        while True:
            try:
                next(step)
            except StopIteration as stop:
                got += stop.value
                break
            stream.feed(next(feeds))
    assert got == data[:140]


def test_large_read_takes_what_was_there_and_leaves_what_follows() -> None:
    stream = ByteStream()
    stream.feed(b"head" + b"x" * 100)
    assert finish(stream.read_exact(4)) == b"head"
    steps = stream.read_exact(LARGE + 5)
    assert is_waiting(steps)
    stream.feed(b"x" * (LARGE + 5 - 100))
    stream_view = finish(steps)
    assert isinstance(stream_view, memoryview)
    assert bytes(stream_view) == b"x" * (LARGE + 5)
    stream.feed(b"tail")
    assert finish(stream.read_exact(4)) == b"tail"


def test_large_read_lands_in_its_final_place() -> None:
    """No copy after arrival: what `get_buffer` gave out is what the reader gets."""
    stream = ByteStream()
    steps = stream.read_exact(50_000)
    assert is_waiting(steps)
    target = stream.get_buffer()
    assert len(target) == 50_000
    target[:3] = b"abc"
    stream.buffer_updated(50_000)
    view = finish(steps)
    assert bytes(view[:3]) == b"abc"
    target[0] = ord("z")
    assert view[0] == ord("z")


def receive_large(stream: ByteStream, byte: bytes, size: int = 50_000) -> memoryview:
    steps = stream.read_exact(size)
    came = 0
    while came < size:
        assert is_waiting(steps)
        room = len(stream.get_buffer())
        stream.get_buffer()[:] = byte * room
        stream.buffer_updated(room)
        came += room
    view = finish(steps)
    assert isinstance(view, memoryview)
    return view


def test_large_buffer_is_used_again_once_nobody_holds_it() -> None:
    stream = ByteStream()
    first = receive_large(stream, b"x")
    kept = first[10:20]  # somebody still looks at a part of it
    owner = id(first.obj)
    del first
    assert id(receive_large(stream, b"x").obj) != owner
    del kept
    assert id(receive_large(stream, b"x").obj) == owner


def test_held_message_is_safe_however_references_are_counted(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Python 3.14 counts one less for what a function was handed; others count none at all."""
    real = sys.getrefcount
    monkeypatch.setattr(sys, "getrefcount", lambda thing: real(thing) - 2)
    stream = ByteStream()
    held = receive_large(stream, b"a")
    for byte in (b"b", b"c", b"d"):
        receive_large(stream, byte)
    assert bytes(held) == b"a" * 50_000


def test_part_of_a_message_keeps_its_buffer() -> None:
    """As numpy's view of a picture inside does, when the message itself has gone."""
    stream = ByteStream()
    view = receive_large(stream, b"a")
    part = view[100:200].cast("H")
    view.release()
    for byte in (b"b", b"c", b"d"):
        receive_large(stream, byte)
    assert bytes(part) == b"a" * 100


@pytest.mark.parametrize("whole", [True, False])
def test_array_of_a_message_keeps_its_buffer(whole: bool) -> None:
    """One that is made by `numpy.ndarray` holds the bytearray, and no view of it."""
    stream = ByteStream()
    view = receive_large(stream, b"a")
    array = np.ndarray((100, 100), np.uint8, view if whole else view[5:], 7)
    del view
    for byte in (b"b", b"c", b"d", b"e", b"f"):
        receive_large(stream, byte)
    assert (array == ord("a")).all()


def test_flood_of_large_messages_takes_the_memory_of_two() -> None:
    stream = ByteStream()
    with measured() as peak:
        for _ in range(50):
            receive_large(stream, b"x", 1 << 20)
    assert peak.bytes < 2.5 * (1 << 20)


def test_what_was_read_too_far_is_put_back() -> None:
    stream = ByteStream()
    steps = stream.read_exact(8)
    assert is_waiting(steps)
    stream.feed(b"GET /x12")
    assert finish(steps) == b"GET /x12"
    stream.unread(3)
    stream.feed(b"3")
    assert finish(stream.read_exact(4)) == b"x123"


# ---------------------------------------------------------------------------------- limits


def test_announced_length_takes_no_memory_before_bytes_arrive() -> None:
    stream = ByteStream()
    steps = stream.read_exact(1 << 30)
    with measured() as peak:
        assert is_waiting(steps)
    assert peak.bytes <= FIRST_GRANT + 10_000


def test_buffer_beyond_the_first_grant_grows_with_what_came() -> None:
    stream = ByteStream()
    size = 64 * FIRST_GRANT
    steps = stream.read_exact(size)
    assert is_waiting(steps)
    came = 0
    while came < size:
        room = stream.get_buffer()
        assert len(room) <= max(FIRST_GRANT, came)
        part = min(len(room), FIRST_GRANT)
        room[:part] = bytes([came // FIRST_GRANT]) * part
        stream.buffer_updated(part)
        came += part
        del room
        if came < size:
            assert is_waiting(steps)
    view = finish(steps)
    assert len(view) == size
    assert [view[i * FIRST_GRANT] for i in range(64)] == list(range(64))


def test_peer_that_has_sent_a_large_message_gets_the_memory_for_one_at_once() -> None:
    stream = ByteStream()
    held = [receive_large(stream, b"a", 1_000_000)]
    steps = stream.read_exact(1_000_000)
    assert is_waiting(steps)
    assert len(stream.get_buffer()) == 1_000_000
    stream.feed(bytes(1_000_000))
    held.append(finish(steps))
    stream.forget()
    steps = stream.read_exact(1_000_000)
    assert is_waiting(steps)
    assert len(stream.get_buffer()) == FIRST_GRANT


def test_memory_of_a_very_large_message_without_a_length_is_given_back() -> None:
    stream = ByteStream()
    size = 2 * KEPT
    steps = stream.read_parsed(lambda view: (b"", size) if len(view) >= size else size)
    while len(stream.buffer) < size or stream.waiting < size:
        assert is_waiting(steps)
        stream.feed(bytes(len(stream.get_buffer())))
    finish(steps)
    assert len(stream.buffer) == BUFFER_SIZE
    stream.feed(b"next")
    assert finish(stream.read_exact(4)) == b"next"


def test_length_beyond_the_limit_is_refused_at_once() -> None:
    stream = ByteStream(limit=100_000)
    with pytest.raises(RemoteProtocolError, match="limit is 100000"):
        next(stream.read_exact(100_001))


@pytest.mark.parametrize("announced", [1 << 30, (1 << 30) + 1])
def test_parsed_read_takes_no_memory_before_bytes_arrive(announced: int) -> None:
    stream = ByteStream()
    stream.feed(b"1234")
    steps = stream.read_parsed(lambda view: announced)
    with measured() as peak:
        if announced > stream.limit:
            with pytest.raises(RemoteProtocolError, match="limit"):
                next(steps)
        else:
            assert is_waiting(steps)
            for _ in range(4):
                stream.feed(bytes(len(stream.get_buffer())))
                assert is_waiting(steps)
    # what came is 64 + 64 + 128 + 256 KiB; the next buffer is twice as long as all of it
    assert peak.bytes < 3 * 16 * BUFFER_SIZE


# ---------------------------------------------------------------------------------- read_parsed


def framed(view: memoryview) -> tuple[bytes, int] | int:
    """A length in two bytes, then so many bytes."""
    if len(view) < 2:
        return 2
    size = 2 + int.from_bytes(view[:2], "little")
    return (bytes(view[2:size]), size) if len(view) >= size else size


@pytest.mark.parametrize("piece", [0, 1, 700])
@pytest.mark.parametrize("size", [0, 1, 500, 60_000])
def test_read_parsed_in_any_pieces(size: int, piece: int) -> None:
    stream = ByteStream(size=64)
    body = bytes(i % 251 for i in range(size))
    data = size.to_bytes(2, "little") + body
    assert run(stream.read_parsed(framed), stream, chop(data, piece)) == body


def test_read_parsed_of_an_end_that_is_found_bit_by_bit() -> None:
    """Copies what has come a few times, not once for every few bytes."""
    size = 1 << 20
    stream = ByteStream()
    steps = stream.read_parsed(lambda view: (b"all", size) if len(view) >= size else len(view) + 5)
    assert is_waiting(steps)
    buffers, fed = 0, 0
    before: object = stream.buffer
    while fed < size:
        room = stream.get_buffer()
        count = min(len(room), size - fed)
        stream.feed(bytes(count))
        fed += count
        try:
            assert next(steps) is None
        except StopIteration as stop:
            assert stop.value == b"all"
        buffers += stream.buffer is not before
        before = stream.buffer
    assert fed == size and buffers < 12


# ---------------------------------------------------------------------------------- read_line

LINES = [
    (b"hello\n", b"hello"),
    (b"hello\r\n", b"hello"),
    (b"\n", b""),
    (b"\r\n", b""),
    (b"a\rb\0c\r\n", b"abc"),  # CR and NUL are dropped wherever they are
    (b"one\\\ntwo\n", b"onetwo"),  # a backslash joins lines
    (b"one\\\r\ntwo\r\n", b"onetwo"),
    (b"one\\\\\n", b"one\\\\"),  # an escaped one does not
    (b"one\\\\\\\ntwo\n", b"one\\\\two"),
    (b"\\\n\\\n\\\nx\n", b"x"),
    (b"a\\b\n", b"a\\b"),
    ("h\u00e9llo \u4f60\n".encode(), "h\u00e9llo \u4f60".encode()),
    (b"\xff\xfe\n", b"\xff\xfe"),
]


@pytest.mark.parametrize("piece", [0, 1, 2])
@pytest.mark.parametrize(("data", "line"), LINES, ids=repr)
def test_read_line(data: bytes, line: bytes, piece: int) -> None:
    stream = ByteStream()
    assert run(stream.read_line(), stream, chop(data, piece)) == line


def test_line_is_limited() -> None:
    stream = ByteStream()
    assert run(stream.read_line(limit=5), stream, [b"12345\n"]) == b"12345"
    with pytest.raises(RemoteProtocolError, match="more than 5 bytes"):
        run(stream.read_line(limit=5), stream, [b"123456\n"])


def test_line_without_end_is_not_collected_beyond_its_limit() -> None:
    stream = ByteStream()
    steps = stream.read_line(limit=100_000)
    with measured() as peak, pytest.raises(RemoteProtocolError):
        for _ in range(1000):
            next(steps)
            stream.feed(b"x" * 10_000)
    assert peak.bytes < 400_000


@pytest.mark.skipif(
    sys.platform == "win32", reason="the clock of a process moves every 16 ms there: too coarse"
)
@pytest.mark.parametrize(
    "unit", [b"x" * 100 + b"\\\n", b"\\\\\\\n", b"\\\n", b"abc\\\\\\\n", b"\r"], ids=repr
)
def test_long_lines_cost_no_more_per_byte(unit: bytes) -> None:
    """Joined lines and rows of backslashes are looked at once."""

    def cost(count: int) -> float:
        stream = ByteStream()
        data = unit * count + b"end\n"
        start = time.process_time()
        run(stream.read_line(limit=1 << 24), stream, chop(data, 10_000))
        return time.process_time() - start

    small = min(cost(10_000) for _ in range(3))
    large = min(cost(80_000) for _ in range(2))
    assert large < 8 * 3 * max(small, 0.002)


# ---------------------------------------------------------------------------------- skip, end


@pytest.mark.parametrize("piece", [0, 1, 7])
@pytest.mark.parametrize("count", [0, 1, 10, 60_000])
def test_skip_leaves_what_follows(count: int, piece: int) -> None:
    stream = ByteStream()
    run(stream.skip(count), stream, chop(bytes(count), piece))
    stream.feed(b"next")
    assert finish(stream.read_exact(4)) == b"next"


def test_skip_holds_nothing() -> None:
    stream = ByteStream()
    piece = bytes(50_000)
    with measured() as peak:
        run(stream.skip(20 * len(piece)), stream, [piece] * 20)
    assert peak.bytes < 10_000


def test_end_between_messages_and_inside_one_are_told_apart() -> None:
    stream = ByteStream()
    with pytest.raises(LinkClosed, match=r"closed the connection$"):
        run(stream.read_exact(8), stream)
    stream = ByteStream()
    with pytest.raises(LinkClosed, match="in the middle of a message"):
        run(stream.read_exact(8), stream, [b"123"])
    stream = ByteStream()
    with pytest.raises(LinkClosed, match="in the middle of a message"):
        run(stream.read_exact(100_000), stream, [b"123"])
    stream = ByteStream()
    with pytest.raises(LinkClosed):
        run(stream.read_line(), stream, [b"half a line"])


def test_what_arrived_before_the_end_can_still_be_read() -> None:
    stream = ByteStream()
    stream.feed(b"12345678")
    stream.feed_eof()
    assert finish(stream.read_exact(8)) == b"12345678"
    with pytest.raises(LinkClosed):
        next(stream.read_exact(1))


# ---------------------------------------------------------------------------------- output


def test_output_keeps_its_order_and_its_buffers() -> None:
    stream = ByteStream()
    big = bytearray(100_000)
    assert not stream.pending
    stream.write(b"a", big)
    stream.write(b"b")
    assert stream.pending
    pieces = stream.take_output()
    assert pieces[1] is big
    assert b"".join(pieces) == b"a" + big + b"b"
    assert not stream.pending
    assert output(stream) == b""


def test_feed_refuses_more_than_there_is_room_for() -> None:
    stream = ByteStream(size=16)
    with pytest.raises(BufferError):
        stream.feed(bytes(17))


# ---------------------------------------------------------------------------------- other streams


def test_datagram_stream_keeps_borders() -> None:
    stream = DatagramStream()
    stream.feed(b"one")
    room = stream.get_buffer()
    room[:3] = b"two"
    stream.buffer_updated(3)
    assert stream.waiting == 6
    assert finish(stream.read_datagram()) == b"one"
    assert finish(stream.read_datagram()) == b"two"
    steps = stream.read_datagram()
    assert is_waiting(steps)
    stream.feed_eof()
    with pytest.raises(LinkClosed):
        next(steps)


def test_object_stream_passes_references() -> None:
    stream = ObjectStream()
    item = object()
    stream.feed_object(item)
    assert finish(stream.read_object()) is item
    stream.write_object(item)
    assert stream.take_output() == [item]
    steps = stream.read_object()
    assert is_waiting(steps)
    stream.feed_eof()
    with pytest.raises(LinkClosed):
        next(steps)


# ---------------------------------------------------------------------------------- any mixture

Read = tuple[str, int]
reads = st.lists(
    st.tuples(st.sampled_from(["exact", "skip"]), st.integers(0, 300))
    | st.tuples(st.just("line"), st.integers(0, 300)),
    max_size=12,
)


@given(reads, st.integers(1, 40), st.integers(16, 64))
def test_any_mixture_of_reads_in_any_pieces(plan: list[Read], piece: int, size: int) -> None:
    """However the bytes are cut, every read gets its own."""
    wire, wanted = b"", []
    for number, (kind, length) in enumerate(plan):
        length = min(length, size) if kind == "exact" else length
        body = bytes([65 + number % 26]) * length
        wire += body + (b"\n" if kind == "line" else b"")
        wanted.append(body if kind != "skip" else None)
    stream = ByteStream(size=size)
    feeds = iter(chop(wire, min(piece, size)))
    start: dict[str, Callable[[int], object]] = {
        "exact": stream.read_exact,
        "line": lambda length: stream.read_line(),
        "skip": stream.skip,
    }
    rest = b""
    for (kind, length), expected in zip(plan, wanted, strict=True):
        steps = start[kind](min(length, size) if kind == "exact" else length)
        while True:
            try:
                next(steps)  # type: ignore[call-overload]
            except StopIteration as stop:
                assert stop.value == expected
                break
            rest = rest or next(feeds)
            room = len(stream.get_buffer())
            stream.feed(rest[:room])
            rest = rest[room:]


def test_output_that_could_not_be_sent_comes_first_and_may_be_copied() -> None:
    stream = ByteStream()
    array = bytearray(b"large")
    stream.write(b"head", memoryview(array))
    _, rest = stream.take_output()
    stream.write(b"next")
    stream.put_back([rest])
    assert stream.pending
    stream.snapshot_output()
    array[:] = b"other"
    assert stream.take_output() == [b"large", b"next"]


# ---------------------------------------------------------------------------- interrupted readers


def _parts(stream: ByteStream, large: int) -> Steps[list[bytes]]:
    """A message of small and large parts."""
    found = [bytes((yield from stream.read_exact(5)))]
    for _ in range(2):
        found.append(bytes((yield from stream.read_exact(large))))
        found.append(bytes((yield from stream.read_exact(3))))
    return found


@pytest.mark.parametrize("size", [1, 1000, 70_000])
@pytest.mark.parametrize("large", [100, 100_000])
def test_message_is_read_again_from_its_beginning(large: int, size: int) -> None:
    """Wherever its steps were cut off, nothing is lost."""
    said = b"<small>" + b"a" * (large - 2) + b"one" + b"b" * large + b"two"
    wanted = [said[:5], said[5 : 5 + large], said[5 + large : 8 + large]]
    wanted += [said[8 + large : 8 + 2 * large], said[8 + 2 * large : 11 + 2 * large]]
    chunks = [said[at : at + size] for at in range(0, len(said), size)]
    cuts = range(1, len(chunks) + 1, max(1, len(chunks) // 7))
    stream = ByteStream()
    steps: Steps[list[bytes]] | None = None
    for number, chunk in enumerate(chunks, 1):
        room = memoryview(chunk)
        while room:
            buffer = stream.get_buffer()
            step = min(len(buffer), len(room))
            buffer[:step] = room[:step]
            stream.buffer_updated(step)
            room = room[step:]
            if steps is None:
                stream.begin()
                steps = _parts(stream, large)
            try:
                next(steps)
            except StopIteration as stop:
                assert stop.value == wanted
                return
        if number in cuts:
            assert stream.rewind()
            steps = None
    pytest.fail("the message did not come")


def test_what_was_passed_over_cannot_be_read_again() -> None:
    """More than a buffer full of small parts is not kept for that."""
    stream = ByteStream()
    stream.begin()
    steps = stream.skip(1 << 18)
    for _ in range(1 << 3):
        stream.feed(bytes(1 << 15))
        with contextlib.suppress(StopIteration):
            next(steps)
    assert not stream.rewind()
