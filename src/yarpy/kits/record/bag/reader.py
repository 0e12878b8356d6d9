"""Bags of ROS that are read: a file `.bag` of ROS 1, the folder of a bag of ROS 2.

Rules: messages are handed on as they are, with the definitions of their types, so that a bag that
is written of them again has the same bytes. The time of a bag is that of receipt and of sending.
What the library makes of a damaged bag becomes a DecodeError.
"""

from __future__ import annotations

from collections.abc import Container, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from yarpy.bounded_file import BoundedFile, limited_like
from yarpy.errors import DecodeError, MissingFile, UnknownPlugin
from yarpy.kits.record.bag.bounded_folder import open_folder
from yarpy.kits.record.mcap.layout import Channel, Damaged, Other, Schema
from yarpy.kits.record.mcap.storage import FOREVER
from yarpy.kits.record.recorded import PortFacts, Recorded
from yarpy.limit import ROS_BAG_CHUNK

if TYPE_CHECKING:
    from rosbags.interfaces import Connection

NEEDS: Final = 'bags of ROS need a library: pip install "yarpy[ros]"'
ENDING: Final = ".bag"
_LAST: Final = (1 << 63) - 1


def is_bag(path: Path) -> bool:
    """Return whether a path is that of a bag."""
    return path.suffix == ENDING or (path / "metadata.yaml").is_file()


class BagStorage:
    """A bag at `path`. Raises MissingFile; DecodeError if it is none, UnknownPlugin."""

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        try:
            from rosbags.rosbag1 import Reader as Reader1
        except ImportError:
            raise UnknownPlugin(NEEDS) from None
        if not self.path.exists():
            raise MissingFile(f"{path} cannot be read: there is no such file")
        self.damages: list[Damaged] = []
        self.complete = True
        self._reader: Any
        self._file = None if self.path.is_dir() else BoundedFile(self.path)
        file: Any = self._file  # it has what is asked of a path
        try:
            if file is None:
                self._reader = open_folder(self.path)
            else:
                self._reader = Reader1(file)
                self._reader.open()
                file.opened()
                for position, chunk in self._reader.chunks.items():
                    unpack = limited_like(chunk.decompressor, ROS_BAG_CHUNK)
                    self._reader.chunks[position] = chunk._replace(decompressor=unpack)
        except Exception as error:  # whatever the library raises for what a stranger wrote
            where = "" if file is None else f" byte {file.place}:"
            if file is not None:
                file.close()
            raise DecodeError(f"{path}:{where} {error or type(error).__name__}") from error
        kind = "ROS 2" if self.path.is_dir() else "ROS 1"
        self.facts = {"bag": kind}
        self._ros2 = self.path.is_dir()
        self._channels = {one.id: self._channel(one) for one in self._reader.connections}

    def _channel(self, one: Connection) -> Channel:
        definition = Schema(one.msgtype, "ros2msg" if self._ros2 else "ros1msg")
        definition = definition._replace(data=one.msgdef.data.encode())
        ext: Any = one.ext
        if self._ros2:
            facts = {"type_hash": one.digest, "offered_qos_profiles": _qos_text(ext)}
            if one.msgdef.format.name == "IDL":
                definition = definition._replace(encoding="ros2idl")
            return Channel(one.topic, ext.serialization_format, definition, facts)
        facts = {"md5sum": one.digest}
        if ext.callerid is not None:
            facts["callerid"] = ext.callerid
        if ext.latching is not None:
            facts["latching"] = str(ext.latching)
        # In files of MCAP types of ROS 1 have their own, shorter names.
        definition = definition._replace(name=one.msgtype.replace("/msg/", "/"))
        return Channel(one.topic, "ros1", definition, facts)

    @property
    def size(self) -> int:
        """Return its size in bytes."""
        if not self._ros2:
            return self.path.stat().st_size
        return sum(one.stat().st_size for one in self.path.iterdir() if one.is_file())

    @property
    def begin(self) -> int:
        """Return when the first message was received, in nanoseconds; 0 if there is none."""
        return int(self._reader.start_time) if self._reader.message_count else 0

    @property
    def end(self) -> int:
        """Return when the last message was received, in nanoseconds; 0 if there is none."""
        return int(self._reader.end_time) - 1 if self._reader.message_count else 0

    @property
    def ports(self) -> dict[str, PortFacts]:
        """Return its topics by their names."""
        found: dict[str, PortFacts] = {}
        for one in self._reader.connections:
            facts = found.setdefault(one.topic, PortFacts(one.topic, playable=False))
            facts.messages += one.msgcount
            if one.msgtype not in facts.kinds:
                facts.kinds.append(one.msgtype)
        return found

    def messages(
        self, ports: Container[str] | None = None, begin: int = 0, end: int = FOREVER
    ) -> Iterator[Recorded]:
        """Yield nothing: the messages are ROS's, and `others`."""
        yield from ()

    def others(
        self, ports: Container[str] | None = None, begin: int = 0, end: int = FOREVER
    ) -> Iterator[Other]:
        """Yield the messages of these topics (None: all) from `begin` until before `end`."""
        wanted = [one for one in self._reader.connections if ports is None or one.topic in ports]
        if not wanted:
            return
        counts: dict[int, int] = {}
        series = self._reader.messages(wanted, start=begin or None, stop=min(end, _LAST))
        while True:
            try:
                one, time, data = next(series)
            except StopIteration:
                return
            except Exception as error:
                place = 0 if self._file is None else self._file.place
                why = str(error) or type(error).__name__
                self.damages.append(Damaged(place, f"the bag cannot be read on: {why}"))
                return
            number = counts.get(one.id, 0)
            counts[one.id] = number + 1
            yield Other(self._channels[one.id], number & 0xFFFFFFFF, time, time, data)

    def notes(self) -> list[dict[str, Any]]:
        """Return nothing: bags have no notes."""
        return []

    def close(self) -> None:
        """Close it. Idempotent."""
        if self._file is not None:
            self._file.close()
        elif self._reader.is_open:
            self._reader.close()


def _qos_text(ext: Any) -> str:
    from rosbags.rosbag2.metadata import dump_qos_v8

    return str(dump_qos_v8(ext.offered_qos_profiles))
