"""Payloads for programs that know nothing of YARP: what a value is to them, and theirs to us."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest

from yarpy.carriers.payload import message_of, payload_of, to_payload, value_of
from yarpy.data import codec
from yarpy.data.bottle import Bottle
from yarpy.data.sig.image import Image
from yarpy.data.sig.vector import Vector
from yarpy.data.value import Vocab
from yarpy.errors import DecodeError
from yarpy.wire.message import DATA, Encoded, Message, Packet


@pytest.mark.parametrize(
    ("value", "payload"),
    [
        ([1, "two", [3.5]], b'[1, "two", [3.5]]'),
        ({"a": 1}, b'{"a": 1}'),
        ("h\u00e4", '"h\u00e4"'.encode()),
        (7, b"7"),
        ([], b"[]"),
        (b"\0\xff", b"\0\xff"),
        ([b"one blob"], b"one blob"),
        ([1, b"\1"], b'[1, {"type": "blob", "base64": "AQ=="}]'),
        (Vector([1.0, 2.5]), b"[1.0, 2.5]"),
        ([Vocab("set"), True], b'["set", "true"]'),
        (Encoded(b"".join(codec.encode([1, 2]))), b"[1, 2]"),
    ],
)
def test_what_others_get(value: Any, payload: bytes) -> None:
    assert payload_of(value) == payload


@pytest.mark.parametrize(
    ("payload", "value"),
    [
        (b'[1, "two", [3.5]]', Bottle([1, "two", Bottle([3.5])])),
        (b'{"a": 1, "b": [2]}', Bottle([["a", 1], ["b", Bottle([2])]])),
        (b"7", 7),
        (b"12.5", 12.5),
        (b"", ""),
        (b"hello there", "hello there"),
        (b"[1, 2", "[1, 2"),
        (b"NaN", "NaN"),
        (b"\xff\0", b"\xff\0"),
        (b"\xff\xd8\xff damaged", b"\xff\xd8\xff damaged"),
    ],
)
def test_what_comes_from_others(payload: bytes, value: Any) -> None:
    assert value_of(payload) == value
    assert value_of(memoryview(payload)) == value


def test_pictures_are_jpeg_files_both_ways() -> None:
    pixels = np.full((8, 16, 3), 200, "u1")
    data = payload_of(Image(pixels), b"7 1.5")
    assert data[:3] == b"\xff\xd8\xff"
    message = message_of(DATA, [data])
    assert message.envelope == "7 1.5"
    assert isinstance(message.value, Image)
    assert abs(message.value.array.astype(int) - 200).max() < 4
    assert message.as_(Image) is message.value
    wire = Encoded(b"".join(map(bytes, Image(pixels).to_wire())))
    assert payload_of(wire, b"7 1.5") == data


def test_pictures_that_jpeg_would_spoil_are_sent_with_their_pixels() -> None:
    depth = Image(np.full((2, 3), 1.5, "f4"))
    assert b'"base64"' in payload_of(depth)


def test_a_payload_is_made_once() -> None:
    packet = Packet([1, 2])
    assert to_payload(packet) is to_payload(packet)


def test_a_message_is_decoded_as_what_its_reader_wants() -> None:
    message = message_of(DATA, [b'[1, "two"]'])
    assert message.as_(Bottle) == Bottle([1, "two"])
    assert message.as_(bytes) == b'[1, "two"]'
    assert Bottle.from_bytes(message.to_bytes()) == Bottle([1, "two"])
    assert message_of(DATA, [b"[1.5, 2.5]"]).as_(Vector).array.tolist() == [1.5, 2.5]
    with pytest.raises(DecodeError):
        message.as_(Image)


def test_several_frames_are_a_list() -> None:
    assert message_of(DATA, [b"1", b"[2, 3]", b"x"]).value == Bottle([1, Bottle([2, 3]), "x"])


def test_a_copy_holds_the_value() -> None:
    message = message_of(DATA, [b"[1]"])
    message.source = "/s"
    copy = pickle.loads(pickle.dumps(message))
    assert type(copy) is Message
    assert (copy.value, copy.source) == (Bottle([1]), "/s")


def test_json_that_no_message_can_hold_is_text() -> None:
    deep = b"[" * 5000
    assert value_of(deep) == deep.decode()
    assert value_of(b"[99999999999999999999999]") == "[99999999999999999999999]"
