"""Reading bags, the files in which `rosbag record` of ROS 1 keeps messages.

    with BagReader("walk.bag") as bag:
        for topic, message, time in bag.messages("/joint_states"):
            print(time.to_sec(), message.position)

Rules: messages are objects of the types that the file itself describes, in the order of their
times. Files come from anywhere: memory is bounded by the size of the file and by `ROS_BAG_CHUNK`,
and whatever is wrong in one is a DecodeError. Reading is done by the package rosbags.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, Final, NamedTuple, Self, TypeVar

from yarpy.bounded_file import BoundedFile, limited_like
from yarpy.errors import DecodeError, UnknownName, UnknownPlugin, YarpError
from yarpy.limit import ROS_BAG_CHUNK
from yarpy.log import readable
from yarpy.peers.ros.message.library import default_library
from yarpy.peers.ros.message.message import Message, Time
from yarpy.peers.ros.message.parse import peer_type_name

T = TypeVar("T")

NEEDED: Final = "bags need the library rosbags: pip install 'yarpy[ros]'"
_SECOND: Final = 1_000_000_000


class Recorded(NamedTuple):
    """A message of a file, and when it was received."""

    topic: str
    message: Any
    time: Time


class Topic(NamedTuple):
    """A topic of a file: its type as package/Type, and the number of its messages."""

    type: str
    messages: int


class BagReader:
    """A bag that is read; a context manager. Iterating gives all messages.

    Raises OSError, DecodeError (it is no bag, or a broken one), UnknownPlugin (without rosbags).
    """

    def __init__(self, path: str | Path) -> None:
        try:
            from rosbags.rosbag1 import Reader
        except ImportError as error:
            raise UnknownPlugin(NEEDED) from error
        self.path = Path(path)
        self._file = BoundedFile(self.path)
        self._kinds: dict[int, type[Message]] = {}
        file: Any = self._file  # it has what is asked of a path
        self._reader: Any = Reader(file)
        try:
            self._try(self._reader.open)
        except DecodeError:
            self._file.close()
            raise
        self._file.opened()
        for position, chunk in self._reader.chunks.items():
            unpack = limited_like(chunk.decompressor, ROS_BAG_CHUNK)
            self._reader.chunks[position] = chunk._replace(decompressor=unpack)

    @property
    def topics(self) -> dict[str, Topic]:
        """The topics in the file; of one with messages of several types, the type is the first."""
        found: dict[str, Topic] = {}
        for each in self._reader.connections:
            before = found.get(each.topic)
            type_ = self._try(peer_type_name, each.msgtype)
            found[each.topic] = (
                Topic(type_, each.msgcount)
                if before is None
                else before._replace(messages=before.messages + each.msgcount)
            )
        return found

    def messages(
        self, *topics: str, start: Time | float | None = None, end: Time | float | None = None
    ) -> Iterator[Recorded]:
        """The messages of these topics, of all without any, from `start` on and before `end`: a
        Time, or seconds since 1970. Raises DecodeError, UnknownType, UnknownName (no such topic in
        the file).
        """
        connections = self._reader.connections
        unknown = [topic for topic in topics if topic not in self.topics]
        if unknown:
            known = ", ".join(self.topics) or "nothing"
            raise UnknownName(f'"{self.path}" has no topic "{unknown[0]}"; it has {known}')
        if topics:
            connections = [each for each in connections if each.topic in topics]
        if not connections:
            return
        found = self._reader.messages(
            connections, start=_nanoseconds(start), stop=_nanoseconds(end)
        )
        while True:
            item: Any = self._try(next, found, None)
            if item is None:
                return
            connection, time, data = item
            message = self._try(self._decoded, connection, data)
            yield Recorded(connection.topic, message, Time(*divmod(time, _SECOND)))

    def __iter__(self) -> Iterator[Recorded]:
        return self.messages()

    def _kind(self, connection: Any) -> type[Message]:
        """The class of the messages of a connection, by the definition in the file."""
        kind = self._kinds.get(connection.id)
        if kind is None:
            name, text = peer_type_name(connection.msgtype), connection.msgdef.data
            library = default_library()
            kind = library.message_of(name, text) if text.strip() else library.message(name)
            self._kinds[connection.id] = kind
        return kind

    def _decoded(self, connection: Any, data: bytes) -> Message:
        return self._kind(connection).from_ros(data)

    def _try(self, step: Callable[..., T], *arguments: Any) -> T:
        """The result of a step. Whatever goes wrong in it is in the file: DecodeError."""
        try:
            return step(*arguments)
        except YarpError as error:
            raise _with_path(error, self.path) from error
        except Exception as error:
            why = readable(str(error)[:200]) or type(error).__name__
            advice = (
                ": it was cut off or not closed (`rosbag reindex` repairs that)"
                if "index" in why
                else ""
            )
            raise DecodeError(f'"{self.path}" cannot be read as a bag: {why}{advice}') from error

    def close(self) -> None:
        """Close the file. Idempotent."""
        self._file.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *details: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"BagReader({str(self.path)!r})"


def _with_path(error: YarpError, path: Path) -> YarpError:
    return type(error)(f'"{path}": {error}')


def _nanoseconds(when: Time | float | None) -> int | None:
    if when is None:
        return None
    time = when if isinstance(when, Time) else Time.from_sec(when)
    return time.secs * _SECOND + time.nsecs
