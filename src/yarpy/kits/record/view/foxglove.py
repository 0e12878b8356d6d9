"""The WebSocket protocol of Foxglove, version 1: what a server says, and what it is told.

Rules: pure. All integers are little-endian. Texts are JSON objects with `op`; in binary messages
the first byte says what it is. Both names of the protocol mean the same; Foxglove knows the first
one, older programs the second. What a client says is read with DecodeError for all that is wrong.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from struct import Struct, error
from typing import Any, Final, Literal, TypeAlias

from yarpy.errors import DecodeError

PROTOCOLS: Final = ("foxglove.sdk.v1", "foxglove.websocket.v1")
PORT: Final = 8765

State: TypeAlias = Literal["playing", "paused", "buffering", "ended"]
_STATES: Final[tuple[State, ...]] = ("playing", "paused", "buffering", "ended")
_MESSAGE: Final = Struct("<BIQ")  # 1, subscription, time
_TIME: Final = Struct("<BQ")  # 2, time
_STATE: Final = Struct("<BBQfBI")  # 5, state, time, speed, whether it jumped, length of a name
_CONTROL: Final = Struct("<BBfBQI")  # 3, pause, speed, whether to jump, where to, length of a name
_SECOND: Final = 1_000_000_000


@dataclass(frozen=True)
class Channel:
    """A port as clients see it: `schema` describes messages in `encoding`."""

    id: int
    topic: str
    encoding: str
    schema_name: str
    schema: str
    schema_encoding: str


@dataclass(frozen=True)
class Control:
    """A client's wish about the time: to stand still or not, how fast to go, where from (`seek`,
    in nanoseconds; None: from where it is). `request` names the wish."""

    paused: bool
    speed: float
    seek: int | None
    request: str


def server_info(
    name: str, session: str, begin: int | None = None, end: int | None = None
) -> dict[str, Any]:
    """Return the first thing that a server says. With a range of time, in nanoseconds, that can be
    played."""
    found: dict[str, Any] = {
        "op": "serverInfo",
        "name": name,
        "capabilities": ["time"],
        "supportedEncodings": [],
        "metadata": {},
        "sessionId": session,
    }
    if begin is not None and end is not None:
        found["capabilities"].append("playbackControl")
        found["dataStartTime"], found["dataEndTime"] = _moment(begin), _moment(end)
    return found


def _moment(time: int) -> dict[str, int]:
    return {"sec": time // _SECOND, "nsec": time % _SECOND}


def advertise(channels: Sequence[Channel]) -> dict[str, Any]:
    """Return what tells a client of channels."""
    return {
        "op": "advertise",
        "channels": [
            {
                "id": one.id,
                "topic": one.topic,
                "encoding": one.encoding,
                "schemaName": one.schema_name,
                "schema": one.schema,
                "schemaEncoding": one.schema_encoding,
            }
            for one in channels
        ],
    }


def status(message: str, level: Literal[0, 1, 2] = 1) -> dict[str, Any]:
    """Return a line for people: 0 is information, 1 a warning, 2 an error."""
    return {"op": "status", "level": level, "message": message}


def message_data(subscription: int, time: int, payload: bytes) -> bytes:
    """Return a message of a channel that is subscribed to."""
    return _MESSAGE.pack(1, subscription, time) + payload


def time_data(time: int) -> bytes:
    """Return which moment it is, in nanoseconds."""
    return _TIME.pack(2, time)


def playback_state(state: State, time: int, speed: float, jumped: bool, request: str = "") -> bytes:
    """Return how far it is; `request` names the wish that this answers."""
    name = request.encode()
    return _STATE.pack(5, _STATES.index(state), time, speed, jumped, len(name)) + name


def control_of(data: bytes) -> Control | None:
    """Return what a binary message of a client wants; None if that is something else. Raises
    DecodeError."""
    if data[:1] != b"\x03":
        return None
    try:
        _, pause, speed, jumps, seek, length = _CONTROL.unpack_from(data)
    except error:
        raise DecodeError("a wish for another time that is cut off") from None
    name = data[_CONTROL.size : _CONTROL.size + length]
    if len(name) != length or pause > 1 or not 0 < speed < float("inf"):
        raise DecodeError("a wish for another time that makes no sense")
    return Control(bool(pause), speed, seek if jumps else None, name.decode("utf-8", "replace"))


def order_of(text: str) -> tuple[str, Mapping[str, Any]]:
    """Return the `op` of a text of a client, and all of it. Raises DecodeError."""
    try:
        found = json.loads(text)
    except (ValueError, RecursionError):
        raise DecodeError("a text that is no JSON") from None
    if not isinstance(found, dict) or not isinstance(found.get("op"), str):
        raise DecodeError("a text without an `op`")
    return found["op"], found


def subscriptions_of(order: Mapping[str, Any]) -> list[tuple[int, int]]:
    """Return the numbers of subscriptions and of their channels. Raises DecodeError."""
    wanted = order.get("subscriptions")
    found = []
    for one in wanted if isinstance(wanted, list) else [None]:
        if not isinstance(one, dict):
            raise DecodeError("subscriptions without a list of them")
        number, channel = numbers_of({"ids": [one.get("id"), one.get("channelId")]}, "ids")
        found.append((number, channel))
    return found


def numbers_of(order: Mapping[str, Any], key: str) -> list[int]:
    """Return a list of numbers. Raises DecodeError."""
    found = order.get(key)
    if not isinstance(found, list) or not all(map(_is_id, found)):
        raise DecodeError(f"no numbers: {key}")
    return found


def _is_id(value: object) -> bool:
    return type(value) is int and 0 <= value < 1 << 32
