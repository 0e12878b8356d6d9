"""Monitors without a connection: what they make of a value, and of bytes that come."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from hypothesis import strategies as st

from yarpy.monitors.base import Place
from yarpy.route import parse_carrier
from yarpy.wire.message import DATA, Message, Packet
from yarpy.wire.stream import DEFAULT_LIMIT

Kind = Callable[[Place], Any]


def place(tokens: str = "", sending: bool = False, limit: int = DEFAULT_LIMIT) -> Place:
    """A place with the parameters `tokens`, such as "size.half+order.rggb"."""
    own = parse_carrier(f"x+{tokens}").tokens if tokens else ()
    return Place("/out", "/in", f"tcp+{tokens}", sending, own, own, limit=limit)


def updated(monitor: Any, message: Message) -> Message:
    """What goes on instead of a message."""
    made = monitor.update(message)
    return made if isinstance(made, Message) else message.replaced(made)


def sent(kind: Kind, value: object, tokens: str = "") -> bytes:
    """The bytes that travel when a monitor rides at the sender's end."""
    packet = Packet(value, b"7 0.5")
    return bytes(updated(kind(place(tokens, sending=True)), Message.of(packet)).to_bytes())


def received(kind: Kind, data: bytes, tokens: str = "", limit: int = DEFAULT_LIMIT) -> Message:
    """The message that the reader gets when a monitor rides at the receiver's end."""
    message = Message(DATA, data, "7 0.5")
    message.source = "/out"
    return updated(kind(place(tokens, limit=limit)), message)


def through(kind: Kind, value: object, tokens: str = "") -> Message:
    """The message that the reader gets when a monitor rides at both ends."""
    return received(kind, sent(kind, value, tokens), tokens)


def damaged(data: st.DataObject, wire: bytes) -> bytes:
    """The bytes with some of them replaced."""
    made = bytearray(wire)
    for _ in range(data.draw(st.integers(1, 3))):
        made[data.draw(st.integers(0, len(made) - 1))] = data.draw(st.integers(0, 255))
    return bytes(made)
