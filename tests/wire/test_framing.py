"""The framing of the binary carriers: golden bytes both ways, in any pieces; hostile bytes.

Rules: each golden row is encoded, decoded, and decoded fed one byte at a time.
"""

from __future__ import annotations

import struct
import sys
import time
from collections.abc import Iterable

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from support.capture import load_capture
from support.message import bottles, kinds
from support.steps import chop, finish, is_waiting, measured, output

from yarpy.data.bottle import Bottle
from yarpy.data.python.description import KEY
from yarpy.data.value import Vocab
from yarpy.errors import AccessRefused, DecodeError, LinkClosed, RemoteProtocolError, YarpError
from yarpy.log import readable
from yarpy.wire import framing
from yarpy.wire.message import Message, Packet
from yarpy.wire.stream import FIRST_GRANT, LARGE, ByteStream, run

NESTED = [["a", [1, 2]], [1.5, "x y"], Vocab("set")]


def captured(name: str, step: int) -> bytes:
    return load_capture(name).steps[step].data


# key, value, envelope, the bytes of C++ 3.9.1
MESSAGES: list[tuple[str, object, str, bytes]] = [
    ("D", [1], "", captured("conn_tcp_disconnect", 2)),
    ("D", [], "1 0.25", captured("conn_tcp_stream_envelope", 2)),
    ("D", [1, "ping", 3.14], "2 1.25", captured("conn_tcp_stream_envelope", 4)),
    ("D", NESTED, "3 2.25", captured("conn_tcp_stream_envelope", 6)),
    ("d", [], "", captured("conn_tcp_rpc", 2)),
    ("d", [1, "ping", 3.14], "", captured("conn_tcp_rpc", 4)),
    ("d", NESTED, "", captured("conn_tcp_rpc", 6)),
    ("d", NESTED, "9 1.5", captured("conn_tcp_rpc_envelope", 6)),
    ("a", [Vocab("ver")], "", captured("admin_binary", 4)),
    ("a", ["ver"], "", captured("admin_binary", 6)),
    ("a", [Vocab("list"), Vocab("out"), "/cap/in"], "", captured("admin_binary", 12)),
    (
        "D",
        ["hi", 5],
        "",
        bytes.fromhex(
            "59410a00000052500201ffffffffffffffff080000001a00000000000000000000007e440001"
            "00010000020000000400000002000000686901000000 05000000".replace(" ", "")
        ),
    ),
]
IDS = [f"{key}-{value}-{envelope}" for key, value, envelope, _ in MESSAGES]


def decode(data: bytes, piece: int = 0, limit: int = 1 << 30) -> Message:
    stream = ByteStream(limit)
    message = run(framing.read_message(stream), stream, chop(data, piece))
    assert stream.waiting == 0
    return message


def encode(value: object, envelope: str = "", key: str = "D") -> bytes:
    return b"".join(bytes(b) for b in framing.encode(Packet(value, envelope.encode(), key)))


@pytest.mark.parametrize(("key", "value", "envelope", "data"), MESSAGES, ids=IDS)
def test_golden_encode(key: str, value: object, envelope: str, data: bytes) -> None:
    assert encode(value, envelope, key) == data


@pytest.mark.parametrize("piece", [0, 1, 5])
@pytest.mark.parametrize(("key", "value", "envelope", "data"), MESSAGES, ids=IDS)
def test_golden_decode(key: str, value: object, envelope: str, data: bytes, piece: int) -> None:
    message = decode(data, piece)
    assert message.key == key
    assert message.value == value
    assert message.envelope == envelope
    assert message.spelling == "binary"


@pytest.mark.parametrize(("key", "value", "envelope", "data"), MESSAGES, ids=IDS)
def test_plain_messages_are_parsed_in_place(
    key: str, value: object, envelope: str, data: bytes
) -> None:
    stream = ByteStream()
    stream.feed(data + b"next")
    message = framing.parse_plain(stream)
    assert message is not None
    assert (message.key, message.value, message.envelope) == (key, value, envelope)
    assert stream.waiting == 4


