"""Frames: every value there and back, as one and in parts; damage is refused."""

from __future__ import annotations

import json
import random
from datetime import datetime

import numpy as np
import pytest
from support.steps import measured

import yarpy
from yarpy.data.sig import jpeg
from yarpy.kits.wrap.value.frame import (
    MAGIC,
    Frame,
    from_bytes,
    from_parts,
    is_frame,
    to_bytes,
    to_parts,
)

VALUES = [
    *(None, 1, 2.5, "x", [1, (2, 3)], {"a": {"b": None}}, {1: 2, (1, 2): {3}}, b"abc", 3 + 4j),
    *(datetime(2026, 1, 1), np.float32(2), np.datetime64("2026-01-01"), frozenset({1})),
    *(np.arange(6, dtype="f4").reshape(2, 3), np.asfortranarray(np.arange(6.0).reshape(2, 3))),
    *(np.arange(20)[::2], np.zeros((0, 3)), np.array(["a", "bc"]), np.array([1, 2], "M8[s]")),
    *(np.arange(3, dtype=">i4"), np.array(True), {"a": [np.arange(3), b"", b"x"]}),
    yarpy.Image(np.arange(18, dtype="u1").reshape(2, 3, 3)),
]


@pytest.mark.parametrize("value", VALUES, ids=lambda v: repr(v)[:40])
def test_there_and_back(value: object) -> None:
    frame = Frame(value, 3, 1.5, "/eyes")
    whole = b"".join(to_bytes(frame))
    assert is_frame(whole)
    for found in (from_bytes(whole), from_parts(to_parts(frame))):
        assert (found.count, found.time, found.source) == (3, 1.5, "/eyes")
        assert type(found.value) is type(value)
        assert repr(found.value) == repr(value)
        if isinstance(value, np.ndarray):
            assert found.value.dtype == value.dtype


def test_bytes_of_a_frame() -> None:
    header = b'{"yarpy": 1, "tree": {"__wrapyfi__": ["numpy.ndarray", {"b": 0}]}, '
    header += b'"buffers": [["|u1", [3], "C"]]}'
    whole = b"".join(to_bytes(Frame(np.arange(3, dtype="u1"))))
    start = MAGIC + len(header).to_bytes(4, "little") + header
    assert whole == start + bytes(-len(start) % 8) + b"\0\1\2"


def test_arrays_are_not_copied() -> None:
    picture = np.zeros((48, 64, 3), "u1")
    parts = to_parts(Frame({"a": picture, "b": np.asfortranarray(np.zeros((3, 4)))}))
    assert np.shares_memory(np.frombuffer(parts[1], "u1"), picture)
    found = from_parts(parts).value
    assert np.shares_memory(found["a"], picture)
    assert found["b"].flags.f_contiguous
    whole = b"".join(to_bytes(Frame(picture)))
    assert np.shares_memory(from_bytes(whole).value, np.frombuffer(whole, "u1"))


@pytest.mark.parametrize(
    "header",
    [
        *(b"", b"{", b"[]", b"{}", b'{"yarpy": 2, "tree": 1}', b'{"yarpy": 1}'),
        *(b'{"yarpy": 1, "tree": 1, "buffers": 3}', b'{"yarpy": 1, "tree": 1, "buffers": [[]]}'),
        b'{"yarpy": 1, "tree": 1, "buffers": [["<f8", [1000000000000], "C"]]}',
        b'{"yarpy": 1, "tree": 1, "buffers": [["<f8", [-1], "C"]]}',
        b'{"yarpy": 1, "tree": 1, "buffers": [["|O", [1], "C"]]}',
        b'{"yarpy": 1, "tree": 1, "buffers": [["<f8,<f8", [1], "C"]]}',
        b'{"yarpy": 1, "tree": 1, "buffers": [["<f8", [1], "X"]]}',
        b'{"yarpy": 1, "tree": 1, "buffers": [["|V0", [99999999999, 99999999999], "C"]]}',
        b'{"yarpy": 1, "tree": {"__wrapyfi__": ["bytes", {"b": 0}]}}',
        b'{"yarpy": 1, "tree": ' + b"[" * 5000,
    ],
)  # fmt: skip
def test_bad_headers(header: bytes) -> None:
    whole = MAGIC + len(header).to_bytes(4, "little") + header
    with pytest.raises(yarpy.DecodeError):
        from_bytes(whole + bytes(-len(whole) % 8) + bytes(8))
    with pytest.raises(yarpy.DecodeError):
        from_parts([header, bytes(8)])


