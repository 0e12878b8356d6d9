"""ConnectionReader and ConnectionWriter: how a message is read and answered piece by piece.

Rules: what is expected and is not there is 0 or "", and from then on `isError` is true. A writer
collects; what it holds is sent when the method that it was given to returns.
"""

from __future__ import annotations

import struct
from typing import Any

import yarpy


class ConnectionWriter:
    """Takes an object, or numbers and strings one after the other."""

    def __init__(self) -> None:
        self._object: Any = None
        self._bytes = bytearray()
        self._reference: Any = None
        self._handler: Any = None

    def _put(self, writer: Any) -> None:
        self._object = writer._outgoing()

    def _outgoing(self) -> Any:
        found = Raw(bytes(self._bytes)) if self._object is None else self._object
        return found if self._handler is None else Asking(found, self._handler)

    @property
    def _empty(self) -> bool:
        return self._object is None and not self._bytes

    @staticmethod
    def createBufferedConnectionWriter() -> ConnectionWriter:
        """Return one that collects."""
        return ConnectionWriter()

    @staticmethod
    def writeToStream(portable: Any, os: Any) -> bool:
        """Write the message of an object to an open file, or another object with `write`."""
        from yarp._memory import encoded

        os.write(bytes(encoded(portable._outgoing())))
        return True

    def getBuffer(self) -> bytes:
        """Return the bytes that were collected."""
        from yarp._memory import encoded

        return bytes(encoded(self._outgoing()))

    def setReference(self, obj: Any) -> None:
        """Name the object that is written; a reader of what was written here is given it."""
        self._reference = obj

    def setReplyHandler(self, reader: Any) -> None:
        """Let the message be a question: each answer is read by `reader`."""
        self._handler = reader

    def requestDrop(self) -> None:
        """The receiver ends the connection itself."""

    def declareSizes(self, argc: int, argv: Any) -> None:
        """Say how large the next blocks are; a hint, of which nothing follows here."""

    def appendInt8(self, data: int) -> None:
        self._bytes += struct.pack("<b", data)

    def appendInt16(self, data: int) -> None:
        self._bytes += struct.pack("<h", data)

    def appendInt32(self, data: int) -> None:
        self._bytes += struct.pack("<i", data)

    def appendInt64(self, data: int) -> None:
        self._bytes += struct.pack("<q", data)

    def appendFloat32(self, data: float) -> None:
        self._bytes += struct.pack("<f", data)

    def appendFloat64(self, data: float) -> None:
        self._bytes += struct.pack("<d", data)

    def appendString(self, str: str, terminate: str = "\n") -> None:
        """A length and the text."""
        data = str.encode("utf-8", "surrogateescape")
        self.appendInt32(len(data))
        self._bytes += data

    def appendText(self, str: str, terminate: str = "\n") -> None:
        """The text and its end."""
        self._bytes += (str + terminate).encode("utf-8", "surrogateescape")

    def appendRawString(self, str: str) -> None:
        self._bytes += str.encode("utf-8", "surrogateescape")

    def appendBlock(self, data: bytes | str, len: int | None = None) -> None:
        raw = data.encode("utf-8", "surrogateescape") if isinstance(data, str) else bytes(data)
        self._bytes += raw[:len]

    appendInt = appendInt32
    appendDouble = appendFloat64
    appendExternalBlock = appendBlock

    def convertTextMode(self) -> bool:
        return True

    def isTextMode(self) -> bool:
        return False

    def isBareMode(self) -> bool:
        return False

    def isValid(self) -> bool:
        return True

    def isActive(self) -> bool:
        return True

    def isError(self) -> bool:
        return False

    def isNull(self) -> bool:
        return False


class Raw:
    """Bytes that are a message already."""

    def __init__(self, data: bytes) -> None:
        self._data = data

    def to_wire(self) -> tuple[bytes, ...]:
        return (self._data,)


class Asking(Raw):
    """A message whose answers somebody reads."""

    def __init__(self, message: Any, reader: Any) -> None:
        from yarp._memory import encoded

        super().__init__(encoded(message))
        self.reader = reader