STAMPED = encode([1, "ping"], "2 1.25")


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (STAMPED.replace(b" 2 1.25", b" 2\r1.25"), ("D", "21.25")),
        (STAMPED.replace(b"D 2 1.25", b"d  2 1.2"), ("d", "2 1.2")),
        (STAMPED.replace(b"D 2 1.25", b"D\xff2 1.25"), ("D", "2 1.25")),
    ],
)
def test_odd_envelopes_are_parsed_in_place(data: bytes, message: tuple[str, str]) -> None:
    stream = ByteStream()
    stream.feed(data)
    found = framing.parse_plain(stream)
    assert found is not None
    assert (found.key, found.envelope) == message
    other = decode(data, 1)
    assert (other.key, other.envelope, other.payload) == (*message, found.payload)


@pytest.mark.parametrize(
    "data",
    [
        STAMPED.replace(b"D 2 1.25", b"D 2\0001.25"),
        STAMPED.replace(b"D 2 1.25\0", b"D 2 1.255"),
        STAMPED.replace(b"D 2 1.25", b"q 2 1.25"),
        STAMPED.replace(b"~\0\0\1", b"~\0\0\2"),
        STAMPED.replace(b"\2\1\xff", b"\2\2\xff"),
        STAMPED.replace(struct.pack("<i", 17), struct.pack("<i", -17), 1),
    ],
)
def test_what_is_no_envelope_is_left_alone(data: bytes) -> None:
    assert data != STAMPED
    stream = ByteStream()
    stream.feed(data)
    assert framing.parse_plain(stream) is None
    assert stream.waiting == len(data)


@pytest.mark.parametrize(("key", "value", "envelope", "data"), MESSAGES, ids=IDS)
def test_plain_parse_wants_the_whole_message(
    key: str, value: object, envelope: str, data: bytes
) -> None:
    for size in range(len(data)):
        stream = ByteStream()
        stream.feed(data[:size])
        assert framing.parse_plain(stream) is None
        assert stream.waiting == size


# ---------------------------------------------------------------------------------- commands

COMMANDS = [
    # key, text or envelope, bytes
    ("D", b"", bytes.fromhex("000000007e440001")),
    ("d", b"", bytes.fromhex("000000007e640001")),
    ("a", b"", bytes.fromhex("000000007e610001")),
    ("q", b"", bytes.fromhex("020000007e0000017100")),
    ("D", b"7 1234.5", bytes.fromhex("0b0000007e000001 44203720313233342e3500")),
    ("/", b"dest", b"\x06\0\0\0~\0\0\1/dest\0"),
]


@pytest.mark.parametrize(("key", "text", "data"), COMMANDS)
def test_golden_commands(key: str, text: bytes, data: bytes) -> None:
    envelope, rest = (text, b"") if key == "D" else (b"", text)
    assert framing.encode_command(key, envelope, rest) == data
    for piece in (0, 1):
        stream = ByteStream()
        found = run(framing.read_command(stream), stream, chop(data, piece))
        assert found is not None
        message, used = found
        assert message.key == key
        assert (message.envelope or message.text).encode() == text
        assert used == len(data)


@pytest.mark.parametrize("key", ["D", "d", "a", "q", "r", "*", "?", "z", "~"])
def test_key_inside_the_eight_bytes_means_the_same(key: str) -> None:
    stream = ByteStream()
    data = b"\0\0\0\0~" + key.encode() + b"\0\1"
    found = run(framing.read_command(stream), stream, [data])
    assert found is not None
    assert found[0].key == key
    assert found[1] == 8


def test_command_without_tilde_is_none() -> None:
    stream = ByteStream()
    assert run(framing.read_command(stream), stream, [b"\0\0\0\0XD\0\1"]) is None


@pytest.mark.parametrize("length", [0, 1, 8, 1000, -1])
@pytest.mark.parametrize("piece", [0, 1])
def test_length_of_a_command_text_is_not_believed(length: int, piece: int) -> None:
    data = struct.pack("<i", length) + b"~\0\0\1D 7\r 1.5\0"
    stream = ByteStream()
    found = run(framing.read_command(stream), stream, chop(data, piece))
    assert found is not None
    assert found[0].envelope == "7 1.5"
    assert found[1] == len(data)


