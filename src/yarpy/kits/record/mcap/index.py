"""The table of contents of an MCAP file: from its summary, or by a walk over its chunks where it
has none.

Rules: a file that was not finished (a kill, a power cut, a recording that still runs) is read as
far as it goes. What is damaged is told with its byte, in `damages`; what can be read in spite of it
is read. The walk reads the heads of chunks and what lists their messages, not the messages. Memory
is 25 bytes for a chunk.
"""

from __future__ import annotations

import os
from array import array
from collections.abc import Iterator
from struct import Struct
from typing import Final

from yarpy.errors import DecodeError
from yarpy.kits.record.mcap import layout
from yarpy.kits.record.mcap.attachment import (
    LARGEST,
    MOST,
    START,
    Attachment,
    content_of,
    parse_attachment,
)
from yarpy.kits.record.mcap.checksum import crc32
from yarpy.kits.record.mcap.layout import (
    ATTACHMENT,
    CHANNEL,
    CHUNK,
    CHUNK_INDEX,
    DATA_END,
    FOOTER,
    FOOTER_BODY,
    HEAD,
    MAGIC,
    MESSAGE,
    MESSAGE_HEAD,
    MESSAGE_INDEX,
    METADATA,
    PRIVATE,
    SCHEMA,
    STATISTICS,
    Channel,
    ChunkHead,
    Cursor,
    Damaged,
)
from yarpy.limit import RECORDED_CHUNK, RECORDED_CHUNKS, RECORDED_SUMMARY, RECORDED_TEXT
from yarpy.platform import file_bytes

_FOOTER: Final = HEAD.size + FOOTER_BODY.size + len(MAGIC)  # bytes at the end
_CHUNK_START: Final = 4096  # bytes that the head of a chunk never exceeds
_RUN: Final = 1 << 20  # bytes of messages outside chunks that are read at once
_SIGNED: Final = Struct("<BQQQ")  # what the checksum of the summary covers of the footer
_METADATA_INDEX: Final = 13
_ATTACHMENT_INDEX: Final = 10


class Window:
    """The bytes of a file, from any place. Safe to use from several threads."""

    def __init__(self, handle: int) -> None:
        self._handle = handle
        self.size = os.fstat(handle).st_size

    def at(self, place: int, count: int) -> bytes:
        """Return `count` bytes from `place` on. Raises Damaged if the file ends before."""
        if place + count > self.size:
            raise Damaged(place, f"{count} bytes are announced, {self.size - place} are left")
        data = file_bytes.read_at(self._handle, count, place)
        if len(data) != count:
            raise Damaged(place + len(data), "the file has become shorter meanwhile")
        return data


class Index:
    """The parts of a file: chunks, and runs of messages outside of chunks.

    `complete`: it was finished. `counts`: the messages of each channel. `begin` and `end` are the
    first and the last receipt, in nanoseconds since 1970; both 0 in a file without messages.
    """

    def __init__(self) -> None:
        self.channels: dict[int, Channel] = {}
        self.schemas: dict[int, layout.Schema] = {}
        self.counts: dict[int, int] = {}
        self.places = array("Q")
        self.lengths = array("Q")
        self.firsts = array("Q")
        self.lasts = array("Q")
        self.bare = array("B")  # messages outside of chunks
        self.metadata: dict[str, dict[str, str]] = {}
        self.attachments: list[Attachment] = []
        self.damages: list[Damaged] = []
        self.complete = False

    @property
    def begin(self) -> int:
        """Return when the first message came."""
        return min(self.firsts, default=0)

    @property
    def end(self) -> int:
        """Return when the last message came."""
        return max(self.lasts, default=0)

    def add(self, place: int, length: int, first: int, last: int, bare: bool = False) -> None:
        """Add a part."""
        if len(self.places) >= RECORDED_CHUNKS:
            raise Damaged(place, f"more than {RECORDED_CHUNKS} chunks")
        self.places.append(place)
        self.lengths.append(length)
        self.firsts.append(first)
        self.lasts.append(last)
        self.bare.append(bare)

    def count(self, channel: int, messages: int = 1) -> None:
        """Count messages of a channel."""
        self.counts[channel] = self.counts.get(channel, 0) + messages

    def describe(self, opcode: int, body: memoryview | bytes, place: int) -> None:
        """Take a schema or a channel."""
        if opcode == SCHEMA:
            number, schema = layout.parse_schema(body, place)
            self.schemas[number] = schema
        else:
            number, channel = layout.parse_channel(body, place, self.schemas)
            self.channels[number] = channel


def read_index(window: Window) -> Index:
    """Return what is in a file. DecodeError if it is no MCAP file at all."""
    if window.size < len(MAGIC) or window.at(0, len(MAGIC)) != MAGIC:
        raise DecodeError("byte 0: not an MCAP file, which begins with \\x89MCAP0")
    damages = []
    try:
        found = _summary(window)
        if found is not None:
            return found
    except Damaged as damage:
        damages.append(damage)
    found = _walk(window)
    found.damages[:0] = damages
    return found


