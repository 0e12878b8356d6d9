"""memory: large payloads lie in memory that both programs see; everything else goes through a
Unix socket.

    greeting    YARPYME1 (the last is the version), the sender's specifier, eight bytes: where the
                sender can be met
    answer      a YARP number: the port's; 0: "I cannot see you", and the connection goes on as tcp;
                65536 and more: the version that is spoken here is another, and it goes on as tcp
    messages    as over tcp, but instead of a payload of 16 KiB or more a reference to it:
                NUL M E M | D or d, NUL | int16 memory | int32 slot, generation, length of the
                envelope | int64 offset, length of the payload | the envelope
    memory      0: the sender's; else the number of what it has received from others, and 256 more
                if that is shown to this reader for the first time

Rules: between two programs of yarpy of one user on one computer. Every message is acknowledged. One
copy of a payload is made for all readers of a port, none where it lies in shared memory already,
and none at a reader. What finds no room there goes through the socket, as answers do. Greeting and
answer keep their form in every version, so that an old and a new program meet over tcp.
"""

from __future__ import annotations

import struct
from typing import Final

from yarpy.carriers.base import Indexed
from yarpy.carriers.own.tcp import Tcp
from yarpy.data.codec import LISTS
from yarpy.errors import LocalProtocolError, RemoteProtocolError
from yarpy.facts import MAGIC_SIZE
from yarpy.log import logger
from yarpy.route import parse_carrier
from yarpy.wire import framing
from yarpy.wire.effects import Open, Switch
from yarpy.wire.message import Message, Packet
from yarpy.wire.shared_stream import SharedMemory, SharedPayload, SharedStream
from yarpy.wire.steps import Steps
from yarpy.wire.stream import LARGE, ByteStream

log = logger("yarpy.link")

NAME: Final = "memory"
_WORD: Final = b"YARPYME"
VERSION: Final = b"1"
_PORTS: Final = 65535  # the largest number of a port
_PLACE: Final = struct.Struct("<Q")
_REFERENCE: Final = struct.Struct("<4scxH3I2Q")
_MARK: Final = b"\0MEM"  # no other message begins with a NUL
_KEYS: Final = {b"D": "D", b"d": "d"}