def test_command_text_is_limited() -> None:
    stream = ByteStream()
    with pytest.raises(RemoteProtocolError, match="port command of more than"):
        run(framing.read_command(stream), stream, [b"\x05\0\0\0~\0\0\1D", *[b"x" * 5000] * 20])


ENVELOPES = [
    # as the console of C++ showed them; there the one of "do" keeps its blank
    ("d", ""),
    ("d 7 1.5", "7 1.5"),
    ("D 8 2.5", "8 2.5"),
    ("do 9 3.5", "9 3.5"),
    ("dx10 4.5", "10 4.5"),
    ("do", ""),
    ("D ", ""),
]


@pytest.mark.parametrize(("text", "envelope"), ENVELOPES)
def test_envelope_begins_at_the_third_character(text: str, envelope: str) -> None:
    assert framing.parse_command(text).envelope == envelope


def test_parse_command_takes_anything() -> None:
    assert framing.parse_command("").key == ""
    assert framing.parse_command("/a/b").text == "a/b"
    assert framing.parse_command("~/a").key == "~"
    assert framing.parse_command("quit").key == "q"


def test_quit_is_as_captured() -> None:
    assert captured("conn_tcp_stream_envelope", 8) == framing.QUIT
    assert decode(framing.QUIT).key == "q"
    assert decode(framing.QUIT, 1).key == "q"


def test_message_that_is_a_command_alone() -> None:
    data = b"".join(framing.encode_text_command("r"))
    assert decode(data).key == "r"
    data = b"".join(framing.encode_text_command("/", b"dest"))
    message = decode(data, 1)
    assert (message.key, message.text) == ("/", "dest")


# ---------------------------------------------------------------------------------- numbers, names


def test_numbers() -> None:
    assert framing.number(10) == framing.INDEX == b"YA\x0a\0\0\0RP"
    assert framing.ACK == b"YA\0\0\0\0RP"
    assert framing.parse_number(framing.number(21002)) == 21002
    for bad in (b"XA\0\0\0\0RP", b"YA\0\0\0\0RX", b"YA\xff\xff\xff\xffRP", bytes(8)):
        assert framing.parse_number(bad) == -1


NAMES = [
    # name or specifier, bytes
    ("/cap/out", b"\x09\0\0\0/cap/out\0"),
    ("", b"\x01\0\0\0\0"),
    (
        "/w (recv foo) (file a b lua) (x 1)",
        b"\x23\0\0\0/w (recv foo) (file a b lua) (x 1)\0",
    ),
]


@pytest.mark.parametrize("piece", [0, 1])
@pytest.mark.parametrize(("name", "data"), NAMES)
def test_golden_names(name: str, data: bytes, piece: int) -> None:
    assert framing.encode_name(name) == data
    stream = ByteStream()
    assert run(framing.read_name(stream), stream, chop(data, piece)) == name


@pytest.mark.parametrize(
    ("data", "name", "left"),
    [
        (b"\x02\0\0\0/x", "/x", 0),  # without its NUL
        (b"\0\0\0\0/x\0", "/", 2),  # clamped to one byte
        (b"\xfb\xff\xff\xff/x\0", "/", 2),
        (b"\x88\x13\0\0" + b"x" * 5000, "x" * 1000, 4000),
        (b"\x05\0\0\0a\0b\0c", "a", 0),
        (b"\x03\0\0\0\xff\xfe\0", "\ufffd\ufffd", 0),
    ],
)
def test_odd_names_are_read_as_cpp_reads_them(data: bytes, name: str, left: int) -> None:
    stream = ByteStream()
    assert run(framing.read_name(stream), stream, [data]) == name
    assert stream.waiting == left


# ---------------------------------------------------------------------------------- odd indexes


def index(sizes: list[int], replies: int = 1, filler: bytes = b"\xff" * 8) -> bytes:
    """A message index with these block lengths."""
    head = framing.INDEX + bytes((len(sizes), replies)) + filler
    return head + struct.pack(f"<{len(sizes)}i", *sizes) + bytes(4 * replies)


