"""ZMTP 3, what ZeroMQ speaks over TCP: greeting, frames, commands.

    ff 00 00 00 00 00 00 00 01 7f | 03 01 | "NULL" and zeros up to 64 bytes       both sides
    04 SIZE | 05 "READY" | NAME-SIZE name VALUE-SIZE value ...                    both sides
    flags SIZE | body                                                             messages

Rules: pure. A frame's flags are 1 (more frames of this message follow), 2 (its size has eight bytes
instead of one) and 4 (a command). Lengths are checked before memory is taken. The security
mechanism is NULL, PLAIN (`plain`) or CURVE (`curve`). Source: ZeroMQ RFC 23 (3.0) and 37 (3.1).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final, NoReturn

from yarpy.errors import RemoteProtocolError
from yarpy.limit import ZMQ_COMMAND, ZMQ_FRAMES
from yarpy.log import readable
from yarpy.wire import framing
from yarpy.wire.steps import Steps
from yarpy.wire.stream import LARGE, Buffer, ByteStream

MAGIC: Final = b"\xff" + bytes(7)
NULL: Final = b"NULL"

MORE: Final = 1
LONG: Final = 2
COMMAND: Final = 4

MAX_REASON: Final = 255

#: flags and body
Frame = tuple[int, Buffer]


# -- the greeting ---------------------------------------------------------------------------------


def greeting(mechanism: bytes = NULL, server: bool = False) -> bytes:
    """Return what a side begins with, as a server of the security mechanism or as its client."""
    start = MAGIC + b"\x01\x7f\x03\x01" + mechanism.ljust(20, b"\0")
    return start + bytes((server,)) + bytes(31)


GREETING: Final = greeting()
OPENING: Final = GREETING[:11]  # with which the side that was dialled begins: libzmq waits for it


def read_greeting(stream: ByteStream, wanted: bytes = NULL, dialled: bool = False) -> Steps[int]:
    """Read what the peer begins with; the minor number of its version 3. Raises RemoteProtocolError
    for another security mechanism than the one that is `wanted`, with what to do about it on this
    side if it was `dialled` from here."""
    minor, mechanism = yield from read_any_greeting(stream)
    if mechanism != wanted:
        refuse(mechanism, dialled)
    return minor


def read_any_greeting(stream: ByteStream) -> Steps[tuple[int, bytes]]:
    """Read what the peer begins with; the minor number of its version 3, and its mechanism."""
    start = bytes((yield from stream.read_exact(11)))
    if start[0] != 0xFF or start[9] != 0x7F:
        raise RemoteProtocolError("the peer does not speak ZMTP, the protocol of ZeroMQ")
    if start[10] < 3:
        raise RemoteProtocolError(
            "the peer speaks a version of ZMTP before 3: it needs ZeroMQ 4 or newer"
        )
    rest = bytes((yield from stream.read_exact(len(GREETING) - len(start))))
    return (rest[0] if start[10] == 3 else 1), rest[1:21].rstrip(b"\0")


def refuse(mechanism: bytes, dialled: bool = False) -> NoReturn:
    """Raise RemoteProtocolError for a security mechanism that does not fit."""
    name = readable(mechanism.decode("latin-1"))
    if dialled and mechanism == b"PLAIN":
        raise RemoteProtocolError(
            "the peer asks for a name and a password: say +user.NAME+password.WORD"
        )
    if dialled and mechanism == b"CURVE":
        raise RemoteProtocolError(
            "the peer is known by its public key: say +curve.KEY, with 64 hexadecimal digits"
        )
    if mechanism == NULL:
        raise RemoteProtocolError(
            "the peer asks for no name and no key: leave +user, +password and +curve out"
        )
    raise RemoteProtocolError(
        f"the peer wants the security mechanism {name}, which is not spoken here: leave that "
        "option out on its socket"
    )


# -- frames ---------------------------------------------------------------------------------------


def frame(body: bytes, flags: int = 0) -> bytes:
    """A frame with a small body.

    >>> frame(b"ab", MORE).hex(" ")
    '01 02 61 62'
    """
    return head(len(body), flags) + body


def head(size: int, flags: int = 0) -> bytes:
    """Return the header of a frame with a body of `size` bytes."""
    if size < 256:
        return bytes((flags, size))
    return bytes((flags | LONG,)) + size.to_bytes(8, "big")


def encode(frames: Sequence[Buffer]) -> list[Buffer]:
    """A message of these frames, in pieces; large bodies are not copied."""
    found: list[Buffer] = []
    small = bytearray()
    last = len(frames) - 1
    for place, body in enumerate(frames):
        small += head(len(body), MORE if place < last else 0)
        if len(body) < LARGE:
            small += body
        else:
            found += [bytes(small), body]
            small.clear()
    if small:
        found.append(bytes(small))
    return found


def read_frame(stream: ByteStream, limit: int) -> Steps[Frame]:
    """One frame of at most `limit` bytes, or a command."""
    flags, size = bytes((yield from stream.read_exact(2)))
    check_flags(flags)
    if flags & LONG:
        rest = bytes((yield from stream.read_exact(7)))
        size = int.from_bytes(bytes((size,)) + rest, "big")
    check_size(flags, size, limit)
    return flags, (yield from stream.read_exact(size))


def parse_frame(stream: ByteStream, limit: int) -> Frame | None:
    """As `read_frame`, for a frame that is already complete in the stream's buffer, or None."""
    buffer, at, come = stream.buffer, stream.head, stream.waiting
    if come < 2:
        return None
    flags, size, start = buffer[at], buffer[at + 1], at + 2
    check_flags(flags)
    if flags & LONG:
        if come < 9:
            return None
        start = at + 9
        size = int.from_bytes(buffer[at + 1 : start], "big")
    check_size(flags, size, limit)
    if stream.tail - start < size:
        return None
    stream.head = start + size
    return flags, bytes(buffer[start : stream.head])


