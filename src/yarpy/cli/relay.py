"""Messages that are sent on as they came, whatever they are, without reading them."""

from __future__ import annotations

from typing import Any

import yarpy


class Whole:
    """The payload of a message, byte for byte."""

    __slots__ = ("_payload",)

    def __init__(self, payload: Any) -> None:
        self._payload = payload

    def to_wire(self) -> tuple[Any, ...]:
        return (self._payload,)


def forwardable(message: yarpy.Message) -> object:
    """Return the object to write in order to send `message` on. Raises DecodeError."""
    if message.spelling == "binary":
        return Whole(message.payload)
    if message.spelling == "text":
        return message.value
    return message.payload
