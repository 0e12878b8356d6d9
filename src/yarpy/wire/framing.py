"""The framing that the binary carriers share: YARP numbers, the message index, port commands.

Rules: pure. `encode` makes the buffers of one message, `read_message` reads one. The index of C++
holds block lengths that its own reader only sums; ours trusts the sum, except where it cannot be
right (hand-made clients write anything): then the payload itself is walked to find its end.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import Any, Final

from yarpy.data.codec import LISTS, any_list, decode_leading
from yarpy.data.codec import encode as encode_value
from yarpy.data.walker import Walk, Walker
from yarpy.data.writer import list_blocks
from yarpy.errors import AccessRefused, LinkClosed, RemoteProtocolError
from yarpy.log import readable
from yarpy.wire.message import Message, Packet, mark_unsent
from yarpy.wire.steps import Steps
from yarpy.wire.stream import CUT_OFF, LARGE, Buffer, ByteStream

BASE: Final = 7777  # added to a carrier's code in its first eight bytes
MAX_NAME: Final = 1000
REFUSED: Final = "Access refused"  # what every refusal of access begins with
MAX_COMMAND: Final = 1 << 15  # half the buffer of a stream

_NUMBER: Final = struct.Struct("<2si2s")
_INT: Final = struct.Struct("<i")
_TWO: Final = struct.Struct("<2i")
_THREE: Final = struct.Struct("<3i")


def number(value: int) -> bytes:
    """A YARP number: `YA`, a little-endian int32, `RP`.

    >>> number(10).hex(" ")
    '59 41 0a 00 00 00 52 50'
    """
    return _NUMBER.pack(b"YA", value, b"RP")


def parse_number(data: Buffer) -> int:
    """The value of a YARP number, or -1 if the eight bytes are not one."""
    start, value, end = _NUMBER.unpack(data)
    return value if start == b"YA" and end == b"RP" and value >= 0 else -1


INDEX: Final = number(10)
ACK: Final = number(0)
_FILLER: Final = b"\xff" * 8
_PLAIN: Final = INDEX + b"\x02\x01" + _FILLER  # two blocks, as nearly every message has
_PLAIN_SIZE: Final = len(_PLAIN) + 12  # + two lengths + the reply's length
_HEAD_SIZE: Final = len(_PLAIN)
# What follows it: two lengths, the reply's, and of the port command the `~` and the key.
_FOLLOWS: Final = struct.Struct("<2i8x2B")
# The whole index of a message with so many blocks: their lengths, and the reply's.
_LENGTHS: Final = [struct.Struct(f"<8s2B8s{count + 1}i") for count in range(8)]

# Port commands: eight bytes, with the key inside (`D`) or in a text that follows (envelopes, quit).
_KEYS: Final = {key: b"\0\0\0\0~" + key.encode() + b"\0\1" for key in "Dda"}
_HEADS: Final = {
    key: (_PLAIN + _INT.pack(8), b"\0\0\0\0" + command) for key, command in _KEYS.items()
}
_START: Final = struct.Struct(f"<{len(_PLAIN) + 4}si12s")  # with the payload's length in between
_TEXT: Final = b"~\0\0\1"  # behind the length of a port command that is a text
QUIT: Final = INDEX + b"\x01\x01" + _FILLER + _TWO.pack(10, 0) + b"\2\0\0\0~\0\0\1q\0"


def encode_command(key: str, envelope: bytes = b"", text: bytes = b"") -> bytes:
    """The port command that begins a message: eight bytes, then text with a NUL if there is any."""
    if envelope:
        text = b" " + envelope
    if not text and key in _KEYS:
        return _KEYS[key]
    body = key.encode() + text + b"\0"
    return _INT.pack(len(body)) + _TEXT + body


def encode(packet: Packet) -> list[Buffer]:
    """One message: index, port command, payload. Small ones are one buffer, pixels stay in
    place."""
    framed = packet.framed
    if framed is None:
        blocks = packet._blocks
        if blocks is None:  # spelled out: each step of it would be a call for every message
            value: Any = packet.value
            try:
                if type(value) in LISTS:
                    blocks = packet._blocks = list_blocks(value, any_list)
                else:
                    blocks = packet._blocks = encode_value(value)
            except Exception as error:
                mark_unsent(error)
                raise
        if len(blocks) == 1:
            # The common case, kept short: two blocks, the second is the payload.
            payload = blocks[0]
            if packet.envelope:
                command = encode_command(packet.key, packet.envelope)
                start = _PLAIN + _THREE.pack(len(command), len(payload), 0) + command
            else:
                head, command = _HEADS[packet.key]
                start = _START.pack(head, len(payload), command)
            framed = [start + payload] if len(payload) < LARGE else [start, payload]
        else:
            framed = _encode_blocks(encode_command(packet.key, packet.envelope), blocks)
        packet.framed = framed
    return framed


def encode_text_command(key: str, text: bytes = b"") -> list[Buffer]:
    """A message that is a port command alone (`q`, `/destination` ...)."""
    return _encode_blocks(encode_command(key, text=text), ())


def _encode_blocks(command: bytes, blocks: tuple[Buffer, ...]) -> list[Buffer]:
    if len(blocks) > 200:  # the count is one byte; readers ignore the borders of blocks
        blocks = (b"".join(blocks),)
    sizes = [len(command), *map(len, blocks)]
    count = len(sizes)
    lengths = _LENGTHS[count] if count < len(_LENGTHS) else struct.Struct(f"<8s2B8s{count + 1}i")
    index = bytearray(lengths.pack(INDEX, count, 1, _FILLER, *sizes, 0))
    index += command
    out: list[Buffer] = []
    for block in blocks:
        if len(block) < LARGE:
            index += block
        else:
            out += [bytes(index), block] if index else [block]
            index = bytearray()
    if index:
        out.append(bytes(index))
    return out


def read_message(stream: ByteStream) -> Steps[Message]:
    """Read one message. Eight bytes that are no index are skipped, as in C++, until one comes."""
    while True:
        if stream.tail - stream.head < _HEAD_SIZE:
            yield from stream.more(8)
            if not stream.buffer.startswith(INDEX, stream.head):
                stream.head += 8
                stream.pause()
                continue
            yield from stream.more(_HEAD_SIZE)
        if stream.buffer.startswith(_PLAIN, stream.head):
            message = parse_plain(stream)
            if message is not None:
                return message
        elif not stream.buffer.startswith(INDEX, stream.head):
            stream.head += 8
            continue
        try:
            found = yield from _read_any(stream)
        except LinkClosed:
            raise LinkClosed(CUT_OFF) from None
        if found is not None:
            return found
        stream.pause()


def parse_plain(stream: ByteStream) -> Message | None:
    """A whole message at the head of the stream's buffer, or None: look closer.

    The hot path: nothing is waited for, no generator runs, the payload is copied out once. `head`
    moves in the last step, so that a reader that a signal interrupts finds all or nothing done.
    """
    head = stream.head
    buffer = stream.buffer
    start = head + _PLAIN_SIZE
    if stream.tail < start + 8:
        return None
    command, size, mark, code = _FOLLOWS.unpack_from(buffer, head + _HEAD_SIZE)
    end = start + command + size
    if not 8 <= size < LARGE or stream.tail < end:
        return None
    if command != 8:
        return _parse_stamped(stream, start, start + command, end)
    key = _CHARACTERS.get(code)
    if key is None or mark != 0x7E:
        return None
    message = Message(key, stream.view[start + 8 : end].tobytes())
    stream.head = end
    return message


def _parse_stamped(stream: ByteStream, start: int, body: int, end: int) -> Message | None:
    """The same for a message with an envelope: its port command is a text, which ends at `body`."""
    buffer = stream.buffer
    text = start + 8
    if (
        not text < body <= start + MAX_COMMAND
        or not buffer.startswith(_TEXT, start + 4)
        or not buffer.startswith(_PLAIN, stream.head)
        or buffer.find(0, text, body) != body - 1
    ):
        return None
    message = parse_command(_said(buffer[text : body - 1]))
    if message.key not in ("D", "d"):
        return None
    message.payload = bytes(buffer[body:end])
    stream.head = end
    return message


_CHARACTERS: Final = {ord(key): key for key in "Dda"}
_DECODED: Final = ("D", "d", "a")


def _read_any(stream: ByteStream) -> Steps[Message | None]:
    """The general form of a message; None for a port command that is broken (C++ skips it)."""
    large = _parse_large(stream)
    if large is not None:
        message, rest = large
        message.payload = yield from stream.read_exact(rest)
        return message
    head = yield from stream.read_exact(_HEAD_SIZE)
    blocks, replies = head[8], head[9]
    lengths = yield from stream.read_exact(4 * (blocks + replies))
    sizes = struct.unpack(f"<{blocks}i", lengths[: 4 * blocks])
    if any(size < 0 for size in sizes):
        raise RemoteProtocolError("a message index with a negative block length")
    total = sum(sizes)
    if total > stream.limit:
        raise RemoteProtocolError(
            f"a message of {total} bytes is announced; the limit is {stream.limit} bytes"
        )
    command = yield from read_command(stream)
    if command is None:
        yield from stream.skip(total - 8)
        return None
    message, used = command
    rest = total - used
    if message.key not in _DECODED:
        yield from stream.skip(rest)
    elif rest >= 8:
        message.payload = yield from stream.read_exact(rest)
    else:
        # No payload is that short: the index is wrong, the payload itself must show where it ends.
        message.payload = yield from read_payload(stream)
    return message


def _parse_large(stream: ByteStream) -> tuple[Message, int] | None:
    """Parse the start of a large message without envelope; return it and how much follows, or None:
    look closer.

    As with `parse_plain`, no generator runs: what a large message costs beside its bytes.
    """
    head, buffer = stream.head, stream.buffer
    blocks = buffer[head + 8]
    if not 1 < blocks < len(_LENGTHS) or buffer[head + 9] != 1:
        return None
    start = head + _HEAD_SIZE + 4 * blocks + 4
    if stream.tail < start + 8:
        return None
    _, _, _, _, command, *sizes, _ = _LENGTHS[blocks].unpack_from(buffer, head)
    rest = sum(sizes)
    if command != 8 or min(sizes) < 0 or not LARGE < rest <= stream.limit - 8:
        return None
    key = _CHARACTERS.get(buffer[start + 5])
    if key is None or buffer[start + 4] != 0x7E:
        return None
    stream.head = start + 8
    return Message(key), rest


def read_command(stream: ByteStream) -> Steps[tuple[Message, int] | None]:
    """A port command and how many bytes it took; None if it is not one."""
    head = yield from stream.read_exact(8)
    if head[4] != 0x7E:
        return None
    if head[5]:
        return Message(chr(head[5])), 8
    text = yield from _read_text(stream)
    return parse_command(_said(text)), 9 + len(text)


def _said(text: Buffer) -> str:
    """The text of a port command without ends of lines."""
    return bytes(text).translate(None, b"\r\n").decode("utf-8", "replace")


def _read_text(stream: ByteStream) -> Steps[bytes]:
    """The text of a port command, up to its NUL. What its header says of its length is ignored."""
    seen = 0
    while True:
        stop = stream.buffer.find(0, stream.head + seen, stream.tail)
        if stop >= 0:
            text = bytes(stream.buffer[stream.head : stop])
            stream.head = stop + 1
            return text
        seen = stream.tail - stream.head
        if seen >= MAX_COMMAND:
            raise RemoteProtocolError(f"a port command of more than {MAX_COMMAND} bytes")
        yield from stream.more(seen + 1)


def parse_command(text: str) -> Message:
    """A port command spelled as text: its first character is the key, the rest belongs to it.

    For data the text from the third character on is the envelope.
    """
    key = text[:1]
    if key in ("d", "D"):
        return Message(key, envelope=text[2:].strip())
    return Message(key, text=text[1:])


def read_payload(
    stream: ByteStream, end: Callable[[int], Walk] | None = None
) -> Steps[bytes | memoryview]:
    """A payload that comes without a length, as replies come: walk it to its end. `end`: what finds
    that, within so many bytes, where it is no Bottle."""
    limit = stream.limit
    walker = Walker(limit) if end is None else end(limit)

    def extent(view: memoryview) -> tuple[bytes, int] | int:
        need = walker.advance(view)
        if need > limit:
            raise RemoteProtocolError(f"a payload of {need} bytes; the limit is {limit} bytes")
        return (bytes(view[:need]), need) if walker.done else need

    return (yield from stream.read_parsed(extent))


def parse_reply(stream: ByteStream) -> Message | None:
    """A whole reply at the head of the stream's buffer, if it is a usual one; None: look closer.

    As with `parse_plain`, nothing is waited for. Replies have no length: decoding finds it.
    """
    head, tail = stream.head, stream.tail
    if tail - head > LARGE:
        return None
    data = stream.view[head:tail].tobytes()
    found = decode_leading(data)
    if found is None or found[1] > stream.limit:
        return None
    value, size = found
    stream.head = head + size
    message = Message("d", data[:size])
    message._value = value
    return message


def read_name(stream: ByteStream) -> Steps[str]:
    """The sender's specifier: int32 length with its NUL, clamped to 1..1000 as C++ does."""
    (length,) = _INT.unpack((yield from stream.read_exact(4)))
    text = bytes((yield from stream.read_exact(max(1, min(length, MAX_NAME)))))
    return text.partition(b"\0")[0].decode("utf-8", "replace")


