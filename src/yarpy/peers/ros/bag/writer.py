"""Writing bags, the files that `rosbag play` of ROS 1 sends again.

    with Node("/recorder") as node, BagWriter("walk.bag") as bag:
        node.subscriber("/joint_states", None, lambda message: bag.write("/joint_states", message))
        time.sleep(60)

Rules: what is written is an object of a type of ROS, or a value of YARP and the type that it is to
become. Any thread may write. A file that was not closed cannot be read before `rosbag reindex`; one
that exists is never replaced. Writing is done by the package rosbags.
"""

from __future__ import annotations

import threading
import time as clock
from pathlib import Path
from typing import Any, Final, Literal, Self

from yarpy.data.stamp import Stamp
from yarpy.errors import LocalProtocolError, UnknownPlugin
from yarpy.peers.ros.bag.reader import NEEDED
from yarpy.peers.ros.graph_name import check_graph_name
from yarpy.peers.ros.message.convert.native import to_message
from yarpy.peers.ros.message.library import default_library
from yarpy.peers.ros.message.message import Message, Time

_SECOND: Final = 1_000_000_000
_LATEST: Final = (1 << 32) * _SECOND  # what the file can say

Compression = Literal["none", "bz2", "lz4"]


def _lz4(data: bytes) -> bytes:
    """As ROS has it. It refuses the sizes and the linked blocks that are usual elsewhere."""
    from lz4.frame import BLOCKSIZE_MAX4MB, compress

    found: bytes = compress(
        data,
        block_size=BLOCKSIZE_MAX4MB,
        block_linked=False,
        content_checksum=True,
        store_size=False,
    )
    return found


class BagWriter:
    """A new bag; a context manager. `compression`: bz2 is small, lz4 is quick.

    Raises FileExistsError and other OSErrors, UnknownPlugin (without rosbags).
    """

    def __init__(self, path: str | Path, compression: Compression = "none") -> None:
        try:
            from rosbags.rosbag1 import Writer
        except ImportError as error:
            raise UnknownPlugin(NEEDED) from error
        self.path = Path(path)
        if self.path.exists():
            raise FileExistsError(f'"{path}" exists already; bags are not replaced')
        self._writer: Any = Writer(self.path)
        if compression != "none":
            self._writer.set_compression(Writer.CompressionFormat[compression.upper()])
        if compression == "lz4":
            self._writer.compressor = _lz4
        self._writer.open()
        self._connections: dict[tuple[str, str, str], Any] = {}
        self._count = -1
        self._closed = False
        self._lock = threading.RLock()  # threads of several connections write

    def write(
        self,
        topic: str,
        value: object,
        time: Time | float | None = None,
        type_: str | type[Message] = "",
    ) -> None:
        """Add a message. `time`: when it came, a Time or seconds since 1970; without it: now.

        `type_` is needed for what is no object of a type of ROS: a value of YARP, a dict or list of
        fields. Raises AddressError (a name that no topic has), UnknownType, LocalProtocolError (the
        file is closed), OSError; TypeError, ValueError or OverflowError for what is nothing of the
        type.
        """
        name = check_graph_name(topic)
        seconds = clock.time() if time is None else time
        moment = seconds if isinstance(seconds, Time) else Time.from_sec(seconds)
        when = moment.secs * _SECOND + moment.nsecs
        if not 0 <= when < _LATEST:
            raise ValueError(f"{time} is no time that a bag can say: from 1970 to 2106")
        message = self._message(value, type_, moment)
        data = b"".join(message.to_ros())
        with self._lock:
            if self._closed:
                raise LocalProtocolError(f'"{self.path}" is closed')
            self._writer.write(self._connection(name, type(message)), when, data)

    def _message(self, value: object, type_: str | type[Message], time: Time) -> Message:
        """The value as an object of the type."""
        if not type_:
            if isinstance(value, Message):
                return value
            raise TypeError(f"the type of {type(value).__name__} in ROS has to be said: type_=...")
        kind = default_library().message(type_) if isinstance(type_, str) else type_
        self._count = (self._count + 1) & 0x7FFFFFFF
        return to_message(value, kind, Stamp(self._count, time.to_sec()))

    def _connection(self, topic: str, kind: type[Message]) -> Any:
        key = topic, kind._type, kind._md5sum
        found = self._connections.get(key)
        if found is None:
            package, _, plain = kind._type.partition("/")
            found = self._connections[key] = self._writer.add_connection(
                topic, f"{package}/msg/{plain}", msgdef=kind._full_text, md5sum=kind._md5sum
            )
        return found

    def close(self) -> None:
        """Write the index, and close the file. Idempotent. Raises OSError."""
        with self._lock:
            if not self._closed:
                self._closed = True
                try:
                    self._writer.close()
                except BaseException:
                    self._writer.abort()
                    raise

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *details: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"BagWriter({str(self.path)!r})"