def parse_body(stream: ByteStream) -> bytes | None:
    """The only frame of a message, as `parse_message`; None for all others."""
    start = stream.head + 2
    if start > stream.tail or stream.buffer[start - 2]:
        return None
    end = start + stream.buffer[start - 1]
    if end > stream.tail:
        return None
    stream.head = end
    return bytes(stream.buffer[start:end])


def parse_message(stream: ByteStream) -> list[Buffer] | None:
    """The frames of a message of which everything has come already, all of them short; or None,
    and nothing was read."""
    buffer, tail = stream.buffer, stream.tail
    at = stream.head
    frames: list[Buffer] = []
    while tail - at >= 2 and len(frames) < ZMQ_FRAMES:
        flags = buffer[at]
        if flags > MORE:
            return None  # a long frame, or a command
        start = at + 2
        at = start + buffer[at + 1]
        if at > tail:
            return None
        frames.append(bytes(buffer[start:at]))
        if not flags:
            stream.head = at
            return frames
    return None


def check_flags(flags: int) -> None:
    """Raise RemoteProtocolError for flags that no frame has."""
    if flags > (COMMAND | LONG | MORE) or (flags & COMMAND and flags & MORE):
        raise RemoteProtocolError(f"a frame of ZeroMQ with the flags {flags:#04x}")


def check_size(flags: int, size: int, limit: int) -> None:
    """Raise RemoteProtocolError for a frame that is too large."""
    most = ZMQ_COMMAND if flags & COMMAND else limit
    if size > most:
        raise RemoteProtocolError(f"a frame of {size} bytes is announced; the limit is {most}")


# -- commands -------------------------------------------------------------------------------------


def command(name: bytes, body: bytes = b"") -> bytes:
    """A command as a frame.

    >>> command(b"PONG", b"x").hex(" ")
    '04 06 04 50 4f 4e 47 78'
    """
    return frame(bytes((len(name),)) + name + body, COMMAND)


def parse_command(body: Buffer) -> tuple[bytes, bytes]:
    """Name and content of a command."""
    data = bytes(body)
    size = data[0] if data else 0
    if not 0 < size < len(data):
        raise RemoteProtocolError("a command of ZeroMQ without a name")
    return data[1 : 1 + size], data[1 + size :]


def ready(properties: Mapping[str, bytes]) -> bytes:
    """The command that ends the greeting.

    >>> ready({"Socket-Type": b"PUB"})[:8].hex(" ")
    '04 1c 05 52 45 41 44 59'
    """
    return command(b"READY", properties_of(properties))


def properties_of(properties: Mapping[str, bytes]) -> bytes:
    """Return properties as they are said in a command."""
    body = bytearray()
    for name, value in properties.items():
        body += bytes((len(name),)) + name.encode() + len(value).to_bytes(4, "big") + value
    return bytes(body)


def error(reason: str) -> bytes:
    """The command that refuses a peer."""
    text = reason.encode("utf-8", "replace")[:MAX_REASON]
    return command(b"ERROR", bytes((len(text),)) + text)


def read_ready(stream: ByteStream) -> Steps[dict[str, bytes]]:
    """Read the command with which the peer ends its greeting; return its properties, under names in
    small letters. Raises RemoteProtocolError, or AccessRefused, with the reason of a peer that
    refuses us."""
    flags, body = yield from read_frame(stream, ZMQ_COMMAND)
    if not flags & COMMAND:
        raise RemoteProtocolError("a ZeroMQ peer begins with a message instead of READY")
    name, content = parse_command(body)
    if name == b"ERROR":
        reason = content[1 : 1 + content[0]] if content else b""
        text = readable(reason.decode("utf-8", "replace"))
        raise framing.refused(reason) or RemoteProtocolError(f'the peer refuses: "{text}"')
    if name != b"READY":
        raise RemoteProtocolError(f"a ZeroMQ peer begins with the command {name[:20]!r}")
    return parse_properties(content)


def parse_properties(data: bytes) -> dict[str, bytes]:
    """The properties of a READY."""
    found: dict[str, bytes] = {}
    at = 0
    while at < len(data):
        start = at + 1 + data[at]
        size = int.from_bytes(data[start : start + 4], "big")
        end = start + 4 + size
        if start + 4 > len(data) or end > len(data):
            raise RemoteProtocolError("a READY of ZeroMQ whose properties are cut off")
        found[data[at + 1 : start].decode("latin-1").lower()] = data[start + 4 : end]
        at = end
    return found


def echo(ping: bytes) -> bytes:
    """Return what a PONG says to the content of a PING: its context, without its time to live."""
    return ping[2:18]
