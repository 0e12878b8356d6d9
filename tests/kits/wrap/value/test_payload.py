"""Values as bytes: JSON, JPEG, bytes and frames, and what Wrapyfi sends over MQTT and Zenoh."""

from __future__ import annotations

import json
from typing import Annotated, Any

import numpy as np
import pytest

import yarpy
from yarpy.kits.wrap.middleware import Failure, Item
from yarpy.kits.wrap.value import frame, payload
from yarpy.kits.wrap.value.array import Image
from yarpy.kits.wrap.value.hint import shape_of

PIXELS = np.arange(18, dtype="u1").reshape(2, 3, 3)
JSON = [
    *[(3, int, b"3"), ("é", str, b'"\\u00e9"'), ({"a": [1, None]}, dict, b'{"a": [1, null]}')],
    *[((1, "a"), tuple[int, str], b'[1, "a"]'), (None, Any, b"null"), (True, bool, b"true")],
    *[({"a": {"b": {"c": 1}}}, Any, b'{"a": {"b": {"c": 1}}}'), (b"\0x", bytes, b"\0x")],
]  # fmt: skip
FRAMES = [
    *[({1: 2}, dict), ((1, 2), Any), (float("inf"), float), ({1}, set[int]), (1j, complex)],
    *[({"__wrapyfi__": 1}, dict), (b"\x93yarpy1\nx", bytes), (b"x", Any), ({"t": (1,)}, dict)],
    (yarpy.Vector([1.0]), yarpy.Vector),
]  # fmt: skip


def through(value: object, hint: Any, encoding: str = "native") -> tuple[bytes, Any]:
    shape = shape_of(hint)
    data = payload.joined(Item(shape.dump(value), shape, 3, 1.5, "/eyes"), encoding)
    return data, payload.unpack(data, shape)


@pytest.mark.parametrize(("value", "hint", "data"), JSON)
def test_what_any_program_reads(value: object, hint: Any, data: bytes) -> None:
    made, found = through(value, hint)
    assert made == data and found.value == value and type(found.value) is type(value)
    framed, found = through(value, hint, "frame")
    assert frame.is_frame(framed) and found.value == value and found.stamp == yarpy.Stamp(3, 1.5)


@pytest.mark.parametrize(("value", "hint"), FRAMES)
def test_what_only_frames_bring_back(value: object, hint: Any) -> None:
    made, found = through(value, hint)
    assert frame.is_frame(made) and found.value == value and type(found.value) is type(value)


def test_texts_of_wrapyfi() -> None:
    made, found = through({"t": (1, 2)}, Any, "wrapyfi")
    assert made == b'{"t": {"__wrapyfi__": ["tuple", [1, 2]]}}' and found.value == {"t": (1, 2)}


def test_pictures() -> None:
    made, found = through(PIXELS, Annotated[np.ndarray, Image("bgr")])
    assert frame.is_frame(made) and np.array_equal(found.value, PIXELS)
    flat = np.full((16, 16, 3), (200, 0, 0), "u1")
    made, found = through(flat, Annotated[np.ndarray, Image("bgr", jpeg=95)])
    assert made[:3] == payload.JPEG
    assert found.value.shape == flat.shape and np.abs(found.value.astype(int) - flat).max() < 8


HEADER = {"timestamp": 1795313269.4, "shape": [2, 3, 3], "dtype": "uint8"}


def mqtt(header: dict[str, Any], body: bytes) -> bytes:
    text = json.dumps(header).encode()
    return len(text).to_bytes(4, "big") + text + body


def zenoh(header: dict[str, Any], body: bytes) -> bytes:
    return json.dumps(header).encode() + b"\n" + body


@pytest.mark.parametrize("form", [mqtt, zenoh])
def test_pictures_and_sounds_of_wrapyfi(form: Any) -> None:
    found = payload.unpack(form(HEADER, PIXELS.tobytes()), shape_of(np.ndarray))
    assert np.array_equal(found.value, PIXELS)
    sound = np.arange(4, dtype="f4").reshape(2, 2)
    header = {"shape": [2, 2], "dtype": "float32", "rate": 44100, "timestamp": 1.0}
    samples, rate = payload.value_of(form(header, sound.tobytes()))
    assert np.array_equal(samples, sound) and rate == 44100


@pytest.mark.parametrize("form", [mqtt, zenoh])
@pytest.mark.parametrize(
    "changes",
    [{"shape": [2, 3]}, {"shape": [-1, -18]}, {"dtype": "object"}, {"dtype": "|O"}, {"shape": 3}],
)
def test_damaged_pictures_of_wrapyfi(form: Any, changes: dict[str, Any]) -> None:
    with pytest.raises(yarpy.DecodeError):
        payload.unpack(form(HEADER | changes, PIXELS.tobytes()), shape_of(np.ndarray))


def test_what_is_none_of_these() -> None:
    assert payload.value_of(b"hello") == "hello"
    assert payload.value_of(b"\xff\xfe") == b"\xff\xfe"
    assert payload.value_of(b'{"a":\n 1}\n') == {"a": 1}
    assert payload.value_of(b"") == ""
    with pytest.raises(yarpy.DecodeError):
        payload.value_of(b"\0\0\0\2{")


def test_questions_and_failures() -> None:
    assert payload.question([1], {"b": 2}) == b'[[1], {"b": 2}]'
    assert payload.asked(payload.question([1j], {})) == [[1j], {}]
    assert payload.failure_of(payload.failure(Failure("KeyError", "x"))) == Failure("KeyError", "x")
    for data in (b"{", b'{"a": 1}', b'{"__wrapyfi__": ["error"]}', b"[" * 9999, b'"fail"'):
        assert payload.failure_of(data) is None