COMMAND = b"\0\0\0\0~D\0\1"
FIVE = struct.pack("<3i", 257, 1, 5)  # the Bottle (5)

ODD = [
    # what is odd, the message
    ("one block", index([20]) + COMMAND + FIVE),
    ("no reply lengths", index([8, 12], replies=0) + COMMAND + FIVE),
    ("two reply lengths", index([8, 12], replies=2) + COMMAND + FIVE),
    ("255 reply lengths", index([8, 12], replies=255) + COMMAND + FIVE),
    ("zero filler", index([8, 12], filler=bytes(8)) + COMMAND + FIVE),
    ("many blocks", index([4] * 5) + COMMAND + FIVE),
    ("empty blocks", index([8, 0, 12, 0]) + COMMAND + FIVE),
    ("255 blocks", index([8, 12] + [0] * 253) + COMMAND + FIVE),
    ("lengths too small", index([8, 4]) + COMMAND + FIVE),
    ("no blocks", index([]) + COMMAND + FIVE),
    ("no lengths", index([0, 0]) + COMMAND + FIVE),
    ("garbage in front", b"XXXXXXXX" * 3 + index([8, 12]) + COMMAND + FIVE),
    ("an acknowledgement in front", framing.ACK + index([8, 12]) + COMMAND + FIVE),
]


@pytest.mark.parametrize("piece", [0, 1, 8])
@pytest.mark.parametrize(("what", "data"), ODD, ids=[what for what, _ in ODD])
def test_odd_index_is_read_as_cpp_reads_it(what: str, data: bytes, piece: int) -> None:
    assert decode(data, piece).value == [5]


@pytest.mark.parametrize("piece", [0, 1])
def test_trailing_bytes_belong_to_their_message(piece: int) -> None:
    """C++ takes them for the next index; here the announced length is believed."""
    data = index([8, 20]) + COMMAND + FIVE + b"ZZZZZZZZ" + encode([6])
    stream = ByteStream()
    feeds = iter(chop(data, piece))
    values = []
    while len(values) < 2:
        steps = framing.read_message(stream)
        while True:
            try:
                next(steps)
            except StopIteration as stop:
                values.append(stop.value.value)
                break
            stream.feed(next(feeds))
    assert values == [[5], [6]]


@pytest.mark.parametrize("piece", [0, 1])
def test_broken_command_is_skipped_with_its_message(piece: int) -> None:
    bad = index([8, 12]) + b"\0\0\0\0XD\0\1" + FIVE
    assert decode(bad + encode([6]), piece).value == [6]


@pytest.mark.parametrize("piece", [0, 1])
def test_unknown_command_is_handed_on_without_its_payload(piece: int) -> None:
    data = index([8, 12]) + b"\0\0\0\0~z\0\1" + FIVE
    assert decode(data, piece).key == "z"


def test_more_blocks_than_an_index_can_name_become_one() -> None:
    class Crumbs:
        def to_wire(self) -> tuple[bytes, ...]:
            return tuple(FIVE[i : i + 1] for i in range(12)) + (b"",) * 500

    data = encode(Crumbs())
    assert data[8] == 2
    assert decode(data).value == [5]


# ---------------------------------------------------------------------------------- large payloads


@pytest.mark.parametrize("size", [0, 100, LARGE - 20, LARGE, LARGE + 1, 70_000, 1 << 20])
@pytest.mark.parametrize("envelope", ["", "5 2.5"])
def test_payload_of_any_size(size: int, envelope: str) -> None:
    value = [bytes(size), "end"]
    data = encode(value, envelope)
    message = decode(data, 0 if size < 60_000 else 50_000)
    assert message.value == value
    assert message.envelope == envelope


def test_large_payload_is_neither_copied_out_nor_in() -> None:
    pixels = bytearray(1 << 20)
    blocks = framing.encode(Packet([bytes(0), memoryview(pixels)]))
    assert any(isinstance(b, memoryview) and b.obj is pixels for b in blocks)
    stream = ByteStream()
    steps = framing.read_message(stream)
    data = b"".join(blocks)
    assert is_waiting(steps)
    position = 0
    while position < len(data):
        room = stream.get_buffer()
        part = data[position : position + len(room)]
        room[: len(part)] = part
        del room
        stream.buffer_updated(len(part))
        position += len(part)
        if position < len(data):
            assert is_waiting(steps)
    message = finish(steps)
    assert isinstance(message.payload, memoryview)
    assert not isinstance(message.payload.obj, bytes)


