"""Values as messages of YARP: native, as a frame, and as Wrapyfi's text; a reader tells them."""

from __future__ import annotations

import itertools
from typing import Annotated, Any

import numpy as np
import pytest

import yarpy
from yarpy.kits.wrap.middleware import Failure, Item
from yarpy.kits.wrap.value import payload, spelling
from yarpy.kits.wrap.value.array import Image
from yarpy.kits.wrap.value.hint import shape_of
from yarpy.kits.wrap.value.spelling import (
    FORMS,
    failure,
    failure_of,
    form_of,
    frame_of,
    question,
    received,
    text_of,
)
from yarpy.wire.message import CALL, DATA, Message, Packet


def sent(value: object, hint: Any, encoding: str) -> Message:
    shape = shape_of(hint)
    item = Item(shape.dump(value), shape, 3, 1.5, "/eyes")
    data = b"".join(Packet(form_of(encoding, shape)(item)).blocks)
    assert data == b"".join(Packet(FORMS[encoding](item)).blocks)  # of a shape that says nothing
    return Message(DATA, data, "4 2.5")


VALUES = [
    *[("hello", str), ("5", str), ({"a": 1}, dict), ([1.0, 2.0], list[float]), (3, int)],
    *[({"a": {"b": {"c": None}}}, dict), ({"t": (1, 2)}, Any), ("[1]", Any), (None, Any)],
    *[("5", Any), ('"a"', str)],
    *[(b"x", bytes), ((1, "a"), tuple[int, str]), ({1, 2}, set[int]), (True, bool), (1j, complex)],
]  # fmt: skip


@pytest.mark.parametrize("encoding", ["native", "frame", "wrapyfi"])
@pytest.mark.parametrize(("value", "hint"), VALUES, ids=str)
def test_readers_need_no_setting(value: object, hint: Any, encoding: str) -> None:
    if encoding == "wrapyfi" and (hint is bytes or hint is complex):
        with pytest.raises(TypeError):
            sent(value, hint, encoding)
        return
    found = received(sent(value, hint, encoding), shape_of(hint))
    assert found.value == value and type(found.value) is type(value)


def test_native_is_what_any_program_reads() -> None:
    assert sent({"a": 1}, dict, "native").as_(dict) == {"a": 1}
    assert sent("x", str, "native").value == "x"
    assert sent([1, 2], list, "native").value == [1, 2]


AS_PORTS_DO: list[tuple[Any, Any]] = [
    ({"rgb": np.zeros((4, 5, 3), "u1"), "q": np.arange(3, dtype="f4")}, dict),
    ({"a": {"b": {"c": None}}, "t": [(1, 2)]}, Any),
    (np.ones((2, 2, 2), "f2"), np.ndarray),
    (np.ones((2, 2), bool), Any),
    ((np.zeros((3, 2), "f4"), 1), tuple[np.ndarray, int]),
    (1j, complex),
]


@pytest.mark.parametrize(("value", "hint"), AS_PORTS_DO, ids=lambda it: str(it)[:30])
def test_what_ports_bring_back_is_what_ports_write(value: Any, hint: Any) -> None:
    """Any port reads it; there is no other spelling for it."""
    message = sent(value, hint, "native")
    assert frame_of(message) is None
    assert bytes(message.payload) == b"".join(Packet(value).blocks)
    for found in (message.value, received(message, shape_of(hint)).value):
        np.testing.assert_equal(found, value)
        assert type(found) is type(value)


@pytest.mark.parametrize(
    ("value", "hint"),
    [
        ({"a": {1, 2}, "b": (1,)}, Any),
        ({"a": np.float32(1), "b": None, "c": ()}, Any),
        ({"a": (1 << 70,)}, dict),
        ({1: (2,)}, dict),
        (np.zeros((2, 2, 1), "u1"), np.ndarray),
        (np.zeros((2, 2), "u1"), Any),
    ],
    ids=str,
)
def test_what_ports_do_not_bring_back_is_framed(value: Any, hint: Any) -> None:
    message = sent(value, hint, "native")
    assert frame_of(message) is not None
    np.testing.assert_equal(received(message, shape_of(hint)).value, value)


@pytest.mark.parametrize("size", [2, 30_000])
def test_what_came_belongs_to_who_listens(size: int) -> None:
    """Also where it lies in memory of the sender's, which is read-only."""
    hints = (np.ndarray, Annotated[np.ndarray, Image("mono")])
    for hint, encoding, kind in itertools.product(hints, ("native", "frame"), (memoryview, bytes)):
        message = sent(np.zeros((2, size), "u1"), hint, encoding)
        message.payload = kind(bytes(message.payload))
        found = received(message, shape_of(hint)).value
        found += 1
        assert found.all()