class Memory(Indexed):
    """tcp's messages on a Unix socket, and references to shared memory."""

    name = NAME
    words = ()
    over = NAME
    magic = _WORD + VERSION
    acks = True
    _memory: SharedMemory | None = None  # what we send from
    # Taken, in a message that is not read yet: given back, it could not be taken once more.
    _payload: memoryview | None = None

    @classmethod
    def recognises(cls, first: bytes) -> int:
        return MAGIC_SIZE if first.startswith(_WORD) else 0

    # -- beginning --------------------------------------------------------------------------------

    def greet(self, stream: ByteStream) -> Steps[None]:
        handle = yield Open("memory", listen=False, group=self.route.source)
        try:
            where = _PLACE.pack(handle.port)
            stream.write(self.magic + framing.encode_name(self.route.specifier) + where)
            answer = yield from framing.read_answer(stream)
            seen = framing.parse_number(answer)
            if seen < 0:
                raise RemoteProtocolError(f"expected a number, got {answer!r}")
            if seen > _PORTS:
                why = _versions(bytes((min(seen - _PORTS - 1, 255),)))
                log.info("%s: %s", self.route, why)
                seen = 0
                yield from self._go_on_as_tcp(stream, why)
            elif not seen:
                yield from self._go_on_as_tcp(stream)
        except BaseException:
            handle.close()
            raise
        if not seen:
            handle.close()
            return
        yield Switch(handle, SharedStream(handle, stream.limit))
        self._memory = handle

    def _go_on_as_tcp(self, stream: ByteStream, why: str = "") -> Steps[None]:
        """The peer cannot see our memory: as good, unless just that was asked for."""
        if self.route.spec.chosen:
            self.route.spec = self.route.spec.over("tcp")
            return
        stream.write(framing.QUIT)
        yield from stream.read_exact(len(framing.ACK))
        raise LocalProtocolError(
            why
            or f'"{self.route.target}" shares no memory with this program: it is on another '
            "computer, in another container, or of another user; use tcp"
        )

    def welcome(self, stream: ByteStream, first: bytes) -> Steps[Tcp | None]:
        yield from super().welcome(stream, first)
        (where,) = _PLACE.unpack((yield from stream.read_exact(_PLACE.size)))
        if (version := first[len(_WORD) :]) != VERSION:
            log.info("%s: %s", self.route, _versions(version))
            stream.write(framing.number(_PORTS + 1 + VERSION[0]))
            return _FallbackTcp(self.route)
        handle = yield Open("memory", listen=True, port=where)
        if handle is None:
            stream.write(framing.number(0))
            return _FallbackTcp(self.route)
        stream.write(framing.number(self.route.port))
        yield Switch(handle, SharedStream(handle, stream.limit))
        return None

    # -- messages ---------------------------------------------------------------------------------

    def prepare(self, packet: Packet) -> bool:
        return self._placed(packet) is not None or super().prepare(packet)

    def encode(self, stream: ByteStream, packet: Packet) -> None:
        framed = packet.framed
        if framed is None and type(packet.value) in LISTS:  # most often small: two steps less
            framed = framing.encode(packet)
        if framed is not None and len(framed) == 1:
            stream.output += framed
            return
        memory, blocks = self._memory, packet.blocks
        payload = None
        if memory is not None and (len(blocks) > 1 or len(blocks[0]) >= LARGE):
            payload = self._placed(packet)
        where = -1 if payload is None or memory is None else memory.lend(payload)
        if payload is None or where < 0:
            stream.write(*framing.encode(packet))
            return
        envelope = packet.envelope
        numbers = (
            where,
            payload.slot,
            payload.generation,
            len(envelope),
            payload.offset,
            payload.size,
        )
        stream.write(_REFERENCE.pack(_MARK, packet.key.encode(), *numbers) + envelope)
        if isinstance(stream, SharedStream):
            stream.aside += payload.size

    def _placed(self, packet: Packet) -> SharedPayload | None:
        """A large payload in shared memory, put there once for all connections of the port."""
        memory, framed = self._memory, packet.framed
        if memory is None or (framed is not None and len(framed) == 1):
            return None
        forms = packet.forms
        payload: SharedPayload | None = forms.get(memory.key)
        if payload is None:
            blocks = packet.blocks
            size = sum(map(len, blocks))
            if size < LARGE or len(packet.envelope) > framing.MAX_COMMAND:
                return None
            payload = memory.place(blocks, size)
            if payload is not None:
                forms[memory.key] = payload
        return payload

    def parse(self, stream: ByteStream) -> Message | None:
        if stream.buffer[stream.head]:
            return framing.parse_plain(stream)
        waiting, start = stream.tail - stream.head, stream.head + _REFERENCE.size
        if waiting < _REFERENCE.size:
            return None
        mark, code, where, slot, generation, length, offset, size = _REFERENCE.unpack_from(
            stream.buffer, stream.head
        )
        key = _KEYS.get(code)
        if mark != _MARK or key is None or length > framing.MAX_COMMAND:
            raise RemoteProtocolError("a reference to shared memory that cannot be read")
        if size > stream.limit:
            raise RemoteProtocolError(
                f"a message of {size} bytes; the limit is {stream.limit} bytes"
            )
        end = _REFERENCE.size + length
        if waiting < end:
            return None
        if not isinstance(stream, SharedStream):
            raise RemoteProtocolError("a reference to memory that is not shared")
        envelope = ""
        if length:
            envelope = stream.buffer[start : start + length].decode("utf-8", "replace").strip()
        if self._payload is None:
            self._payload = stream.memory.take(where, slot, generation, offset, size)
        message = Message(key, self._payload, envelope)
        stream.head += end  # last, for readers that are interrupted
        stream.came_aside += size
        self._payload = None
        return message

    def decode(self, stream: ByteStream) -> Steps[Message]:
        if not stream.waiting:
            yield from stream.more(1)
        if stream.buffer[stream.head]:
            return (yield from framing.read_message(stream))
        while (message := self.parse(stream)) is None:
            yield from stream.more(stream.waiting + 1)
        return message


def _versions(other: bytes) -> str:
    return (
        f"the other program speaks version {other.decode('latin-1')} of the carrier memory, this "
        f"one {VERSION.decode()}: they are of different releases of yarpy; use tcp"
    )


class _FallbackTcp(Tcp):
    """tcp, for a peer that has said already who it is."""

    def welcome(self, stream: ByteStream, first: bytes) -> Steps[None]:
        added = self.route.spec.tokens
        self.route.spec = parse_carrier("+".join(("tcp", *added)))
        return
        yield