# ---------------------------------------------------------------------------------- limits

GIB = 1 << 30


def huge_blob() -> bytes:
    """The beginning of a Bottle that holds one blob of nearly a gigabyte."""
    return struct.pack("<4i", 256, 1, 12, GIB - 100)


ANNOUNCED = [
    ("index", index([8, GIB - 8]) + COMMAND),
    ("index with envelope", index([16, GIB - 16]) + b"\x08\0\0\0~\0\0\1D 1 0.5\0"),
    ("payload", index([]) + COMMAND + huge_blob()),
    ("unknown command", index([8, GIB - 8]) + b"\0\0\0\0~z\0\1"),
    ("broken command", index([8, GIB - 8]) + b"\0\0\0\0Xz\0\1"),
]


@pytest.mark.parametrize(("what", "data"), ANNOUNCED, ids=[what for what, _ in ANNOUNCED])
def test_a_gigabyte_announced_takes_little_memory(what: str, data: bytes) -> None:
    stream = ByteStream(GIB)
    stream.feed(data)
    steps = framing.read_message(stream)
    with measured() as peak:
        assert is_waiting(steps)
    assert peak.bytes < FIRST_GRANT + 100_000


@pytest.mark.parametrize(
    "data",
    [
        index([8, GIB]) + COMMAND,
        index([GIB, GIB, GIB]) + COMMAND,
        index([(1 << 31) - 1] * 255) + COMMAND,
        index([8, -5]) + COMMAND,
        index([-8, 12]) + COMMAND,
    ],
)
def test_impossible_lengths_are_refused(data: bytes) -> None:
    stream = ByteStream(GIB)
    with pytest.raises(RemoteProtocolError):
        run(framing.read_message(stream), stream, [data])


def test_limit_counts_for_payloads_without_length() -> None:
    stream = ByteStream(1000)
    with pytest.raises(YarpError, match="limit"):
        run(framing.read_payload(stream), stream, [huge_blob()])


def test_replies_are_walked_to_their_end() -> None:
    for value in ([], [1], NESTED, [b"x" * 100_000], list(range(40_000))):
        reply = b"".join(bytes(b) for b in Packet(value).blocks)
        stream = ByteStream()
        pieces = chop(reply + b"next", 1000)
        payload = run(framing.read_payload(stream), stream, pieces)
        assert Bottle.from_bytes(payload) == value
        assert output(stream) == b""


@settings(max_examples=200)
@given(bottles | bottles.map(lambda bottle: [bottle]) | st.integers() | st.text(max_size=9))
@example(Bottle([0, 0, KEY]))
def test_reply_that_is_there_is_what_walking_to_its_end_gives(value: object) -> None:
    try:
        reply = b"".join(Packet(value).blocks)
    except (TypeError, OverflowError):
        return
    stream = ByteStream()
    payload = run(framing.read_payload(stream), stream, [reply + framing.ACK])
    stream = ByteStream()
    stream.feed(reply + framing.ACK)
    message = framing.parse_reply(stream)
    if message is None:
        assert stream.waiting == len(reply) + 8
        described = KEY.encode() in reply  # perhaps, and then its end has to be found first
        assert len(reply) < 12 or reply[:4] != b"\0\1\0\0" or reply[4] == 4 or described
        return
    assert stream.waiting == 8
    assert message.payload == payload
    wanted = Message("d", payload).value
    assert message.value == wanted
    assert kinds(message.value) == kinds(wanted)
    for size in range(len(reply)):
        part = ByteStream()
        part.feed(reply[:size])
        assert framing.parse_reply(part) is None
        assert part.waiting == size


def test_reply_beyond_the_limit_is_left_to_be_refused() -> None:
    stream = ByteStream(100)
    stream.feed(b"".join(Packet(["x" * 200]).blocks))
    assert framing.parse_reply(stream) is None


