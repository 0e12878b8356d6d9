"""Messages of other systems as YARP's: what `yarpy play` sends of bags of ROS, and of files of MCAP
that others have written.

Rules: an encoding is a plug-in (registry kind `encodings`), which reads what a channel says of its
type and gives values of YARP. What nobody can read is left out, and told once for each topic. The
file itself is as it was: `yarpy convert` takes its messages without reading them.
"""

from __future__ import annotations

import heapq
from collections.abc import Callable, Collection, Iterator
from pathlib import Path
from typing import Any, TypeAlias

from yarpy import registry
from yarpy.data import codec
from yarpy.errors import DecodeError, YarpError
from yarpy.kits.record.bag.reader import BagStorage
from yarpy.kits.record.mcap.layout import Channel, Damaged, Other, Schema
from yarpy.kits.record.mcap.storage import FOREVER, McapStorage
from yarpy.kits.record.recorded import PortFacts, Recorded
from yarpy.kits.record.recording import Recording

Read: TypeAlias = Callable[[bytes], tuple[Any, Any, str]]


def with_foreign(recording: Recording) -> Recording:
    """Return a recording whose messages are also those of other systems. It is closed with the
    first one."""
    storages = [
        ForeignStorage(storage)
        if isinstance(storage, BagStorage | McapStorage) and _is_foreign(storage)
        else storage
        for storage in recording.storages
    ]
    return recording if storages == recording.storages else Recording(storages)


def _is_foreign(storage: BagStorage | McapStorage) -> bool:
    return not all(facts.playable for facts in storage.ports.values())


class ForeignMessage(Recorded):
    """A message that was not of YARP. `foreign` is the object of its type there."""

    __slots__ = ("foreign",)

    def __init__(self, other: Other, read: Read) -> None:
        """Raises DecodeError, TypeError and ValueError for what is nothing of that type."""
        self.foreign, value, envelope = read(bytes(other.data))
        payload = b"".join(codec.encode(value))
        super().__init__(other.channel.topic, other.received_ns, other.sent_ns, envelope, payload)


class ForeignStorage:
    """A file or folder whose messages are read as YARP's."""

    def __init__(self, storage: BagStorage | McapStorage) -> None:
        self._storage = storage
        self.path: Path = storage.path
        self._readers: dict[tuple[str, Schema], Read | None] = {}
        self._told: set[str] = set()

    @property
    def size(self) -> int:
        """Return its size in bytes."""
        return self._storage.size

    @property
    def begin(self) -> int:
        """Return when the first message was received, in nanoseconds; 0 if there is none."""
        return self._storage.begin

    @property
    def end(self) -> int:
        """Return when the last message was received, in nanoseconds; 0 if there is none."""
        return self._storage.end

    @property
    def complete(self) -> bool:
        """Return whether it was finished."""
        return self._storage.complete

    @property
    def damages(self) -> list[Damaged]:
        """Return what is wrong with it, and what nobody can read, as far as it was read."""
        return self._storage.damages

    @property
    def facts(self) -> dict[str, str]:
        """Return what was known when it was begun."""
        return self._storage.facts

    @property
    def ports(self) -> dict[str, PortFacts]:
        """Return its topics by their names. All of them may be played: what cannot be read is
        told then."""
        found = self._storage.ports
        for facts in found.values():
            facts.playable = True
        return found

    def messages(
        self, ports: Collection[str] | None = None, begin: int = 0, end: int = FOREVER
    ) -> Iterator[Recorded]:
        """Yield the messages of these topics (None: all) that came from `begin` until before
        `end`, in the order in which they came."""
        return heapq.merge(
            self._storage.messages(ports, begin, end),
            self._read(self._storage.others(ports, begin, end)),
            key=lambda recorded: recorded.received_ns,
        )

    def _read(self, others: Iterator[Other]) -> Iterator[Recorded]:
        for other in others:
            channel = other.channel
            try:
                read = self._reader(channel)
                if read is not None:
                    yield ForeignMessage(other, read)
            except (YarpError, TypeError, ValueError, OverflowError) as error:
                self._tell(channel, f"a message of {channel.topic}: {error}")

    def _reader(self, channel: Channel) -> Read | None:
        """Return what reads the messages of a channel; None if nobody can."""
        key = (channel.encoding, channel.schema)
        if key not in self._readers:
            self._readers[key] = None
            self._readers[key] = _reader(channel)
        return self._readers[key]

    def _tell(self, channel: Channel, why: str) -> None:
        if channel.topic not in self._told:
            self._told.add(channel.topic)
            self._storage.damages.append(Damaged(0, why))

    def notes(self) -> list[dict[str, Any]]:
        """Return what was noted while it was recorded."""
        return self._storage.notes()

    def close(self) -> None:
        """Close it."""
        self._storage.close()


def _reader(channel: Channel) -> Read:
    schema = channel.schema
    if channel.encoding not in registry.encodings.names():
        known = ", ".join(registry.encodings.names())
        raise DecodeError(
            f"nobody here reads the encoding {channel.encoding[:40]!r}: known are {known}"
        )
    found: Read = registry.encodings.load(channel.encoding)(
        schema.name, schema.encoding, str(schema.data, "utf-8", "replace")
    )
    return found
