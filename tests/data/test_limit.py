"""What may come out of what arrives packed, whoever sent it."""

from __future__ import annotations

import logging
from struct import pack

import numpy as np
import pytest
import simplejpeg
from support.steps import measured

from yarpy.data import jpeg
from yarpy.data.bottle import Bottle
from yarpy.data.image import Image
from yarpy.data.json import from_json
from yarpy.data.limit import Limits, limits
from yarpy.data.text import parse_text
from yarpy.errors import DecodeError

FEW = 100_000


@pytest.fixture
def few(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("YARPY_MAX_ELEMENTS", str(FEW))


def test_what_holds_without_settings() -> None:
    assert limits() == Limits(256 << 20, 64 << 20, 4 << 20)


def test_settings(monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture) -> None:
    monkeypatch.setenv("YARPY_MAX_PICTURE", "100")
    monkeypatch.setenv("YARPY_MAX_UNPACKED", "lots")
    with caplog.at_level(logging.WARNING, "yarpy"):
        assert limits() == Limits(picture=100)
        limits()
    assert caplog.text.count("YARPY_MAX_UNPACKED='lots' is not a number") == 1


@pytest.mark.parametrize(
    "wire",
    [
        pack("<ii", 256 + 32, FEW + 1) + bytes(FEW + 1),  # of int8, a byte each
        pack("<ii", 256 + 4, FEW + 1) + bytes(4 * FEW + 4),  # of empty strings
        pack("<ii", 256, FEW + 1) + pack("<ii", 1, 7) * (FEW + 1),
        pack("<ii", 256, 3) + (pack("<iii", 256, 256 + 32, FEW // 2) + bytes(FEW // 2)) * 3,
        pack("<ii", 256, 3) + (pack("<ii", 256 + 32, FEW // 2) + bytes(FEW // 2)) * 3,
    ],
)
def test_elements_of_a_list(few: None, wire: bytes) -> None:
    with pytest.raises(DecodeError):
        Bottle.from_bytes(wire)


def test_as_many_elements_as_there_may_be(few: None) -> None:
    assert len(Bottle.from_bytes(pack("<ii", 256 + 32, FEW) + bytes(FEW))) == FEW
    assert Bottle.from_bytes(Bottle([bytes(9 * FEW)]).to_bytes())[0] == bytes(9 * FEW)


def test_a_bomb_of_small_numbers_takes_no_memory() -> None:
    """50 MB of the wire would be 2 GB of objects."""
    count = 50_000_000
    wire = pack("<ii", 256 + 32, count) + bytes(count)
    with measured() as peak, pytest.raises(DecodeError, match="YARPY_MAX_ELEMENTS"):
        Bottle.from_bytes(wire)
    assert peak.bytes < 1 << 20


@pytest.mark.parametrize(
    "text",
    ["1 " * (FEW + 1), "() " * (FEW + 1), "(1 2 3) " * (FEW // 2), "{" + "1 " * (FEW + 1) + "}"],
)
def test_elements_of_a_text(few: None, text: str) -> None:
    with pytest.raises(DecodeError, match="YARPY_MAX_ELEMENTS"):
        parse_text(text)


def test_blanks_are_no_elements(few: None) -> None:
    assert parse_text("1" + " " * 9 * FEW + "2") == [1, 2]


@pytest.mark.parametrize("text", ["[" + "1," * FEW + "1]", "[" + "[]," * FEW + "1]"])
def test_elements_of_json(few: None, text: str) -> None:
    with pytest.raises(DecodeError, match="YARPY_MAX_ELEMENTS"):
        from_json(text)
    assert len(from_json("[" + "1," * (FEW // 2) + "1]")) == FEW // 2 + 1


def test_pixels_of_a_jpeg(monkeypatch: pytest.MonkeyPatch) -> None:
    data = jpeg.encode(Image(np.zeros((100, 100, 3), "u1")))
    monkeypatch.setenv("YARPY_MAX_PICTURE", "20000")
    with pytest.raises(DecodeError, match="YARPY_MAX_PICTURE"):
        jpeg.decode(data)
    monkeypatch.setenv("YARPY_MAX_PICTURE", "40000")
    assert Image.from_wire(jpeg.decode(data)).width == 100


def test_a_large_picture_is_refused_by_its_head_alone() -> None:
    head = simplejpeg.encode_jpeg(np.zeros((8, 8, 3), "u1"))
    at = head.index(b"\xff\xc0") + 5
    bomb = head[:at] + pack(">HH", 60000, 60000) + head[at + 4 :]
    with measured() as peak, pytest.raises(DecodeError, match="YARPY_MAX_PICTURE"):
        jpeg.decode(bomb)
    assert peak.bytes < 1 << 20


def test_a_jpeg_of_a_thousand_scans() -> None:
    """Each would be another walk over all pixels."""
    data = jpeg.encode(Image(np.zeros((16, 16), "u1")))
    scan = data[data.index(b"\xff\xda") : -2]
    with pytest.raises(DecodeError, match="scans"):
        jpeg.decode(data[:-2] + scan * 1000 + data[-2:])