@settings(max_examples=200)
@given(st.binary(max_size=60) | bottles.map(lambda b: b"".join(Packet(b).blocks)), st.data())
def test_reply_of_noise_is_nothing_or_what_walking_gives(data: bytes, draw: st.DataObject) -> None:
    changed = bytearray(data)
    if changed:
        changed[draw.draw(st.integers(0, len(changed) - 1))] = draw.draw(st.integers(0, 255))
    stream = ByteStream()
    stream.feed(changed)
    message = framing.parse_reply(stream)
    if message is None:
        assert stream.waiting == len(changed)
        return
    walked = ByteStream()
    assert run(framing.read_payload(walked), walked, [bytes(changed)]) == message.payload


@pytest.mark.parametrize("blocks", [2, 3, 4, 8])
def test_head_of_a_large_message_is_read_in_place_as_it_is_in_pieces(blocks: int) -> None:
    """Every byte of it is changed in turn."""
    parts = [bytes(2 * LARGE // (blocks - 1))] * (blocks - 1)
    whole = encode(ListOfBlocks(parts), "", "D")
    end = 18 + 4 * blocks + 4 + 8
    for at in range(8, end):
        for change in (1, 0x80, 0xFF):
            data = bytearray(whole)
            data[at] ^= change
            rest = chop(bytes(data[end:]), 30_000)
            head = bytes(data[:end])
            assert_alike(outcome_of([*chop(head, 1), *rest]), outcome_of([head, *rest]))


class ListOfBlocks:
    """A value in so many blocks."""

    def __init__(self, parts: list[bytes]) -> None:
        self.parts = parts

    def to_wire(self) -> tuple[bytes, ...]:
        return tuple(self.parts)


# ---------------------------------------------------------------------------------- fuzz


def outcome(data: bytes, piece: int) -> object:
    """What a reader makes of bytes that end: messages, then how it ended."""
    return outcome_of(chop(data, piece))


def outcome_of(pieces: Iterable[bytes]) -> object:
    stream = ByteStream(1 << 16)
    feeds = iter(pieces)
    rest = b""
    found: list[object] = []
    try:
        while True:
            steps = framing.read_message(stream)
            while True:
                try:
                    next(steps)
                except StopIteration as stop:
                    message = stop.value
                    found.append((message.key, message.envelope, bytes(message.payload)))
                    break
                rest = rest or next(feeds, b"")
                if rest:
                    room = len(stream.get_buffer())
                    stream.feed(rest[:room])
                    rest = rest[room:]
                else:
                    stream.feed_eof()
    except YarpError as error:
        found.append(type(error))
    return found


GOLDEN_BYTES = [data for *_, data in MESSAGES] + [data for _, data in ODD] + [framing.QUIT]


@st.composite
def mutated(draw: st.DrawFn) -> bytes:
    """Golden messages, joined, with bytes changed, put in, taken out."""
    data = bytearray(b"".join(draw(st.lists(st.sampled_from(GOLDEN_BYTES), max_size=3))))
    for _ in range(draw(st.integers(0, 4))):
        at = draw(st.integers(0, len(data)))
        kind = draw(st.integers(0, 3))
        if kind == 0 and at < len(data):
            data[at] = draw(st.integers(0, 255))
        elif kind == 1:
            data[at:at] = draw(st.binary(max_size=9))
        elif kind == 2:
            del data[at : at + draw(st.integers(0, 9))]
        else:
            data[at : at + 4] = struct.pack(
                "<i", draw(st.sampled_from([-1, 0, 1, 255, 1 << 15, 1 << 16, 1 << 30, -(1 << 31)]))
            )
    return bytes(data)


@settings(max_examples=300)
@given(mutated())
def test_mutated_messages_end_in_our_errors_however_they_are_cut(data: bytes) -> None:
    whole = outcome(data, 0)
    assert isinstance(whole, list)
    assert isinstance(whole[-1], type)
    assert issubclass(whole[-1], YarpError)
    for size in (1, 7):
        assert_alike(outcome(data, size), whole)


def assert_alike(cut: object, whole: object) -> None:
    """The same, but for one thing: who waits for what a list announced may meet the end of the
    stream before looking at elements that cannot be."""
    if cut != whole:
        assert isinstance(cut, list)
        assert isinstance(whole, list)
        assert cut[:-1] == whole[:-1]
        assert (cut[-1], whole[-1]) == (LinkClosed, DecodeError)


@given(st.binary(max_size=200))
def test_noise_ends_in_our_errors(data: bytes) -> None:
    assert_alike(outcome(data, 1), outcome(data, 0))


@settings(max_examples=50)
@given(bottles, st.sampled_from(["D", "d"]), st.sampled_from(["", "1 2.5", "any text"]))
def test_every_bottle_comes_back(bottle: Bottle, key: str, envelope: str) -> None:
    data = encode(bottle, envelope, key)
    message = decode(data, 3)
    assert message.key == key
    assert message.envelope == envelope
    assert message.as_(Bottle) == bottle
    assert kinds(message.as_(Bottle)) == kinds(bottle)


@pytest.mark.skipif(
    sys.platform == "win32", reason="the clock of a process moves every 16 ms there: too coarse"
)
@pytest.mark.parametrize("what", ["payload", "reply", "garbage", "text command"])
def test_slow_bytes_cost_no_more(what: str) -> None:
    """Fed byte by byte, twice the bytes take twice the time."""

    def cost(count: int) -> float:
        value = list(range(count))
        stream = ByteStream()
        if what == "payload":
            steps, data = framing.read_message(stream), encode(value)
        elif what == "reply":
            blocks = b"".join(bytes(b) for b in Packet(["x"] * count).blocks)
            steps, data = framing.read_payload(stream), blocks  # type: ignore[assignment]
        elif what == "garbage":
            steps, data = framing.read_message(stream), b"garbage!" * count + encode([1])
        else:
            steps = framing.read_message(stream)
            data = b"".join(framing.encode_text_command("/", b"x" * min(8 * count, 32_000)))
        start = time.process_time()
        run(steps, stream, chop(data, 1))
        return (time.process_time() - start) / len(data)

    small = min(cost(400) for _ in range(3))
    large = min(cost(4000) for _ in range(2))
    assert large < 3 * small + 1e-6


def test_half_a_message_is_a_closed_link() -> None:
    data = captured("half_message", 2)
    with pytest.raises(LinkClosed, match="in the middle"):
        decode(data)


@pytest.mark.parametrize("size", [1, 1000])
def test_a_greeting_may_be_refused(size: int) -> None:
    line = framing.encode_refusal("Access refused: you may not write to /arm \x1b[2J")
    stream = ByteStream()
    with pytest.raises(AccessRefused, match=r"^Access refused: you may .* /arm \\x1b\[2J$"):
        run(framing.read_answer(stream), stream, chop(line, size))


def test_other_answers_to_a_greeting_are_handed_on() -> None:
    for answer in (framing.number(10002), b"Yarp\r\n!!"):
        stream = ByteStream()
        data = answer + b"ories of a robot\r\n"
        assert run(framing.read_answer(stream), stream, [data]) == answer


@pytest.mark.parametrize("said", ["Accessories of a robot", "Error. \x1b[2J", "full"])
def test_a_line_instead_of_an_answer_is_passed_on_to_who_asked(said: str) -> None:
    stream = ByteStream()
    with pytest.raises(RemoteProtocolError) as caught:
        run(framing.read_answer(stream), stream, [framing.encode_refusal(said)])
    assert str(caught.value) == f'the peer answers "{readable(said)}"'


def test_a_line_that_breaks_off_is_handed_on() -> None:
    stream = ByteStream()
    stream.feed(b"* someth")
    stream.feed_eof()
    assert run(framing.read_answer(stream), stream, []) == b"* someth"


def test_a_refusal_is_not_longer_than_a_name() -> None:
    line = framing.encode_refusal("Access refused: " + 5000 * "x")
    assert len(line) == framing.MAX_NAME + 2
    assert framing.refused(line.rstrip()) is not None
    assert framing.refused(b"Welcome") is None
