"""A client of the protocol of Foxglove, written from its description, for tests."""

from __future__ import annotations

import json
import socket
import struct
from types import TracebackType
from typing import Any, Self
from urllib.parse import urlsplit

from support.wait import HANG
from wsproto import ConnectionType, WSConnection
from wsproto.events import AcceptConnection, BytesMessage, RejectConnection, Request, TextMessage

STATES = ("playing", "paused", "buffering", "ended")


class Client:
    """Connects to `url`; `heard` is what came: objects, and (kind, ...) of binary messages."""

    def __init__(
        self, url: str, protocol: str = "foxglove.sdk.v1", headers: dict[str, str] | None = None
    ) -> None:
        parts = urlsplit(url)
        self.line = socket.create_connection((parts.hostname, parts.port or 80), HANG)
        self.talk = WSConnection(ConnectionType.CLIENT)
        extra = [(key.encode(), value.encode()) for key, value in (headers or {}).items()]
        target = f"/?{parts.query}" if parts.query else "/"
        asked = Request(
            host=parts.netloc, target=target, subprotocols=[protocol], extra_headers=extra
        )
        self.line.sendall(self.talk.send(asked))
        self.protocol: str | None = None
        self.refused = 0
        self.waiting: list[Any] = []
        self.part = b""
        self.channels: dict[str, dict[str, Any]] = {}
        while self.protocol is None and not self.refused:
            self._read()

    def _read(self) -> None:
        data = self.line.recv(1 << 16)
        if not data:
            raise EOFError
        self.talk.receive_data(data)
        for event in self.talk.events():
            if isinstance(event, AcceptConnection):
                self.protocol = event.subprotocol or ""
            elif isinstance(event, RejectConnection):
                self.refused = event.status_code
            elif isinstance(event, TextMessage):
                self._take(json.loads(event.data))
            elif isinstance(event, BytesMessage):
                self.part += event.data
                if event.message_finished:
                    self._take(parsed(self.part))
                    self.part = b""

    def _take(self, found: Any) -> None:
        if isinstance(found, dict) and found["op"] == "advertise":
            self.channels.update({one["topic"]: one for one in found["channels"]})
        self.waiting.append(found)

    def next(self) -> Any:
        """What comes next."""
        while not self.waiting:
            self._read()
        return self.waiting.pop(0)

    def until(self, *kinds: str) -> Any:
        """The next object with one of these `op`s, or binary message of one of these kinds."""
        while True:
            found = self.next()
            if (found["op"] if isinstance(found, dict) else found[0]) in kinds:
                return found

    def order(self, op: str, **what: Any) -> None:
        self.line.sendall(self.talk.send(TextMessage(json.dumps({"op": op, **what}))))

    def subscribe(self, topic: str, number: int) -> None:
        while topic not in self.channels:
            self.until("advertise")
        one = {"id": number, "channelId": self.channels[topic]["id"]}
        self.order("subscribe", subscriptions=[one])

    def control(
        self, paused: bool, speed: float = 1.0, seek: int | None = None, name: str = ""
    ) -> None:
        data = struct.pack("<BBfBQI", 3, paused, speed, seek is not None, seek or 0, len(name))
        self.line.sendall(self.talk.send(BytesMessage(data + name.encode())))

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.line.close()


def parsed(data: bytes) -> tuple[Any, ...]:
    """A binary message of a server: its kind and its fields."""
    if data[0] == 1:
        _, number, time = struct.unpack_from("<BIQ", data)
        return ("message", number, time, data[13:])
    if data[0] == 2:
        return ("time", struct.unpack("<BQ", data)[1])
    _, state, time, speed, jumped, size = struct.unpack_from("<BBQfBI", data)
    assert data[0] == 5 and len(data) == 19 + size
    return ("state", STATES[state], time, speed, bool(jumped), data[19:].decode())
