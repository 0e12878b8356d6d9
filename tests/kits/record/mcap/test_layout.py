"""Records of MCAP files, byte by byte."""

import struct
import zlib

import lz4.frame
import pytest
import zstandard

from yarpy.kits.record.mcap import layout
from yarpy.kits.record.mcap.layout import ChunkHead, Cursor, Damaged
from yarpy.limit import RECORDED_CHUNK

TEXT = b"\x02\0\0\0ab"


def head_of(data: bytes, compression: str, checksum: int | None = None) -> ChunkHead:
    crc = zlib.crc32(data) if checksum is None else checksum
    return ChunkHead(1, 2, len(data), crc, compression, 0, 0)


def test_fields_one_after_the_other() -> None:
    cursor = Cursor(b"\x01\0\x02\0\0\0\x03\0\0\0\0\0\0\0" + TEXT + b"\x0c\0\0\0" + TEXT * 2, 100)
    assert (cursor.u16(), cursor.u32(), cursor.u64(), cursor.text()) == (1, 2, 3, "ab")
    assert cursor.pairs() == {"ab": "ab"}


@pytest.mark.parametrize(
    ("data", "byte", "why"),
    [
        (b"\x02\0", 100, "middle of a number"),
        (b"\x09\0\0\0ab", 104, "9 bytes are announced, 2 are left"),
        (b"\xff\xff\xff\xff", 100, "a text of 4294967295 bytes"),
        (b"\x01\0\0\0\xff", 104, None),
    ],
)
def test_what_does_not_fit_is_named_with_its_byte(data: bytes, byte: int, why: str | None) -> None:
    with pytest.raises(Damaged, match=why or "not UTF-8") as found:
        Cursor(data, 100).text()
    assert found.value.byte == (100 if why is None else byte)


def test_descriptions() -> None:
    schema = layout.Schema("ab", "ab", b"ab")
    assert layout.parse_schema(b"\x07\0" + 3 * TEXT, 0) == (7, schema)
    channel = b"\x01\0\x07\0" + TEXT + TEXT + b"\0\0\0\0"
    assert layout.parse_channel(channel, 0, {7: schema}) == (1, ("ab", "ab", schema, {}))
    assert layout.parse_metadata(TEXT + b"\x0c\0\0\0" + TEXT * 2, 0) == ("ab", {"ab": "ab"})
    assert layout.parse_index(b"\x05\0\x20\0\0\0", 0) == (5, 2)


def test_the_head_of_a_chunk() -> None:
    head = struct.pack("<QQQII", 1, 2, 3, 4, 3) + b"lz4" + struct.pack("<Q", 9)
    assert layout.parse_chunk_head(head, 0, len(head) + 9) == (1, 2, 3, 4, "lz4", len(head), 9)
    with pytest.raises(Damaged, match="9 bytes in a record of"):
        layout.parse_chunk_head(head, 0, len(head) + 8)
    vast = struct.pack("<QQQII", 1, 2, RECORDED_CHUNK + 1, 4, 0) + struct.pack("<Q", 9)
    with pytest.raises(Damaged, match="no more than"):
        layout.parse_chunk_head(vast, 50, len(vast) + 9)


@pytest.mark.parametrize(
    ("name", "pack"), [("", bytes), ("zstd", zstandard.compress), ("lz4", lz4.frame.compress)]
)
def test_chunks_are_unpacked_and_checked(name: str, pack: object) -> None:
    data = b"message" * 1000
    packed = pack(data)  # type: ignore[operator]
    assert bytes(layout.unpacked(head_of(data, name), packed, 0)) == data
    with pytest.raises(Damaged, match=r"byte 77: .*checksum"):
        layout.unpacked(head_of(data, name, 1), packed, 77)
    short = head_of(data[:-1], name)
    with pytest.raises(Damaged, match=f"{len(data)} bytes instead of {len(data) - 1}"):
        layout.unpacked(short, packed, 0)
    if name:
        with pytest.raises(Damaged, match="cannot be unpacked"):
            layout.unpacked(head_of(data, name), b"?" + packed, 0)


@pytest.mark.parametrize(
    ("name", "pack"), [("zstd", zstandard.compress), ("lz4", lz4.frame.compress)]
)
def test_no_more_is_unpacked_than_was_announced(name: str, pack: object) -> None:
    packed = pack(bytes(1 << 26))  # type: ignore[operator]
    with pytest.raises(Damaged, match="a chunk has 101 bytes instead of 100"):
        layout.unpacked(head_of(bytes(100), name), packed, 0)


def test_a_compression_that_nobody_knows() -> None:
    with pytest.raises(Damaged, match="unknown compression 'rar'"):
        layout.unpacked(head_of(b"", "rar"), b"", 0)