def test_every_shorter_and_many_changed_frames_are_refused_or_read() -> None:
    whole = b"".join(to_bytes(Frame({"a": np.arange(3.0), "b": [b"x", (1,)]}, 1, 2.0, "/x")))
    for length in range(len(whole)):
        with pytest.raises(yarpy.DecodeError):
            from_bytes(whole[:length])
    chance = random.Random(5)
    for _ in range(3000):
        data = bytearray(whole)
        for _ in range(chance.randrange(1, 4)):
            data[chance.randrange(len(data))] = chance.randrange(256)
        try:
            from_bytes(data)
        except yarpy.DecodeError:
            pass


@pytest.mark.parametrize("dtype", ["|S0", "|V0", "<U0"])
@pytest.mark.parametrize("shape", [[3_000_000_000], [10**15], [1]])
def test_elements_of_no_size_are_refused(dtype: str, shape: list[int]) -> None:
    """numpy would give them one byte each, of which none is there."""
    header = json.dumps({"yarpy": 1, "tree": 1, "buffers": [[dtype, shape, "C"]]}).encode()
    with measured() as peak, pytest.raises(yarpy.DecodeError):
        from_parts([header, b""])
    assert peak.bytes < 1 << 20


def of_one_buffer(tag: str, data: bytes, times: int) -> list[bytes]:
    """A frame that names its only buffer many times."""
    tree = [{"__wrapyfi__": [tag, {"b": 0}]}] * times
    header = {"yarpy": 1, "tree": tree, "buffers": [["|u1", [len(data)], "C"]]}
    return [json.dumps(header).encode(), data]


@pytest.mark.parametrize("tag", ["bytes", "jpeg", "yarp", "numpy.ndarray"])
def test_a_buffer_is_named_once(tag: str) -> None:
    """A megabyte named a hundred times would be a hundred of them."""
    data = yarpy.Bottle([bytes(1 << 20)]).to_bytes()
    if tag == "jpeg":
        data = jpeg.encode(yarpy.Image(np.zeros((1000, 1000, 3), "u1")))
    assert from_parts(of_one_buffer(tag, data, 1)).value
    with measured() as peak, pytest.raises(yarpy.DecodeError, match="names its buffer 0 twice"):
        from_parts(of_one_buffer(tag, data, 100))
    assert peak.bytes < 8 << 20


def test_pictures_of_a_frame_share_their_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    data = jpeg.encode(yarpy.Image(np.zeros((100, 100, 3), "u1")))
    monkeypatch.setenv("YARPY_MAX_PICTURE", "70000")
    tree = [{"__wrapyfi__": ["jpeg", {"b": n}]} for n in range(3)]
    header = {"yarpy": 1, "tree": tree, "buffers": [["|u1", [len(data)], "C"]] * 3}
    with pytest.raises(yarpy.DecodeError, match="YARPY_MAX_PICTURE"):
        from_parts([json.dumps(header).encode(), data, data, data])


def test_messages_of_a_frame_share_their_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    data = yarpy.Bottle([[0] * 50_000]).to_bytes()
    monkeypatch.setenv("YARPY_MAX_ELEMENTS", "120000")
    tree = [{"__wrapyfi__": ["yarp", {"b": n}]} for n in range(3)]
    header = {"yarpy": 1, "tree": tree, "buffers": [["|u1", [len(data)], "C"]] * 3}
    with pytest.raises(yarpy.DecodeError, match="YARPY_MAX_ELEMENTS"):
        from_parts([json.dumps(header).encode(), data, data, data])


def test_what_cannot_be_sent() -> None:
    for value in (np.array([{}]), np.zeros(1, [("a", "f4")]), object(), print):
        with pytest.raises(TypeError, match="cannot be sent"):
            to_parts(Frame(value))
