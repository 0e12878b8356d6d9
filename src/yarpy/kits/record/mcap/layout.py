"""The records of an MCAP file, as bytes: what is read and written for each message and each chunk.

    file     magic, Header, chunks each with its message indexes, DataEnd, summary, Footer, magic
    record   opcode (1 byte), length (8 bytes), content
    chunk    first and last time, unpacked size, checksum, compression, size, records

Rules: pure; the format is that of https://mcap.dev/spec, little endian, times in nanoseconds since
1970. Every length is checked against the bytes that are there, before anything is built; what does
not fit is a Damaged, which says at which byte.
"""

from __future__ import annotations

from collections.abc import Callable
from struct import Struct, error
from typing import Final, NamedTuple, TypeAlias

from yarpy.errors import DecodeError, UnknownPlugin
from yarpy.kits.record.mcap.checksum import crc32
from yarpy.limit import RECORDED_CHUNK, RECORDED_TEXT

Bytes: TypeAlias = bytes | bytearray | memoryview

MAGIC: Final = b"\x89MCAP0\r\n"
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK = 1, 2, 3, 4, 5, 6
MESSAGE_INDEX, CHUNK_INDEX, ATTACHMENT, STATISTICS, METADATA, DATA_END = 7, 8, 9, 11, 12, 15
OPCODES: Final = range(HEADER, DATA_END + 1)
PRIVATE: Final = 0x80  # opcodes from here on are the writer's own, and skipped

HEAD: Final = Struct("<BQ")  # of every record
MESSAGE_HEAD: Final = Struct("<HIQQ")  # channel, sequence, receipt, sent
WHOLE_MESSAGE: Final = Struct("<BQHIQQ")  # ... with that of its record
FOOTER_BODY: Final = Struct("<QQI")
_U16, _U32, _U64 = Struct("<H"), Struct("<I"), Struct("<Q")


class Damaged(DecodeError):
    """A file that is not what it should be, at `byte`."""

    def __init__(self, byte: int, why: str) -> None:
        super().__init__(f"byte {byte}: {why}")
        self.byte = byte
        self.why = why


class Record(NamedTuple):
    """A message of a file: times in nanoseconds since 1970; `data` is a view of its chunk."""

    channel: int
    sequence: int
    log_time: int
    publish_time: int
    data: memoryview


class Schema(NamedTuple):
    """The type of messages: its name, and its description in some language."""

    name: str = ""
    encoding: str = ""
    data: bytes = b""


class Channel(NamedTuple):
    """A series of messages, whose schema is empty if they have none."""

    topic: str
    encoding: str
    schema: Schema
    metadata: dict[str, str]


class Other(NamedTuple):
    """A message that is not of YARP; times in nanoseconds since 1970."""

    channel: Channel
    sequence: int
    received_ns: int
    sent_ns: int
    data: Bytes


class ChunkHead(NamedTuple):
    """The head of a chunk: `start` is where these begin in it."""

    first: int
    last: int
    size: int
    checksum: int
    compression: str
    start: int
    length: int


class Cursor:
    """Reads fields one after the other. Raises Damaged; `place` is the byte of the file at which
    the view begins."""

    def __init__(self, view: Bytes, place: int) -> None:
        self._view = memoryview(view)
        self._place = place
        self.at = 0

    def _number(self, kind: Struct) -> int:
        try:
            found: int = kind.unpack_from(self._view, self.at)[0]
        except error:
            raise Damaged(
                self._place + self.at, "a record ends in the middle of a number"
            ) from None
        self.at += kind.size
        return found

    def u16(self) -> int:
        """Return the next two bytes as a number."""
        return self._number(_U16)

    def u32(self) -> int:
        """Return the next four bytes as a number."""
        return self._number(_U32)

    def u64(self) -> int:
        """Return the next eight bytes as a number."""
        return self._number(_U64)

    def data(self, count: int) -> memoryview:
        """Return the next `count` bytes."""
        start = self.at
        if count > len(self._view) - start:
            left = len(self._view) - start
            raise Damaged(self._place + start, f"{count} bytes are announced, {left} are left")
        self.at += count
        return self._view[start : self.at]

    def text(self) -> str:
        """Return the next text, which has its length in front."""
        start, count = self.at, self.u32()
        if count > RECORDED_TEXT:
            raise Damaged(self._place + start, f"a text of {count} bytes")
        try:
            return str(self.data(count), "utf-8")
        except UnicodeDecodeError:
            raise Damaged(self._place + start, "a text that is not UTF-8") from None

    def pairs(self) -> dict[str, str]:
        """Return keys and values."""
        end = self.u32() + self.at
        found = {}
        while self.at < end:
            key = self.text()
            found[key] = self.text()
        return found


