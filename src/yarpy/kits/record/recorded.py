"""Recorded, a message that was kept, and PortFacts: what a recording says of a port.

Rules: times are in nanoseconds since 1970, as the clocks of the sender and of the recorder gave
them; payloads are views of what was read, and are decoded when they are asked for.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from yarpy.data.stamp import Stamp
from yarpy.kits.record.envelope import SECOND
from yarpy.wire.message import DATA, Message


class Recorded:
    """A message of a recording.

    `port` sent it; `received_ns` is when it came to the recorder, `sent_ns` what its envelope says
    (the receipt, where it has none). `message` is what a port would have read.
    """

    __slots__ = ("envelope", "parts", "port", "received_ns", "sent_ns")

    def __init__(
        self,
        port: str,
        received_ns: int,
        sent_ns: int,
        envelope: str,
        payload: bytes | memoryview | tuple[memoryview, ...],
    ) -> None:
        self.port = port
        self.received_ns = received_ns
        self.sent_ns = sent_ns
        self.envelope = envelope
        #: its bytes, which may lie in several places of a file
        self.parts: tuple[bytes | memoryview, ...]
        self.parts = payload if isinstance(payload, tuple) else (payload,)

    @property
    def payload(self) -> bytes | memoryview:
        """Return its bytes in one piece."""
        if len(self.parts) > 1:
            self.parts = (b"".join(self.parts),)
        return self.parts[0]

    @property
    def size(self) -> int:
        """Return how many bytes these are."""
        return sum(map(len, self.parts))

    @property
    def message(self) -> Message:
        """Return the message, with its source and envelope."""
        found = Message(DATA, self.payload, self.envelope)
        found.source = self.port
        return found

    @property
    def value(self) -> Any:
        """Return the natural Python object. Raises DecodeError if it is not what it claims to
        be."""
        return self.message.value

    def as_(self, type_: Any) -> Any:
        """Return it as an object of that type, as `yarpy.Message.as_` does."""
        return self.message.as_(type_)

    @property
    def stamp(self) -> Stamp | None:
        """Return the envelope read as a Stamp, None if it is none."""
        return self.message.stamp

    @property
    def received(self) -> float:
        """Return when it came to the recorder, in seconds since 1970."""
        return self.received_ns / SECOND

    @property
    def sent(self) -> float:
        """Return when it was sent, in seconds by the sender's clock."""
        return self.sent_ns / SECOND

    def __repr__(self) -> str:
        return f"<Recorded {self.received:.6f} {self.message!r}>"


@dataclass
class PortFacts:
    """A port of a recording: the types of its messages (`yarp/image`), and how many there are.

    `playable`: it is in YARP's own bytes.
    """

    name: str
    kinds: list[str] = field(default_factory=list)
    messages: int = 0
    playable: bool = True
