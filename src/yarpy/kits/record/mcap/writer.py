"""An MCAP file that is being written: topic = port, the bytes of YARP as they came.

    sequence       the count of the envelope; without one, the number of the message
    publish_time   the time of the envelope; without one, that of receipt
    log_time       the receipt
    data           the message in YARP's binary spelling (see `envelope.py` for the text form), or
                   in a form that other programs see, with YARP's bytes in it (`form/form.py`)

What was noted of the recording itself is JSON on the topic `yarpy.record`.

Rules: for one thread. Nothing is copied into chunks: their messages are handed to the system as
they are. The file can be read up to the last `flush` whatever happens; a write that fails is taken
back, so that it ends with a whole chunk.
"""

from __future__ import annotations

import io
import json
import os
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from struct import Struct
from typing import Any, Final, Self

from yarpy import __version__
from yarpy.errors import LocalProtocolError, UnknownPlugin
from yarpy.kits.record.envelope import LENGTH, fields_of
from yarpy.kits.record.form.converter import Converter
from yarpy.kits.record.form.form import FORM, Form
from yarpy.kits.record.kind import kind_of
from yarpy.kits.record.mcap.checksum import crc32
from yarpy.kits.record.mcap.layout import MAGIC, MESSAGE, WHOLE_MESSAGE, Bytes, Other
from yarpy.kits.record.mcap.pieces import compressor, joined, write_all
from yarpy.limit import RECORDED_CHUNK

CHUNK_SIZE: Final = 4 << 20  # bytes after which a chunk is written; less after a `flush`
LARGEST: Final = RECORDED_CHUNK - (1 << 16)  # bytes of a message
NOTES: Final = "yarpy.record"  # the topic of notes
ENCODING: Final = "yarp"  # of messages
_NOTE: Final = Form("", "json", "yarpy.Note", "", b"")
_CHANNELS: Final = 0xFFFF
_ENTRY: Final = Struct("<QQ")
_NEVER: Final = (1 << 64) - 1  # a time


