"""Bags of ROS that are written: what came from ROS as it was, and YARP's messages as ROS's.

    yarp/image        sensor_msgs/Image          yarp/pointcloud   sensor_msgs/PointCloud2
    a laser           sensor_msgs/LaserScan      stateExt:o        sensor_msgs/JointState
    numbers           std_msgs/Float64MultiArray all others        std_msgs/String, as text

Rules: a bag is never replaced. A topic of one type stays of it: what is of another one gets the
name of its type behind its own. Headers have the time of sending, and the port as their frame.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from yarpy.data.bottle import Bottle
from yarpy.errors import LocalProtocolError, UnknownPlugin, YarpError
from yarpy.kits.record.bag.reader import ENDING, NEEDS
from yarpy.kits.record.bag.spelling import Spelling
from yarpy.kits.record.envelope import fields_of
from yarpy.kits.record.kind import kind_of
from yarpy.kits.record.mcap.layout import Other
from yarpy.wire.message import DATA, Message

_ENCODINGS: Final = {1: "ros1", 2: "cdr"}


class BagWriter:
    """A new bag at `path`; `version` 1 is a file of ROS 1, 2 a folder of ROS 2. Raises
    FileExistsError, UnknownPlugin without the library."""

    def __init__(self, path: str | Path, version: int) -> None:
        try:
            from rosbags.rosbag1 import Writer as Writer1
            from rosbags.rosbag2 import StoragePlugin
            from rosbags.rosbag2 import Writer as Writer2
            from rosbags.typesys import Stores, get_typestore
        except ImportError:
            raise UnknownPlugin(NEEDS) from None
        where = Path(path)
        if version == 1 and where.suffix != ENDING:
            where = where.with_name(f"{where.name}{ENDING}")
        if where.exists():
            raise FileExistsError(17, "File exists", str(where))
        where.parent.mkdir(parents=True, exist_ok=True)
        self.path = where
        self.size = 0
        self.pending = 0
        self._version = version
        self._store = get_typestore(Stores.ROS1_NOETIC if version == 1 else Stores.ROS2_HUMBLE)
        self._spelling = Spelling(self._store.types)
        self._writer: Any = (
            Writer1(where)
            if version == 1
            else Writer2(where, version=8, storage_plugin=StoragePlugin.MCAP)
        )
        self._writer.open()
        self._connections: dict[tuple[Any, ...], Any] = {}
        self._topics: dict[str, str] = {}  # the type of each

    def add(self, port: str, envelope: str, received: int, payload: bytes | memoryview) -> None:
        """Take a message of YARP. Raises LocalProtocolError for what cannot be spelled."""
        _, sequence, sent = fields_of(envelope, received, 0)
        kind = kind_of(payload)
        found = self._spelling.spelled(port, kind, payload, sent, sequence)
        if found is None:
            try:
                text = Message(DATA, payload, "").as_(Bottle).to_text()
            except YarpError as error:
                raise LocalProtocolError(f"a message of {port} is no text: {error}") from error
            found = "std_msgs/msg/String", self._spelling.text(text)
        name, message = found
        spell: Any = self._store.serialize_ros1 if self._version == 1 else self._store.serialize_cdr
        self._write(self._of_yarp(port, name), received, bytes(spell(message, name)))

    def _of_yarp(self, port: str, name: str) -> Any:
        topic = self._topic(port, name)
        found = self._connections.get((topic, name))
        if found is None:
            found = self._writer.add_connection(topic, name, typestore=self._store)
            self._connections[topic, name] = found
        return found

    def _topic(self, port: str, name: str) -> str:
        if self._topics.setdefault(port, name) == name:
            return port
        return f"{port}/{name.rpartition('/')[2]}"

    def add_other(self, other: Other) -> None:
        """Take a message that is not of YARP. Raises LocalProtocolError if it is not of this ROS
        either."""
        channel = other.channel
        if channel.encoding != _ENCODINGS[self._version]:
            raise LocalProtocolError(
                f"{channel.topic} is {channel.encoding}, which a bag of ROS {self._version} has not"
            )
        key = (channel.topic, *channel.schema, *sorted(channel.metadata.items()))
        found = self._connections.get(key)
        if found is None:
            found = self._connections[key] = self._connection(other)
        self._write(found, other.received_ns, bytes(other.data))

    def _connection(self, other: Other) -> Any:
        channel = other.channel
        facts, schema = channel.metadata, channel.schema
        self._topics.setdefault(channel.topic, schema.name)
        definition = str(schema.data, "utf-8", "replace")
        if self._version == 1:
            latching = facts.get("latching")
            return self._writer.add_connection(
                channel.topic,
                schema.name if "/msg/" in schema.name else schema.name.replace("/", "/msg/", 1),
                msgdef=definition,
                md5sum=facts.get("md5sum") or "*",
                callerid=facts.get("callerid"),
                latching=int(latching) if latching in ("0", "1") else None,
            )
        return self._writer.add_connection(
            channel.topic,
            schema.name,
            msgdef=definition,
            rihs01=facts.get("type_hash", facts.get("topic_type_hash", "")) or _UNKNOWN,
            offered_qos_profiles=_qos(facts.get("offered_qos_profiles", "")),
        )

    def _write(self, connection: Any, time: int, data: bytes) -> None:
        self._writer.write(connection, time, data)
        self.size += len(data)

    def note(self, what: Mapping[str, Any], received: int) -> None:
        """Leave a note out."""

    def add_metadata(self, name: str, values: Mapping[str, str]) -> None:
        """Leave it out."""

    def flush(self) -> None:
        """Bags are written at their end."""

    def sync(self) -> None:
        """Bags are written at their end."""

    def close(self) -> None:
        """Finish it."""
        self._writer.close()


_UNKNOWN: Final = "RIHS01_" + 64 * "0"


def _qos(text: str) -> list[Any]:
    """Return the qualities of service that a publisher has offered; none for what is no such."""
    from rosbags.rosbag2.metadata import parse_qos

    try:
        return list(parse_qos(text)) if text else []
    except Exception:  # a stranger wrote it
        return []