class ConnectionReader:
    """A message that has come."""

    def __init__(self, message: yarpy.Message, reference: Any = None, receiver: str = "") -> None:
        self._message = message
        self._reference, self._receiver = reference, receiver
        self._parent: ConnectionReader | None = None
        self._end: int | None = None
        self._at = 0
        self._error = False
        self._writer: ConnectionWriter | None = None
        self._pushed: int | None = None

    def _fill(self, reader: Any) -> bool:
        try:
            reader._take(self._message)
        except (yarpy.DecodeError, struct.error):
            self._error = True
            return False
        return True

    @staticmethod
    def createConnectionReader(is_: Any) -> ConnectionReader:
        """Return a reader of bytes, or of an open file."""
        data = bytes(is_.read() if hasattr(is_, "read") else is_)
        return ConnectionReader(yarpy.Message("D", data))

    @staticmethod
    def readFromStream(portable: Any, is_: Any) -> bool:
        """Fill an object from bytes, or from an open file."""
        return bool(portable.read(ConnectionReader.createConnectionReader(is_)))

    def setSize(self, len: int) -> bool:
        """Let so many bytes be left; False if there are fewer."""
        if not 0 <= len <= self.getSize():
            return False
        self._end = self._at + len
        return True

    def setParentConnectionReader(self, parentConnectionReader: ConnectionReader | None) -> None:
        """Name the reader from which this message comes: its sender is that of this one."""
        self._parent = parentConnectionReader

    def getReference(self) -> Any:
        """Return the object itself if it never left this program (`DummyConnector`), else None."""
        return self._reference

    def getConnectionModifiers(self) -> Any:
        """Return what the carrier was given behind its name: nothing, receivers are not told."""
        from yarp._property import Property

        return Property()

    def _data(self) -> memoryview:
        return memoryview(self._message.to_bytes())[: self._end]

    def _read(self, kind: str) -> Any:
        data = self._data()
        size = struct.calcsize(kind)
        if self._at + size > len(data):
            self._error = True
            return 0
        value = struct.unpack_from(kind, data, self._at)[0]
        self._at += size
        return value

    def _block(self, size: int) -> bytes:
        data = self._data()
        if size < 0 or self._at + size > len(data):
            self._error = True
            return b""
        found = bytes(data[self._at : self._at + size])
        self._at += size
        return found

    def expectInt8(self) -> int:
        return int(self._read("<b"))

    def expectInt16(self) -> int:
        return int(self._read("<h"))

    def expectInt32(self) -> int:
        pushed, self._pushed = self._pushed, None
        return int(self._read("<i")) if pushed is None else pushed

    def expectInt64(self) -> int:
        return int(self._read("<q"))

    def expectFloat32(self) -> float:
        return float(self._read("<f"))

    def expectFloat64(self) -> float:
        return float(self._read("<d"))

    def expectString(self) -> str:
        """A length and the text."""
        return self._block(self.expectInt32()).decode("utf-8", "surrogateescape")

    def expectText(self, terminatingChar: str = "\n") -> str:
        """The text up to its end."""
        message = self._message
        data = bytes(message.payload if self.isTextMode() else message.to_bytes())[self._at :]
        line, found, _ = data.partition(terminatingChar.encode())
        self._at += len(line) + len(found)
        return line.decode("utf-8", "surrogateescape")

    expectInt = expectInt32
    expectDouble = expectFloat64

    def getWriter(self) -> ConnectionWriter | None:
        """Where an answer goes, if the sender wants one."""
        if self._writer is None and self._message.wants_reply:
            self._writer = ConnectionWriter()
        return self._writer

    def flushWriter(self) -> None:
        """Send the answer."""
        writer, self._writer = self._writer, None
        if writer is not None and not writer._empty and self._message.wants_reply:
            try:
                self._message.reply(writer._outgoing())
            except yarpy.YarpError:
                self._error = True

    def expectBlock(self, data: Any, len: int | None = None) -> bool:
        """Fill a bytearray, or its first `len` bytes."""
        into = memoryview(data).cast("B")
        count = into.nbytes if len is None else len
        found = self._block(count)
        into[:count] = found.ljust(count, b"\0")
        return not self._error

    def pushInt(self, x: int) -> bool:
        """Put a number back, which `expectInt32` returns next; False if one waits already."""
        if self._pushed is not None:
            return False
        self._pushed = int(x)
        return True

    def getSize(self) -> int:
        """The bytes that were not read yet."""
        return len(self._data()) - self._at

    def getRemoteContact(self) -> Any:
        """Return the address of the port that sent it."""
        from yarp._contact import Contact

        if self._parent is not None:
            return self._parent.getRemoteContact()
        return Contact(self._message.source)

    def getLocalContact(self) -> Any:
        """Return the address of the port that it came to: its name, not valid where that is not
        known."""
        from yarp._contact import Contact

        return Contact(self._receiver)

    def readEnvelope(self) -> str:
        return self._message.envelope

    def convertTextMode(self) -> bool:
        return True

    def isTextMode(self) -> bool:
        return self._message.spelling == "text"

    def isBareMode(self) -> bool:
        return False

    def isValid(self) -> bool:
        return not self._error

    def isActive(self) -> bool:
        return True

    def isError(self) -> bool:
        return self._error

    def requestDrop(self) -> None:
        """The sender ends the connection itself."""


class Ended(ConnectionReader):
    """The connection of a port that is interrupted or closed: no message, and not valid."""

    def __init__(self) -> None:
        super().__init__(yarpy.Message("D", b""))
        self._error = True

    def _fill(self, reader: Any) -> bool:
        return False

    def isActive(self) -> bool:
        return False