def parse_schema(view: Bytes, place: int) -> tuple[int, Schema]:
    """Return the number of a schema, and what it is."""
    cursor = Cursor(view, place)
    number, name, encoding = cursor.u16(), cursor.text(), cursor.text()
    return number, Schema(name, encoding, bytes(cursor.data(cursor.u32())))


def parse_channel(view: Bytes, place: int, schemas: dict[int, Schema]) -> tuple[int, Channel]:
    """Return the number of a channel, and what it is."""
    cursor = Cursor(view, place)
    number, schema = cursor.u16(), cursor.u16()
    topic, encoding = cursor.text(), cursor.text()
    return number, Channel(topic, encoding, schemas.get(schema, Schema()), cursor.pairs())


def parse_metadata(view: Bytes, place: int) -> tuple[str, dict[str, str]]:
    """Return the name of the metadata, and its keys and values."""
    cursor = Cursor(view, place)
    return cursor.text(), cursor.pairs()


def parse_index(view: Bytes, place: int) -> tuple[int, int]:
    """Return the channel of a message index, and how many messages it lists."""
    cursor = Cursor(view, place)
    return cursor.u16(), cursor.u32() // 16


def parse_chunk_head(view: Bytes, place: int, length: int) -> ChunkHead:
    """Return the head of a chunk whose record has `length` bytes."""
    cursor = Cursor(view, place)
    first, last, size, checksum = cursor.u64(), cursor.u64(), cursor.u64(), cursor.u32()
    compression, packed = cursor.text(), cursor.u64()
    if size > RECORDED_CHUNK:
        raise Damaged(place, f"a chunk of {size} bytes; no more than {RECORDED_CHUNK} are read")
    if packed > length - cursor.at:
        raise Damaged(place, f"a chunk of {packed} bytes in a record of {length}")
    return ChunkHead(first, last, size, checksum, compression, cursor.at, packed)


def unpacked(head: ChunkHead, packed: Bytes, place: int) -> Bytes:
    """Return the records of a chunk, as they were before they were compressed; the checksum is
    right then. Raises UnknownPlugin if what unpacks them is not installed."""
    data: Bytes
    if head.compression == "":
        data = packed
    elif head.compression == "zstd":
        data = _unzstd(packed, head.size, place)
    elif head.compression == "lz4":
        data = _unlz4(packed, head.size, place)
    else:
        raise Damaged(place, f"a chunk with the unknown compression {head.compression[:20]!r}")
    if len(data) != head.size:
        raise Damaged(place, f"a chunk has {len(data)} bytes instead of {head.size}")
    if head.checksum and crc32(data) != head.checksum:
        raise Damaged(place, "a chunk whose bytes have changed: its checksum is another one")
    return data


def _unzstd(packed: Bytes, size: int, place: int) -> bytes:
    try:
        import zstandard
    except ImportError:
        raise UnknownPlugin(_missing("zstd")) from None
    try:
        # The size in the data itself may be a lie: no more than what was announced is made.
        reader = zstandard.ZstdDecompressor().stream_reader(packed)
        return _all(reader.read, size)
    except zstandard.ZstdError as problem:
        raise Damaged(place, f"a chunk that cannot be unpacked: {problem}") from None


def _unlz4(packed: Bytes, size: int, place: int) -> bytes:
    try:
        import lz4.frame
    except ImportError:
        raise UnknownPlugin(_missing("lz4")) from None
    try:
        return bytes(lz4.frame.LZ4FrameDecompressor().decompress(packed, size + 1))
    except (RuntimeError, EOFError) as problem:
        raise Damaged(place, f"a chunk that cannot be unpacked: {problem}") from None


def _all(read: Callable[[int], bytes], size: int) -> bytes:
    """Return what is there, at most a byte more than `size`."""
    found = bytearray()
    while len(found) <= size and (part := read(min(size + 1 - len(found), 1 << 24))):
        found += part
    return bytes(found)


def _missing(name: str) -> str:
    return f'chunks packed with {name} need a library: pip install "yarpy[record]"'
