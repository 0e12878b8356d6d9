"""The ports of an MCAP file, and their messages as they were.

Rules: a channel that `yarpy record` has written says its port and the form of its envelopes; one of
another program is listed, and not read.
"""

from __future__ import annotations

import json
from collections.abc import Container, Iterator
from pathlib import Path
from typing import Any

from yarpy.errors import DecodeError
from yarpy.kits.record.envelope import envelope_of, stamp_text
from yarpy.kits.record.form.form import FORM, restored
from yarpy.kits.record.mcap.attachment import Attachment
from yarpy.kits.record.mcap.layout import Channel, Damaged, Other
from yarpy.kits.record.mcap.reader import McapFile
from yarpy.kits.record.mcap.writer import ENCODING, NOTES
from yarpy.kits.record.recorded import PortFacts, Recorded
from yarpy.limit import RECORDED_NOTES

FOREVER = (1 << 64) - 1


class McapStorage:
    """A file at `path`. Raises MissingFile; DecodeError if it is no MCAP file."""

    def __init__(self, path: str | Path) -> None:
        self._file = McapFile(path)
        self.path = self._file.path

    @property
    def size(self) -> int:
        """Return its size in bytes."""
        return self._file.size

    @property
    def begin(self) -> int:
        """Return when the first message was received, in nanoseconds; 0 if there is none."""
        return self._file.index.begin

    @property
    def end(self) -> int:
        """Return when the last message was received, in nanoseconds; 0 if there is none."""
        return self._file.index.end

    @property
    def complete(self) -> bool:
        """Return whether it was finished: a recorder that was killed leaves one that is not."""
        return self._file.index.complete

    @property
    def damages(self) -> list[Damaged]:
        """Return what is wrong with it, as far as it was read."""
        return self._file.damages

    @property
    def facts(self) -> dict[str, str]:
        """Return what was known when it was begun."""
        return self._file.index.metadata.get("yarpy", {})

    @property
    def attachments(self) -> list[Attachment]:
        """Return the files that were given to it."""
        return self._file.index.attachments

    def attached(self, found: Attachment) -> bytes:
        """Return what is in one of them. Raises Damaged."""
        return self._file.attached(found)

    @property
    def ports(self) -> dict[str, PortFacts]:
        """Return its ports by their names, in the order in which they came."""
        found: dict[str, PortFacts] = {}
        index = self._file.index
        for number, channel in sorted(index.channels.items()):
            if channel.topic == NOTES:
                continue
            facts = found.setdefault(channel.topic, PortFacts(channel.topic))
            facts.messages += index.counts.get(number, 0)
            kind = channel.schema.name or channel.encoding
            if _is_of_yarp(channel):
                kind = channel.metadata.get("kind", kind)
            if kind not in facts.kinds:
                facts.kinds.append(kind)
            facts.playable = facts.playable and _is_of_yarp(channel)
        return found

    def messages(
        self, ports: Container[str] | None = None, begin: int = 0, end: int = FOREVER
    ) -> Iterator[Recorded]:
        """Yield the messages of these ports (None: all) that came from `begin` until before `end`,
        in the order in which they came. Raises UnknownPlugin where a library is missing."""
        channels = self._file.channels
        # A channel is perhaps described in a chunk that is read later.
        wanted = None if ports is None else _Wanted(channels, ports)
        for number, sequence, received, sent, data in self._file.records(wanted, begin, end):
            channel = channels.get(number)
            if channel is None or not _is_of_yarp(channel):
                continue
            payload: memoryview | tuple[memoryview, ...]
            try:
                stamped = channel.metadata.get("envelope", "none")
                form = channel.metadata.get(FORM)
                if form is None:
                    envelope, payload = envelope_of(stamped, sequence, sent, data)
                else:
                    payload, envelope = restored(form, data, stamped == "text")
                    if stamped == "stamp":
                        envelope = stamp_text(sequence, sent)
            except DecodeError as error:
                self.damages.append(Damaged(0, f"a message of {channel.topic}: {error}"))
                continue
            yield Recorded(channel.topic, received, sent, envelope, payload)

    def others(
        self, ports: Container[str] | None = None, begin: int = 0, end: int = FOREVER
    ) -> Iterator[Other]:
        """Yield what is not of YARP: the messages of these topics (None: all) as they are."""
        channels = self._file.channels
        if all(map(_is_known, channels.values())) and self.complete:
            return
        wanted = None if ports is None else _Wanted(channels, ports)
        for number, sequence, received, sent, data in self._file.records(wanted, begin, end):
            channel = channels.get(number)
            if channel is not None and not _is_known(channel):
                yield Other(channel, sequence, received, sent, data)

    def notes(self) -> list[dict[str, Any]]:
        """Return what was noted while it was recorded, each with `time_ns`."""
        numbers = {n for n, one in self._file.channels.items() if one.topic == NOTES}
        found: list[dict[str, Any]] = []
        if not numbers:
            return found
        for record in self._file.records(numbers):
            try:
                note = json.loads(bytes(record.data))
            except (ValueError, RecursionError):
                continue
            if isinstance(note, dict) and len(found) < RECORDED_NOTES:
                found.append({**note, "time_ns": record.log_time})
        return found

    def close(self) -> None:
        """Close the file."""
        self._file.close()


def _is_known(channel: Channel) -> bool:
    return channel.topic == NOTES or _is_of_yarp(channel)


def _is_of_yarp(channel: Channel) -> bool:
    return channel.encoding == ENCODING or FORM in channel.metadata


class _Wanted:
    """The numbers of the channels of some ports."""

    def __init__(self, channels: dict[int, Channel], ports: Container[str]) -> None:
        self._channels = channels
        self._ports = ports

    def __contains__(self, number: object) -> bool:
        channel = self._channels.get(number)  # type: ignore[call-overload]
        return channel is not None and channel.topic in self._ports