def encode_name(name: str) -> bytes:
    """The sender's specifier as `read_name` reads it."""
    text = name.encode("utf-8", "replace") + b"\0"
    return _INT.pack(len(text)) + text


# -- refusals -------------------------------------------------------------------------------------


def encode_refusal(why: str) -> bytes:
    """The line that answers a greeting where its sender may not do what it came for."""
    return f"* {why}".encode("utf-8", "replace")[:MAX_NAME] + b"\r\n"


def refused(line: bytes) -> AccessRefused | None:
    """The error that such a line means; None for any other."""
    text = line.decode("utf-8", "replace").removeprefix("* ")
    return AccessRefused(readable(text)) if text.startswith(REFUSED) else None


def read_answer(stream: ByteStream) -> Steps[bytes]:
    """The eight bytes that answer a greeting. Raises AccessRefused or RemoteProtocolError if they
    begin a line that says why not."""
    answer = bytes((yield from stream.read_exact(8)))
    if answer.startswith(b"* "):
        line = answer
        if not line.endswith(b"\n"):
            try:
                line += bytes((yield from stream.read_line(MAX_NAME + 8)))
            except LinkClosed:
                return answer
        said = readable(line[2:].decode("utf-8", "replace").strip())
        raise refused(line) or RemoteProtocolError(f'the peer answers "{said[:300]}"')
    return answer
