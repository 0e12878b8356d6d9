"""Wire and WireLink: a service that answers what a port is asked, or asks another through a port.

    class Service(yarp.Wire):
        def read(self, reader): ...           # answers, with reader.getWriter()

    service.yarp().attachAsServer(port)
    service.yarp().attachAsClient(port)       # then service.yarp().write(question, answer)

Rules: it is the base of what the compiler of C++ makes of Thrift files; yarpidl_thrift makes
classes of Python, which need none of it.
"""

from __future__ import annotations

import threading
from collections import deque
from typing import Any

from yarp._bottle import Bottle
from yarp._connection import ConnectionReader
from yarp._memory import encoded
from yarp._portable import PortReader, PortWriter, message_of
from yarp._things import DummyConnector


class WireLink:
    """Where a service is: nowhere, at a port that asks it, or at one that it asks."""

    def __init__(self) -> None:
        self._owner: PortReader | None = None
        self._waiting: deque[tuple[PortReader, bytes]] = deque()
        self._lock = threading.Lock()
        self._working = False
        self._reset()

    def _reset(self, port: Any = None, reader: Any = None) -> None:
        self._port, self._reader = port, reader
        self._replies = True
        self._reads = False

    def isValid(self) -> bool:
        """Return whether it is attached to something."""
        return self._port is not None or self._reader is not None

    def setOwner(self, owner: PortReader) -> bool:
        """Say who answers as a server."""
        self._owner = owner
        return True

    def attachAsClient(self, port: Any) -> bool:
        """Write through a port, or to a reader of this program."""
        if hasattr(port, "getOutputCount"):
            self._reset(port=port)
        else:
            self._reset(reader=port)
        return True

    def attachAsServer(self, port: Any) -> bool:
        """Let the owner answer what a port is asked; False without an owner."""
        if self._owner is None:
            return False
        self._reset(port=port)
        self._reads = True
        port.setReader(self._owner)
        return True

    def setStreamingMode(self, streaming: bool) -> bool:
        """Write without waiting for answers."""
        self._replies = not streaming
        return True

    def write(self, writer: PortWriter, reader: PortReader | None = None) -> bool:
        """Write, or ask and read the answer; False if there is none, as in streaming mode."""
        if self._reader is not None:
            there = DummyConnector()
            writer.write(there.getWriter())
            done = self._reader.read(there.getReader())
            if reader is not None:
                reader.read(there.getReader())
            return bool(done)
        if self._port is None:
            return False
        if reader is None:
            return bool(self._port.write(writer))
        if not self._replies:
            self._port.write(writer)
            return False
        return bool(self._port.write(writer, reader))

    def callback(self, writer: PortWriter, reader: PortReader, tag: str = "") -> bool:
        """Give `reader` a message soon, from a thread; `tag` goes in front of it."""
        if tag:
            there = Bottle()
            there.addString(tag)
            content = Bottle()
            content._take(message_of(writer))
            there.append(content)
            data = encoded(there._outgoing())
        else:
            data = encoded(writer._outgoing())
        with self._lock:
            self._waiting.append((reader, data))
            if not self._working:
                self._working = True
                threading.Thread(target=self._deliver, name="yarp callback", daemon=True).start()
        return True

    def _deliver(self) -> None:
        """Hand over what waits, one after the other, until there is nothing more."""
        while True:
            with self._lock:
                if not self._waiting:
                    self._working = False
                    return
                reader, data = self._waiting.popleft()
            try:
                reader.read(ConnectionReader.createConnectionReader(data))
            except Exception:
                import traceback

                traceback.print_exc()

    def canWrite(self) -> bool:
        """Return whether it is a client."""
        return self.isValid() and not self._reads

    def canRead(self) -> bool:
        """Return whether it is a server."""
        return self.isValid() and self._reads


class Wire(PortReader):
    """A service: a subclass defines `read`."""

    _link: WireLink | None = None

    def yarp(self) -> WireLink:
        """Return where it is. The service is the owner of that."""
        if self._link is None:
            self._link = WireLink()
            self._link.setOwner(self)
        return self._link
