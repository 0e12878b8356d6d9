"""FrameStream: bytes in the binary frames of a WebSocket (RFC 6455).

Rules: pure; wsproto reads the frames, `frame` writes them. What is written in one call goes out as
one frame; how the peer cut what comes does not matter. Pings are answered, a close is answered and
is the end. Text, and frames that break the rules, end the connection.
"""

from __future__ import annotations

from typing import Any, Final

from yarpy.errors import RemoteProtocolError
from yarpy.wire.stream import Buffer, ByteStream

CONTINUATION: Final = 0x0
TEXT: Final = 0x1
BINARY: Final = 0x2
CLOSE: Final = 0x8
PING: Final = 0x9
PONG: Final = 0xA

PROTOCOL_ERROR: Final = (1002).to_bytes(2, "big")
UNACCEPTABLE: Final = (1003).to_bytes(2, "big")
_NO_MASK: Final = bytes(4)  # a mask that changes nothing: there is no proxy to protect from us
_SHORT: Final = 1 << 12  # bytes of a payload that is copied behind its head


def head(kind: int, size: int, masks: bool) -> bytes:
    """Return what stands before a payload of `size` bytes; a client `masks` it, without effect.

    >>> head(BINARY, 5, False).hex(), head(BINARY, 300, True).hex()
    ('8205', '82fe012c00000000')
    """
    mask = 0x80 if masks else 0
    found = bytes((0x80 | kind,))
    if size < 126:
        found += bytes((mask | size,))
    elif size < 1 << 16:
        found += bytes((mask | 126,)) + size.to_bytes(2, "big")
    else:
        found += bytes((mask | 127,)) + size.to_bytes(8, "big")
    return found + _NO_MASK if masks else found


def frame(kind: int, masks: bool, *pieces: Buffer) -> tuple[Buffer, ...]:
    """Return a frame, in pieces; large ones are not copied."""
    size = sum(map(len, pieces))
    found = head(kind, size, masks)
    return (b"".join((found, *pieces)),) if size < _SHORT else (found, *pieces)


class FrameStream(ByteStream):
    """The content of the frames that come over another stream, from where that one was read to.

    `masks`: we are the client.
    """

    __slots__ = ("_broken", "_frames", "_inside", "_raw", "masks")

    def __init__(self, below: ByteStream, masks: bool) -> None:
        from wsproto.frame_protocol import FrameDecoder

        super().__init__(below.limit)
        self.masks = masks
        self._broken = ""  # which rule the peer has broken
        self._inside = False  # inside a message of several frames
        self._raw = memoryview(bytearray(len(self.buffer)))  # where frames arrive
        self._frames: Any = FrameDecoder(client=masks)
        self.feed(bytes(below.view[below.head : below.tail]))
        below.head = below.tail

    def write(self, *buffers: Buffer) -> None:
        super().write(*frame(BINARY, self.masks, *buffers))

    def get_buffer(self) -> memoryview:
        # What comes out of a frame is never longer than the frame, so there is room for it.
        return self._raw[: len(super().get_buffer())]

    def buffer_updated(self, count: int) -> None:
        from wsproto.frame_protocol import ParseFailed

        self._frames.receive_bytes(bytes(self._raw[:count]))
        try:
            while not self._eof and (found := self._frames.process_buffer()) is not None:
                self._take(found)
        except ParseFailed as error:
            self._refuse(f"a broken WebSocket frame: {error}")

    def _take(self, found: Any) -> None:
        kind, payload = int(found.opcode), found.payload
        if kind == CLOSE:
            self._control(CLOSE, bytes(payload[:2]))
            self.feed_eof()
        elif kind == PING:
            self._control(PONG, payload)
        elif kind == TEXT:
            self._refuse("a WebSocket frame with text, where there are only bytes", UNACCEPTABLE)
        elif kind != PONG:
            if (kind == CONTINUATION) != self._inside:
                self._refuse("WebSocket frames of two messages are mixed")
                return
            self._inside = not (found.frame_finished and found.message_finished)
            size = len(payload)
            super().get_buffer()[:size] = payload
            super().buffer_updated(size)

    def _refuse(self, why: str, code: bytes = PROTOCOL_ERROR) -> None:
        self._control(CLOSE, code)
        self._broken = why
        self.feed_eof()

    def _ended(self) -> None:
        if self._broken:
            raise RemoteProtocolError(self._broken)
        super()._ended()

    def _control(self, kind: int, payload: bytes) -> None:
        super().write(*frame(kind, self.masks, payload))