class McapWriter:
    """A new file at `path`. Raises FileExistsError: recordings are never replaced.

    compression: "none", "lz4" or "zstd".
    metadata: what is known of the recording, kept as the metadata `yarpy`.
    plain: keep every message as it is, for YARP alone.
    Raises UnknownPlugin if the library `mcap` is not installed, OSError.
    """

    def __init__(
        self,
        path: str | Path,
        compression: str = "none",
        metadata: Mapping[str, str] | None = None,
        plain: bool = False,
    ) -> None:
        try:
            from mcap import records
            from mcap.data_stream import RecordBuilder
        except ImportError:
            raise UnknownPlugin(
                'MCAP files need a library: pip install "yarpy[record]"; '
                "--format dumper does without"
            ) from None
        self._records = records
        self._builder = RecordBuilder
        self._compression = "" if compression == "none" else compression
        self._compress = compressor(compression)
        self.path = Path(path)
        self._file = io.FileIO(path, "x")
        self.size = 0  # bytes in the file
        self.messages = 0
        self._converter = None if plain else Converter()
        self._channels: dict[tuple[Any, ...], int] = {}
        self._described: list[Any] = []  # all schemas and channels
        self._schemas: dict[tuple[str, bytes], int] = {}
        self._counts: dict[int, int] = {}
        self._numbers: dict[str, int] = {}  # messages of each topic
        self._span = (0, 0)
        self._chunk_indexes = io.BytesIO()
        self._chunks = 0
        self._metadata: list[Any] = []
        self._attached: list[Any] = []
        self._notes = 0
        self._begin_chunk()
        try:
            self._append([MAGIC, self._encoded(records.Header("", f"yarpy {__version__}"))])
            if metadata is not None:
                self.add_metadata("yarpy", metadata)
        except OSError:
            self._file.close()
            with suppress(OSError):
                self.path.unlink()  # nothing is in it
            raise

    def _begin_chunk(self) -> None:
        self._parts: list[Bytes] = []
        self._chunk_size = 0
        self._first, self._last = _NEVER, 0  # receipt
        self._entries: dict[int, bytearray] = {}

    @property
    def pending(self) -> int:
        """Return how many bytes are not in the file yet."""
        return self._chunk_size

    def add(self, port: str, envelope: str, received: int, payload: Bytes) -> None:
        """Take a message that came from `port`; `received` in nanoseconds since 1970. `payload` is
        kept until the next `flush`. Raises OSError, LocalProtocolError for what is too large."""
        number = self._numbers.get(port, 0)
        self._numbers[port] = number + 1
        form, sequence, sent = fields_of(envelope, received, number)
        kind = kind_of(payload)
        text = envelope.encode("utf-8", "surrogateescape") if form == "text" else None
        converter = self._converter
        shown = None if converter is None else converter.converted(port, kind, payload, sent)
        parts: tuple[Bytes, ...]
        if shown is not None:
            key: tuple[str, ...] = port, kind, form, shown.form.schema, shown.form.name
            parts = shown.parts(text)
        else:
            key = port, kind, form
            parts = (payload,) if text is None else (LENGTH.pack(len(text)) + text, payload)
        channel = self._channels.get(key)
        if channel is None:
            facts = {"port": port, "kind": kind, "envelope": form}
            channel = self._channel(
                key, shown.form if shown else Form("", ENCODING, kind, "", b""), facts
            )
        self._take(channel, sequence, received, sent, sum(map(len, parts)), parts)

    def add_other(self, other: Other) -> None:
        """Take a message that is not of YARP, as it is. Raises OSError, LocalProtocolError."""
        channel = other.channel
        key = (channel.topic, channel.encoding, *channel.schema, *sorted(channel.metadata.items()))
        number = self._channels.get(key)
        if number is None:
            name, encoding, data = channel.schema
            form = Form("", channel.encoding, name, encoding, data)
            number = self._channel(key, form, channel.metadata)
        times = other.received_ns, other.sent_ns
        self._take(number, other.sequence, *times, len(other.data), (other.data,))

    def note(self, what: Mapping[str, Any], received: int) -> None:
        """Take a note about the recording itself, as JSON. Raises OSError."""
        data = json.dumps(what, ensure_ascii=False).encode("utf-8", "replace")
        key = NOTES, "yarpy.Note", ""
        channel = self._channels.get(key)
        if channel is None:
            channel = self._channel(key, _NOTE, {})
        self._notes += 1
        self._take(channel, self._notes, received, received, len(data), (data,))

    def _take(
        self,
        channel: int,
        sequence: int,
        received: int,
        sent: int,
        size: int,
        parts: tuple[Bytes, ...],
    ) -> None:
        if size > LARGEST:
            raise LocalProtocolError(f"a message of {size} bytes; a file takes {LARGEST}")
        whole = size + WHOLE_MESSAGE.size
        if self._chunk_size + whole > RECORDED_CHUNK:
            self._end_chunk()
        entries = self._entries.get(channel)
        if entries is None:
            entries = self._entries[channel] = bytearray()
        entries += _ENTRY.pack(received, self._chunk_size)
        head = WHOLE_MESSAGE.pack(MESSAGE, size + 22, channel, sequence, received, sent)
        self._parts += (head, *parts)
        self._chunk_size += whole
        if received > self._last:
            self._last = received
        if received < self._first:
            self._first = received
        self.messages += 1
        if self._chunk_size >= CHUNK_SIZE:
            self._end_chunk()

    def _channel(self, key: tuple[Any, ...], form: Form, facts: dict[str, str]) -> int:
        """Return the number of a new channel, which is described in the chunk."""
        number = len(self._channels) + 1
        if number > _CHANNELS:
            raise LocalProtocolError(f"a file takes {_CHANNELS} ports and types, and has them all")
        named = form.schema, form.description
        schema = self._schemas.get(named) if form.schema else 0
        if schema is None:
            schema = self._schemas[named] = len(self._schemas) + 1
            self._describe(
                self._records.Schema(
                    id=schema,
                    data=form.description,
                    encoding=form.schema_encoding,
                    name=form.schema,
                )
            )
        self._describe(
            self._records.Channel(
                id=number,
                topic=key[0],
                message_encoding=form.encoding,
                metadata={**facts, FORM: form.name} if form.name else facts,
                schema_id=schema,
            )
        )
        self._channels[key] = number
        return number

    def _describe(self, record: Any) -> None:
        """Put a schema or channel into the chunk, and remember it for the summary."""
        self._described.append(record)
        data = self._encoded(record)
        self._parts.append(data)
        self._chunk_size += len(data)

    def add_metadata(self, name: str, values: Mapping[str, str]) -> None:
        """Write names and values into the file, behind what was added before. Raises OSError."""
        self._end_chunk()
        data = self._encoded(self._records.Metadata(name=name, metadata=dict(values)))
        index = self._records.MetadataIndex(offset=self.size, length=len(data), name=name)
        self._append([data])
        self._metadata.append(index)

    def attach(self, name: str, content: bytes, kind: str) -> None:
        """Write a file into this one, of the type `kind` (`text/xml`). Raises OSError."""
        self._end_chunk()
        now, records = time.time_ns(), self._records
        facts = {"create_time": now, "log_time": now, "media_type": kind, "name": name}
        data = self._encoded(records.Attachment(data=content, **facts))
        index = records.AttachmentIndex(
            data_size=len(content), length=len(data), offset=self.size, **facts
        )
        self._append([data])
        self._attached.append(index)

    def flush(self) -> None:
        """Hand everything to the system: from here on a kill of this program loses nothing of it.
        Raises OSError; what could not be written is no more then."""
        self._end_chunk()

    def sync(self) -> None:
        """Wait until the disk has what the system has. Any thread may call it."""
        with suppress(ValueError):  # closed meanwhile
            getattr(os, "fdatasync", os.fsync)(self._file.fileno())

    def _end_chunk(self) -> None:
        span, size, entries = (self._first, self._last), self._chunk_size, self._entries
        if not entries:
            return  # at most descriptions, which wait for the first message
        parts = joined(self._parts)
        counts = {channel: len(listed) // _ENTRY.size for channel, listed in entries.items()}
        self._begin_chunk()
        checksum = 0
        for part in parts:
            checksum = crc32(part, checksum)
        packed = size
        if self._compress is not None:
            parts = [self._compress(b"".join(parts))]
            packed = len(parts[0])
        word = self._compression.encode()
        head = b"".join(
            (
                Struct("<BQ").pack(6, 40 + len(word) + packed),
                Struct("<QQQII").pack(*span, size, checksum, len(word)),
                word,
                packed.to_bytes(8, "little"),
            )
        )
        begin, offsets, indexes = self.size, {}, []
        place = begin + len(head) + packed
        for channel, listed in entries.items():
            offsets[channel] = place
            index = Struct("<BQHI").pack(7, 6 + len(listed), channel, len(listed)) + listed
            indexes.append(index)
            place += len(index)
        try:
            self._append([head, *parts, b"".join(indexes)])
        except OSError:
            self.messages -= sum(counts.values())
            raise
        for channel, count in counts.items():
            self._counts[channel] = self._counts.get(channel, 0) + count
        self._span = (
            (min(self._span[0], span[0]), max(self._span[1], span[1])) if self._chunks else span
        )
        self._chunks += 1
        self._chunk_indexes.write(
            self._encoded(
                self._records.ChunkIndex(
                    chunk_length=len(head) + packed,
                    chunk_start_offset=begin,
                    compression=self._compression,
                    compressed_size=packed,
                    message_end_time=span[1],
                    message_index_length=place - begin - len(head) - packed,
                    message_index_offsets=offsets,
                    message_start_time=span[0],
                    uncompressed_size=size,
                )
            )
        )

    def _append(self, parts: Sequence[Bytes]) -> None:
        """Write all of it, or nothing."""
        try:
            written = write_all(self._file, parts)
        except OSError as error:
            error.filename = str(self.path)
            with suppress(OSError):
                self._file.truncate(self.size)
                self._file.seek(self.size)
            raise
        self.size += written

    def _encoded(self, record: Any) -> bytes:
        builder: Any = self._builder()
        record.write(builder)
        data: bytes = builder.end()
        return data

    def close(self) -> None:
        """Write the rest and the summary. Raises OSError; the file is closed in any case, and can
        be read without its summary."""
        if self._file.closed:
            return
        try:
            self._end_chunk()
            self._append(self._summary())
            self.sync()
        finally:
            self._file.close()

    def _summary(self) -> list[Bytes]:
        records, encoded = self._records, self._encoded
        end = encoded(records.DataEnd(0))
        start = self.size + len(end)
        schemas = [one for one in self._described if isinstance(one, records.Schema)]
        channels = [one for one in self._described if isinstance(one, records.Channel)]
        statistics = records.Statistics(
            attachment_count=len(self._attached),
            channel_count=len(channels),
            channel_message_counts=self._counts,
            chunk_count=self._chunks,
            message_count=self.messages,
            metadata_count=len(self._metadata),
            message_start_time=self._span[0],
            message_end_time=self._span[1],
            schema_count=len(schemas),
        )
        groups = [
            (3, b"".join(map(encoded, schemas))),
            (4, b"".join(map(encoded, channels))),
            (11, encoded(statistics)),
            (8, self._chunk_indexes.getvalue()),
            (10, b"".join(map(encoded, self._attached))),
            (13, b"".join(map(encoded, self._metadata))),
        ]
        place, offsets = start, []
        for opcode, data in groups:
            if data:
                offsets.append(
                    encoded(
                        records.SummaryOffset(
                            group_opcode=opcode, group_start=place, group_length=len(data)
                        )
                    )
                )
            place += len(data)
        whole = [*(data for _, data in groups), *offsets]
        checksum = 0
        for part in (*whole, Struct("<BQQQ").pack(2, 20, start, place)):
            checksum = crc32(part, checksum)
        footer = records.Footer(
            summary_start=start, summary_offset_start=place, summary_crc=checksum
        )
        return [end, *whole, encoded(footer), MAGIC]

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *details: object) -> None:
        self.close()
