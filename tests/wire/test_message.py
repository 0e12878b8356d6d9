"""Packet and Message: encoded once, decoded late, answered once."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable

import numpy
import pytest
from support.way_back import way_back

from yarpy import registry
from yarpy.data.bottle import Bottle, Property
from yarpy.data.sig.vector import Vector
from yarpy.data.stamp import Stamp
from yarpy.data.value import Vocab
from yarpy.errors import DecodeError, LinkClosed, LocalProtocolError, UnknownPlugin
from yarpy.wire.message import (
    CALL,
    DATA,
    UNSENDABLE,
    Lines,
    Message,
    Packet,
    Spelling,
)


def nested(depth: int) -> list[object]:
    """A list in a list in a list ..."""
    value: list[object] = []
    for _ in range(depth):
        value = [value]
    return value


class Counting:
    """Something that can be sent, and knows how often it was encoded."""

    def __init__(self) -> None:
        self.encoded = 0

    def to_wire(self) -> tuple[bytes, ...]:
        self.encoded += 1
        return (Bottle([1, "x"]).to_bytes(),)


def test_packet_encodes_each_spelling_once() -> None:
    thing = Counting()
    packet = Packet(thing)
    first = packet.blocks
    for _ in range(5):
        assert packet.blocks is first
    assert thing.encoded == 1
    assert packet.line == b"1 x"
    assert packet.line is packet.line
    assert packet.key == DATA


def test_packet_keeps_large_arrays_where_they_are() -> None:
    numpy = pytest.importorskip("numpy")
    pixels = numpy.zeros((480, 640, 3), numpy.uint8)
    blocks = Packet(pixels).blocks
    pixels[0, 0, 0] = 7
    assert 7 in bytes(blocks[-1][:100])


@pytest.mark.parametrize("spelling", ["binary", "text"])
def test_snapshot_does_not_change_with_the_array(spelling: Spelling) -> None:
    array = numpy.arange(10000.0)
    wanted = Packet(array.copy())
    packet = Packet(array)
    packet.snapshot(spelling)
    array[:] = -1
    assert packet.line == wanted.line
    assert b"".join(packet.blocks) == b"".join(wanted.blocks)


def test_snapshot_leaves_the_text_of_arrays_for_later() -> None:
    """It takes a hundred times as long as copying, and is made in the thread that sends it."""
    array, words = Packet(numpy.arange(10000.0)), Packet([1, "x"])
    for packet in (array, words):
        packet.snapshot("text")
    assert array._line is None
    assert words._line == b"1 x"


def test_message_is_not_decoded_before_somebody_looks() -> None:
    message = Message(DATA, b"this is no Bottle at all")
    assert message.key == DATA
    with pytest.raises(DecodeError):
        _ = message.value
    assert "undecodable" in repr(message)


def test_value_is_decoded_once() -> None:
    message = Message(DATA, Bottle([1, [2, 3]]).to_bytes())
    assert message.value == [1, [2, 3]]
    assert message.value is message.value


SPELLINGS = [
    ("binary", Bottle([1, "two", [3]]).to_bytes()),
    ("text", b"1 two (3)"),
    ("object", [1, "two", [3]]),
]


@pytest.mark.parametrize(("spelling", "payload"), SPELLINGS)
def test_every_spelling_reads_alike(spelling: str, payload: object) -> None:
    message = Message(DATA, payload, spelling=spelling)  # type: ignore[arg-type]
    assert message.value == [1, "two", [3]]
    assert message.as_(Bottle) == Bottle([1, "two", [3]])
    assert message.as_(list) == [1, "two", [3]]
    with pytest.raises(DecodeError):
        message.as_(Stamp)


def test_object_of_the_wanted_type_is_handed_out_itself() -> None:
    original = Property(a=1)
    assert Message(DATA, original, spelling="object").as_(Property) is original
    assert Message(DATA, {"a": 1}, spelling="object").as_(Property) == original


def test_array_is_a_view_of_what_arrived() -> None:
    numpy = pytest.importorskip("numpy")
    payload = bytearray(b"".join(bytes(b) for b in Packet(Vector([1.0, 2.0])).blocks))
    message = Message(DATA, memoryview(payload))
    array = message.as_(numpy.ndarray)
    assert list(array) == [1.0, 2.0]
    payload[-1] ^= 0x80
    assert list(array) == [1.0, -2.0]


ENVELOPES = [
    ("7 1.25", Stamp(7, 1.25)),
    ("0 0", Stamp(0, 0.0)),
    ("", None),
    ("some text", None),
]


@pytest.mark.parametrize(("envelope", "stamp"), ENVELOPES)
def test_stamp_is_read_from_the_envelope(envelope: str, stamp: Stamp | None) -> None:
    assert Message(DATA, b"", envelope).stamp == stamp


def test_reply_goes_once() -> None:
    answers: list[object] = []
    message = Message(CALL, b"")
    message.source = "/asker"
    assert not message.wants_reply
    with pytest.raises(LocalProtocolError, match="/asker"):
        message.reply(1)
    message.answer = way_back(answers.append)
    assert message.wants_reply
    message.reply([1, 2])
    assert answers == [[1, 2]]
    assert not message.wants_reply
    with pytest.raises(LocalProtocolError, match="RpcClient"):
        message.reply(3)


def test_answer_tells_of_its_end_once_it_went_or_failed_for_good() -> None:
    """What cannot be sent is no end: somebody may give another answer."""
    ends: list[str] = []

    def send(value: object) -> None:
        if value == "gone":
            raise LinkClosed("gone")
        Packet(value).blocks  # noqa: B018

    for values, raised in (((1,), None), ((object(), 1), TypeError), (("gone",), LinkClosed)):
        answer = way_back(send, lambda: ends.append("end"))
        for value in values:
            try:
                answer.give(value)
            except (TypeError, LinkClosed) as error:
                assert type(error) is raised
                assert bool(answer.right) == (raised is TypeError)
                assert len(ends) == (raised is LinkClosed)
        assert ends.pop() == "end"
        with pytest.raises(LocalProtocolError, match="already"):
            answer.give(2)
        assert not ends


def test_thread_that_answers_tells_who_has_left_the_question_meanwhile() -> None:
    """Whether it could answer or not; only one may, and a second one does not disturb it."""
    seen: list[object] = []

    def send(value: object) -> None:
        seen.append(answer.busy)
        answer.left = lambda: seen.append((answer.busy, len(answer.right)))
        with pytest.raises(LocalProtocolError, match="already"):
            answer.give("second")
        seen.append(answer.busy)
        Packet(value).blocks  # noqa: B018

    answer = way_back(send)
    with pytest.raises(TypeError):
        answer.give(object())
    assert seen == [True, True, (False, 1)]
    answer.give(1)
    assert seen[3:] == [True, True, (False, 0)]
    assert not answer.busy


def test_lines_are_text_for_people_and_a_string_for_programs() -> None:
    lines = Lines(["one", "two \u00e9"])
    assert lines.to_text() == "one\r\ntwo \u00e9\r\n".encode()
    assert Bottle.from_bytes(b"".join(lines.to_wire())) == ["one\r\ntwo \u00e9\r\n"]
    assert Lines().to_text() == b""


def test_repr_tells_who_and_what_in_one_line() -> None:
    message = Message(DATA, Bottle(["x" * 300]).to_bytes(), "5 2.5")
    message.source = "/talker"
    text = repr(message)
    assert "/talker" in text
    assert "5 2.5" in text
    assert len(text) < 160
    assert repr(Message(DATA, Bottle([Vocab("set")]).to_bytes())).startswith("<Message")


@pytest.mark.parametrize("how", [copy.copy, copy.deepcopy, lambda m: pickle.loads(pickle.dumps(m))])
@pytest.mark.parametrize("looked", [False, True])
def test_copy_says_the_same_and_answers_nobody(
    how: Callable[[Message], Message], looked: bool
) -> None:
    received = bytearray(b"".join(Vector(range(1000)).to_wire()))
    message = Message(CALL, memoryview(received), "7 1.5")
    message.source, message.answer = "/out", way_back()
    if looked:
        _ = message.value
    found = how(message)
    received[8:] = bytes(len(received) - 8)
    assert found.as_(Vector).tolist() == list(range(1000))
    assert (found.source, found.stamp) == ("/out", Stamp(7, 1.5))
    assert not found.wants_reply


@pytest.mark.parametrize("value", [object(), 2**70, "\ud800", nested(200)])
def test_reply_that_cannot_be_sent_leaves_the_question_open(value: object) -> None:
    sent: list[object] = []
    message = Message(CALL)
    message.answer = way_back(lambda value: sent.append(Packet(value).blocks))
    with pytest.raises(UNSENDABLE):
        message.reply(value)
    message.reply([1])
    assert len(sent) == 1


def test_a_type_may_be_named() -> None:
    message = Message("d", Bottle([1, "two"]).to_bytes())
    assert type(message.as_("bottle")) is Bottle

    class Pair:
        @classmethod
        def from_wire(cls, view: object) -> tuple[str, int]:
            return "pair", len(bytes(view))  # type: ignore[call-overload]

    registry.types.add("pair", Pair)
    try:
        assert message.as_("pair") == ("pair", len(message.payload))
    finally:
        registry.types.remove("pair")
    with pytest.raises(UnknownPlugin, match='no type "pair"'):
        message.as_("pair")