def test_stamps_of_envelopes_and_of_frames() -> None:
    native = received(sent(3, int, "native"), shape_of(int))
    assert (native.count, native.time) == (4, 2.5)
    for envelope in ("", "no stamp"):
        other = received(Message(DATA, b"".join(Packet(7).blocks), envelope), shape_of(int))
        assert (other.value, other.time, other.count, other.stamp) == (7, None, None, None)
    assert repr(native) == "Received(value=3, count=4, time=2.5, source='', middleware='')"
    framed = received(sent(3, int, "frame"), shape_of(int))
    assert (framed.count, framed.time, framed.source) == (3, 1.5, "/eyes")


def test_pictures() -> None:
    picture = np.zeros((8, 16, 3), "u1")
    picture[..., 0] = 200
    for encoding in FORMS:
        message = sent(picture, Annotated[np.ndarray, Image("bgr")], encoding)
        assert np.array_equal(
            received(message, shape_of(Annotated[np.ndarray, Image("bgr")])).value, picture
        )
    assert message.value.code == "bgr"  # as Wrapyfi's listeners take it, too
    hint = Annotated[np.ndarray, Image("bgr", jpeg=95)]
    message = sent(picture, hint, "native")
    found = received(message, shape_of(hint)).value
    assert found.shape == picture.shape and np.abs(found.astype(int) - picture).max() < 8
    assert frame_of(message) is not None


def test_bottles_that_look_like_frames() -> None:
    for value in (["yarpy/1", 3], ["yarpy/1", "{}"], ["yarpy/1", '{"yarpy": 1, "tree": 1}', "x"]):
        with pytest.raises(yarpy.DecodeError):
            frame_of(Message(DATA, b"".join(Packet(value).blocks)))
    assert frame_of(Message(DATA, b"".join(Packet(["yarpy/1"]).blocks))) is None
    with pytest.raises(yarpy.DecodeError):
        frame_of(Message(DATA, b"yarpy/1 x", spelling="text"))


def test_texts_of_wrapyfi_and_of_others() -> None:
    golden = bytes.fromhex("04010000 01000000 31000000")
    golden += b'{"i": 0, "t": {"__wrapyfi__": ["tuple", [1, 2]]}}'
    assert sent({"i": 0, "t": (1, 2)}, Any, "wrapyfi").payload == golden
    assert received(Message(DATA, golden), shape_of(Any)).value == {"i": 0, "t": (1, 2)}
    plain = Message(DATA, b"".join(Packet(["[tuple"]).blocks))
    assert text_of(plain) == "[tuple"
    assert received(plain, shape_of(str)).value == "[tuple"
    assert received(plain, shape_of(Any)).value == ["[tuple"]
    with pytest.raises(yarpy.DecodeError):
        received(plain, shape_of(dict))
    for words in (["a"], ["[1]"], ["a", "b"]):
        assert received(sent(words, list[str], "native"), shape_of(list[str])).value == words


def test_questions_are_plain_where_that_is_possible() -> None:
    assert question("look", [1.0, "fast"], {}) == ["look", 1.0, "fast"]
    for args, kwargs in (([1j], {}), ([1], {"b": 2}), ([(1, 2)], {})):
        asked = question("look", args, kwargs)
        found = frame_of(Message(CALL, b"".join(Packet(asked).blocks)))
        assert found is not None and found.value == [args, kwargs]


def test_failures_are_told_as_yarp_does() -> None:
    said = failure(Failure("ValueError", "too far"))
    assert said.to_text() == '[fail] "ValueError: too far" (raised ValueError)'
    message = Message(DATA, said.to_bytes())
    assert failure_of(message.value) == Failure("ValueError", "too far")
    other = Message(DATA, yarpy.Bottle([yarpy.Vocab("fail"), "no such motor: 7"]).to_bytes())
    assert failure_of(other.value) == Failure("", "no such motor: 7")
    for value in (["fail", "x"], [yarpy.Vocab("fail")], [yarpy.Vocab("ok"), 1], "fail"):
        assert failure_of(Message(DATA, b"".join(Packet(value).blocks)).value) is None


def test_a_picture_is_compressed_once_for_all_middlewares(monkeypatch: pytest.MonkeyPatch) -> None:
    compressed = []
    to_jpeg = spelling.to_jpeg
    monkeypatch.setattr(spelling, "to_jpeg", lambda *a: compressed.append(a) or to_jpeg(*a))
    shape = shape_of(Annotated[np.ndarray, Image("bgr", jpeg=80)])
    item = Item(shape.dump(np.zeros((8, 16, 3), "u1")), shape)
    item.forms = {}
    form_of("native", shape)(item)
    assert payload.joined(item) in payload.parts(item)
    assert len(compressed) == 1