# -- the summary -----------------------------------------------------------------------------------


def _summary(window: Window) -> Index | None:
    """Return what the end of a file says; None if it says nothing, or not enough."""
    place = window.size - _FOOTER
    if place < len(MAGIC) or window.at(window.size - len(MAGIC), len(MAGIC)) != MAGIC:
        return None
    opcode, length = HEAD.unpack(window.at(place, HEAD.size))
    if opcode != FOOTER or length != FOOTER_BODY.size:
        return None
    start, offsets, checksum = FOOTER_BODY.unpack(window.at(place + HEAD.size, FOOTER_BODY.size))
    if not start:
        return None
    if start > place or place - start > RECORDED_SUMMARY:
        raise Damaged(place, f"the summary is said to begin at byte {start}")
    data = window.at(start, place - start)
    signed = _SIGNED.pack(FOOTER, FOOTER_BODY.size, start, offsets)
    if checksum and crc32(signed, crc32(data)) != checksum:
        raise Damaged(start, "the summary has changed: its checksum is another one")
    index = Index()
    counted = False
    named: list[int] = []  # metadata and attachments
    for opcode, body, where in records_of(memoryview(data), start):
        if opcode in (SCHEMA, CHANNEL):
            index.describe(opcode, body, where)
        elif opcode == CHUNK_INDEX:
            cursor = Cursor(body, where)
            first, last, at, size = (cursor.u64() for _ in range(4))
            if at + size > window.size or size > RECORDED_CHUNK + _CHUNK_START:
                raise Damaged(where, f"a chunk of {size} bytes is said to be at byte {at}")
            index.add(at, size, first, last)
        elif opcode == STATISTICS:
            counted = True
            index.counts = _counts(body, where)
        elif opcode in (_METADATA_INDEX, _ATTACHMENT_INDEX):
            named.append(Cursor(body, where).u64())
    if not counted or (any(index.counts.values()) and not index.places):
        return None
    for at in named:
        try:
            opcode, length = HEAD.unpack(window.at(at, HEAD.size))
            if opcode == METADATA:
                _keep_metadata(index, window, at, length)
            elif opcode == ATTACHMENT:
                _keep_attachment(index, window, at, length)
        except Damaged as damage:
            index.damages.append(damage)
    index.complete = True
    return index


def _counts(body: memoryview, place: int) -> dict[int, int]:
    cursor = Cursor(body, place)
    cursor.data(8 + 2 + 4 + 4 + 4 + 4 + 8 + 8)
    end = cursor.u32() + cursor.at
    found = {}
    while cursor.at < end:
        number = cursor.u16()
        found[number] = cursor.u64()
    return found


def records_of(data: memoryview, place: int) -> Iterator[tuple[int, memoryview, int]]:
    """Yield the opcode, the content and the byte of each record. Raises Damaged."""
    at, size = 0, len(data)
    unpack = HEAD.unpack_from
    while at < size:
        if size - at < HEAD.size:
            raise Damaged(place + at, "a record ends in its head")
        opcode, length = unpack(data, at)
        start = at + HEAD.size
        if length > size - start:
            raise Damaged(place + at, f"a record of {length} bytes where {size - start} are left")
        at = start + length
        yield opcode, data[start:at], place + start


# -- the walk --------------------------------------------------------------------------------------


def _walk(window: Window) -> Index:
    index = Index()
    walk = _Walk(index, window)
    try:
        walk.go()
    except Damaged as damage:
        index.damages.append(damage)
    walk.end_run()
    return index


class _Walk:
    """Goes over a file from its beginning."""

    def __init__(self, index: Index, window: Window) -> None:
        self._index = index
        self._window = window
        self._run: list[int] = []  # place, length, first and last time of messages in a row
        self._chunk = (0, 0)  # place and length of the last one
        self._listed = True  # something says which messages are in it
        self._looked = True  # it was looked into for what it describes

    def go(self) -> None:
        window, place = self._window, len(MAGIC)
        while place < window.size:
            if window.size - place < HEAD.size:
                raise Damaged(place, "the file ends in the head of a record")
            opcode, length = HEAD.unpack(window.at(place, HEAD.size))
            if opcode not in layout.OPCODES and opcode < PRIVATE:
                raise Damaged(place, f"no record begins with {opcode}")
            after = place + HEAD.size + length
            if after > window.size:
                left = window.size - place - HEAD.size
                raise Damaged(place, f"a record of {length} bytes, of which {left} are there")
            if opcode != MESSAGE_INDEX:
                self._list()
            if opcode != MESSAGE:
                self.end_run()
            if opcode == DATA_END:
                return
            self._take(opcode, place, length)
            place = after
        self._list()

    def _take(self, opcode: int, place: int, length: int) -> None:
        window, index, body = self._window, self._index, place + HEAD.size
        if opcode == CHUNK:
            start = window.at(body, min(length, _CHUNK_START))
            head = layout.parse_chunk_head(start, body, length)
            index.add(place, HEAD.size + length, head.first, head.last)
            self._chunk = place, HEAD.size + length
            self._listed = self._looked = False
        elif opcode == MESSAGE_INDEX:
            channel, messages = layout.parse_index(window.at(body, min(length, 6)), body)
            index.count(channel, messages)
            self._listed = True
            if channel not in index.channels and not self._looked:
                self._look_into(count=False)
        elif opcode == MESSAGE:
            self._bare(place, length)
        elif opcode in (SCHEMA, CHANNEL):
            index.describe(opcode, window.at(body, _few(place, length)), body)
        elif opcode == METADATA:
            _keep_metadata(index, window, place, length)
        elif opcode == ATTACHMENT:
            _keep_attachment(index, window, place, length)

    def _list(self) -> None:
        """Count the messages of the chunk before, if no list of them has followed it."""
        if not self._listed:
            self._listed = True
            self._look_into(count=True)

    def _look_into(self, count: bool) -> None:
        """Take the channels that a chunk describes, and its messages if they are to be counted."""
        self._looked = True
        place, length = self._chunk
        index = self._index
        try:
            for opcode, body, where in records_of(*chunk_at(self._window, place, length)):
                if opcode in (SCHEMA, CHANNEL):
                    index.describe(opcode, body, where)
                elif opcode == MESSAGE and count:
                    index.count(Cursor(body, where).u16())
        except Damaged:
            pass  # it is told when its messages are read

    def _bare(self, place: int, length: int) -> None:
        if length < MESSAGE_HEAD.size:
            raise Damaged(place, f"a message of {length} bytes")
        head = self._window.at(place + HEAD.size, MESSAGE_HEAD.size)
        channel, _, received, _ = MESSAGE_HEAD.unpack(head)
        self._index.count(channel)
        whole, run = HEAD.size + length, self._run
        if run and run[1] + whole > _RUN:
            self.end_run()
            run = self._run
        if run:
            run[1] += whole
            run[2:] = min(run[2], received), max(run[3], received)
        else:
            run[:] = place, whole, received, received

    def end_run(self) -> None:
        """End the run: what comes next is no message."""
        if self._run:
            place, length, first, last = self._run
            self._index.add(place, length, first, last, bare=True)
            self._run = []


def chunk_at(window: Window, place: int, length: int) -> tuple[memoryview, int]:
    """Return the records of a chunk, and the byte of the file where they begin. Raises Damaged if
    they are not what was written."""
    body = place + HEAD.size
    opcode, said = HEAD.unpack(window.at(place, HEAD.size))
    if opcode != CHUNK or said != length - HEAD.size:
        raise Damaged(place, "there is no chunk where there should be one")
    head: ChunkHead = layout.parse_chunk_head(window.at(body, min(said, _CHUNK_START)), body, said)
    if head.compression == "" and head.length != head.size:
        raise Damaged(body, f"a chunk has {head.length} bytes instead of {head.size}")
    if head.length > RECORDED_CHUNK:
        raise Damaged(body, f"a chunk of {head.length} bytes")
    start = body + head.start
    packed = window.at(start, head.length)
    return memoryview(layout.unpacked(head, packed, place)), start


def _keep_metadata(index: Index, window: Window, place: int, length: int) -> None:
    body = place + HEAD.size
    name, values = layout.parse_metadata(window.at(body, _few(place, length)), body)
    index.metadata.setdefault(name, {}).update(values)


def _keep_attachment(index: Index, window: Window, place: int, length: int) -> None:
    if len(index.attachments) >= MOST:
        raise Damaged(place, f"more than {MOST} attachments")
    if place + HEAD.size + length > window.size:
        raise Damaged(place, f"an attachment of {length} bytes, which the file does not have")
    start = window.at(place + HEAD.size, min(length, START))
    index.attachments.append(parse_attachment(start, place, length))


def attachment_at(window: Window, found: Attachment) -> bytes:
    """Return what is in an attachment. Raises Damaged."""
    if found.size > LARGEST:
        raise Damaged(found.place, f"an attachment of {found.size} bytes; {LARGEST} are read")
    return content_of(found, bytes(window.at(found.place + HEAD.size, found.length)))


def _few(place: int, length: int) -> int:
    """Return the length of a record that is no message, if it can be one."""
    if length > RECORDED_TEXT * 16:
        raise Damaged(place, f"a description of {length} bytes")
    return length
