"""ByteStream: the buffer between a transport and a protocol, with no I/O of its own.

Rules: the driver side is `get_buffer / buffer_updated / feed_eof / take_output`, the protocol side
`read_* / write`; the read methods are generators that yield None when they need more bytes. Small
reads are copied out of one fixed buffer; a large read lands in a buffer of its own, which the
message then keeps, so an image is received without a copy. That buffer grows with what arrives, not
with what was announced (unless the peer has sent as much in one message before), and is reused once
nothing holds it.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterable
from typing import Final, TypeAlias, TypeVar

from yarpy.errors import LinkClosed, RemoteProtocolError
from yarpy.wire.steps import Steps

Buffer: TypeAlias = bytes | bytearray | memoryview
T = TypeVar("T")

BUFFER_SIZE: Final = 1 << 16
LARGE: Final = 1 << 14  # reads from here on get a buffer of their own
FIRST_GRANT: Final = 1 << 16  # memory taken on a new peer's word; for more, it must send first
KEPT: Final = 1 << 21  # bytes of a longer buffer that may stay behind a message
DEFAULT_LIMIT: Final = 1 << 30  # bytes per message, whatever the peer announces
CUT_OFF: Final = "the peer closed the connection in the middle of a message"


def _parts_hold() -> bool:
    """Return whether a view of a part alone keeps its bytearray from being resized, as in CPython.

    PyPy checks the whole view only, or nothing: there no buffer is reused.
    """
    buffer = bytearray(2)
    whole = memoryview(buffer)
    part = whole[:1]
    whole.release()
    free = _is_free(buffer)
    part.release()
    return not free


def _is_free(buffer: bytearray) -> bool:
    """Return whether no view of it is left: a bytearray refuses to be resized while a view of it
    lives.

    One byte less and one more moves no memory. Reference counts alone would tell less: a view holds
    one reference however many hold the view.
    """
    try:
        buffer.append(buffer.pop())
    except BufferError:
        return False
    return True


def _first_free(buffers: list[bytearray], size: int, references: int) -> bytearray | None:
    """A buffer of that size that nobody has but the list.

    An array that numpy makes of a view (`numpy.ndarray(shape, dtype, view)`) keeps the bytearray
    and no view of it, so references count, too: at most so many.
    """
    for buffer in buffers:
        if len(buffer) == size and sys.getrefcount(buffer) <= references and _is_free(buffer):
            return buffer
    return None


def _unused() -> int:
    """The references that `_first_free` sees of a buffer that only the list has: each version of
    Python, and the compiled core, count those of the function itself differently. 0: no buffer is
    reused."""
    if not _parts_hold() or not hasattr(sys, "getrefcount"):
        return 0
    return next(count for count in range(1, 100) if _first_free([bytearray(1)], 1, count))


_UNUSED: Final = _unused()


class ByteStream:
    """Bytes in, bytes out. `limit` is the largest message, in bytes, that is accepted.

    `buffer`, `head` and `tail` are open to protocols that parse in place: `buffer[head:tail]` has
    arrived and was not read; move `head` past what was used. `output` waits to be taken: what is
    appended to it was written.

    `view` is all of `buffer`, and `big` where a large read lands, if one is under way: for a driver
    that spells out `get_buffer` and `buffer_updated`.
    """

    __slots__ = (
        "_big_filled",
        "_eof",
        "_large",
        "_proven",
        "_spare",
        "big",
        "buffer",
        "head",
        "limit",
        "mark",
        "output",
        "paused",
        "tail",
        "view",
    )

    def __init__(self, limit: int = DEFAULT_LIMIT, size: int = BUFFER_SIZE) -> None:
        self.buffer = bytearray(size)
        self.view = memoryview(self.buffer)
        self.head = 0
        self.tail = 0
        self.limit = limit
        self.paused = False
        self.mark = -1  # where the message begins that is being read; -1: it cannot be read again
        #: Its large parts: where each began, how much of it the buffer had, its size, its memory.
        self._large: list[tuple[int, int, int, bytearray]] = []
        self._eof = False
        self.output: list[Buffer] = []
        self.big: memoryview | None = None  # where a large read lands
        self._big_filled = 0
        self._spare: list[bytearray] = []
        self._proven = 0  # bytes that the peer has sent in one message

    # -- the driver's side ------------------------------------------------------------------------

    def get_buffer(self) -> memoryview:
        """Return the memory for the next bytes; never empty."""
        if self.big is not None:
            return self.big[self._big_filled :]
        if self.head == self.tail and self.mark < 0:
            self.head = self.tail = 0
            return self.view
        if self.tail == len(self.buffer):
            self._compact(self.tail - self.head + 1)
        return self.view[self.tail :]

    def buffer_updated(self, count: int) -> None:
        """`count` bytes were put into what `get_buffer` returned."""
        if self.big is not None:
            self._big_filled += count
        else:
            self.tail += count

    def feed(self, data: Buffer) -> None:
        """Copy `data` in (tests, and bytes that were read before the stream existed)."""
        rest = memoryview(data).cast("B")
        while rest:
            room = self.get_buffer()
            if not room:
                raise BufferError("the stream is full; let its reader run between feeds")
            part = rest[: len(room)]
            room[: len(part)] = part
            self.buffer_updated(len(part))
            rest = rest[len(part) :]

    def feed_eof(self) -> None:
        """The peer sends no more."""
        self._eof = True

    def begin(self) -> None:
        """A message begins here, which may have to be read again."""
        if len(self.buffer) > KEPT:
            self._shrink()
        self._large = []
        self.mark = self.head

    def finish(self) -> None:
        """The message is read. (Without calls: a signal cannot come in its middle.)"""
        self.mark = -1
        self._large = []

    def rewind(self) -> bool:
        """Put back what was read since `begin`; return False if it is not there any more."""
        if self.mark < 0:
            return False
        data = bytearray()
        start = self.mark
        for where, had, size, memory in self._large:
            data += self.buffer[start:where]
            data += memory[: self._big_filled if memory is self._large[-1][3] else size]
            start = where + had
        data += self.buffer[start : self.tail]
        size = len(data)
        data += bytes(BUFFER_SIZE)
        view = memoryview(data)
        # From here to the end Python looks for no signals.
        self.buffer, self.view, self.big = data, view, None
        self.head, self.tail, self.mark = 0, size, 0
        self._large = []
        return True

    def take_output(self) -> list[Buffer]:
        """Return what the protocol wrote since the last call, in order."""
        output, self.output = self.output, []
        return output

    def forget(self) -> None:
        """Give back the memory that is kept for the next large message. Any thread may call."""
        self._spare = []
        self._proven = 0

    def put_back(self, rest: Iterable[Buffer]) -> None:
        """Put back what was taken and could not be sent: it is taken first next time."""
        self.output[:0] = rest

    def snapshot_output(self) -> None:
        """Copy what waits to be taken, so that its writer may change it."""
        self.output = [piece if type(piece) is bytes else bytes(piece) for piece in self.output]

    @property
    def pending(self) -> bool:
        """Return whether there is output to take."""
        return bool(self.output)

    def written(self, start: int = 0) -> tuple[int, int]:
        """The bytes of what waits to be taken from the piece number `start` on, and the number of
        the next piece."""
        output = self.output
        return sum(map(len, output[start:])), len(output)

    @property
    def waiting(self) -> int:
        """Bytes that arrived and were not read yet."""
        return self.tail - self.head

    # -- the protocol's side ----------------------------------------------------------------------

    def write(self, *buffers: Buffer) -> None:
        """Queue bytes for the peer. Large buffers are sent from where they are, not copied."""
        self.output.extend(buffers)

    def more(self, count: int) -> Steps[None]:
        """Wait until `count` bytes (at most the buffer's size) lie between head and tail."""
        while self.tail - self.head < count:
            if self._eof:
                self._ended()
            if self.head + count > len(self.buffer):
                self._compact(count)
            yield None

    def read_exact(self, count: int) -> Steps[bytes | memoryview]:
        """Exactly `count` bytes; large ones as a view of a buffer of their own."""
        if count > LARGE:
            return (yield from self.read_large(count))
        if self.tail - self.head < count:
            yield from self.more(count)
        start = self.head
        self.head = start + count
        return bytes(self.view[start : self.head])

    def unread(self, count: int) -> None:
        """Put back the last `count` bytes of a short read that has just ended."""
        self.head -= count

    def read_line(self, limit: int = 1 << 20) -> Steps[bytes]:
        """One line by the text rules of YARP, without its end.

        CR, LF and NUL are never part of a line; a backslash before the end joins the next line.
        """
        line = bytearray()
        slashes = 0  # backslashes at the end of what has come
        while True:
            if self.head == self.tail:
                yield from self.more(1)
            stop = self.buffer.find(0x0A, self.head, self.tail)
            part = self.buffer[self.head : stop if stop >= 0 else self.tail]
            self.head = self.tail if stop < 0 else stop + 1
            part = part.translate(None, b"\r\n\0")
            line += part
            if len(line) > limit:
                raise RemoteProtocolError(f"a line of more than {limit} bytes")
            last = len(part) - len(part.rstrip(b"\\"))
            slashes = slashes + last if last == len(part) else last
            if stop >= 0:
                if slashes % 2 == 0:
                    return bytes(line)
                del line[-1]
                slashes -= 1

    def read_parsed(self, parse: Callable[[memoryview], tuple[T, int] | int]) -> Steps[T]:
        """Return what `parse` makes of the bytes that have arrived.

        `parse` gets a view of them and returns `(value, bytes used)`, or how many bytes it needs.
        """
        while True:
            with self.view[self.head : self.tail] as view:
                result = parse(view)
            if not isinstance(result, int):
                value, used = result
                self.head += used
                if len(self.buffer) > KEPT:
                    self._shrink()
                return value
            if result > self.limit:
                raise RemoteProtocolError(
                    f"a message of {result} bytes; the limit is {self.limit} bytes"
                )
            read = self.head - self.mark if self.mark >= 0 else 0  # of this message, and kept
            if self.tail - self.head + read == len(self.buffer):
                self._enlarge(result)
            yield from self.more(min(result, len(self.buffer) - read))

    def pause(self) -> None:
        """Mark what was read up to here as done with, though no message came of it; the next has
        not begun."""
        self.paused = True

    def skip(self, count: int) -> Steps[None]:
        """Read and forget `count` bytes, holding none of them."""
        while count > 0:
            if self.head == self.tail:
                yield from self.more(1)
            step = min(count, self.tail - self.head)
            self.head += step
            count -= step

    # -- inside -----------------------------------------------------------------------------------

    def _ended(self) -> None:
        if self.tail > self.head or self.big is not None:
            raise LinkClosed(CUT_OFF)
        raise LinkClosed("the peer closed the connection")

    def _compact(self, need: int) -> None:
        """Make room behind `head` for so many bytes; what was read of the message is kept if that
        leaves room enough."""
        read = self.head - self.mark if self.mark >= 0 else 0
        if read + need > len(self.buffer):
            self.mark, read = -1, 0
        start = self.head - read
        count = self.tail - start
        large = [(at - start, had, size, memory) for at, had, size, memory in self._large]
        self.view[:count] = self.view[start : self.tail]
        self.head, self.tail = read, count
        if self.mark >= 0:
            self.mark, self._large = 0, large

    def _enlarge(self, size: int) -> None:
        """The buffer is full and `size` bytes are announced: make it longer, up to twice as long.

        Never more at once: the peer must have sent as much as we allocate for it. Never less than
        half as much: who does not know the end of a message announces a few bytes at a time, and
        all that is there is copied.
        """
        read = self.head - self.mark if self.mark >= 0 and not self._large else 0
        held = len(self.buffer)
        fresh = bytearray(max(min(size, 2 * held), held + held // 2) + read)
        start = self.head - read
        count = self.tail - start
        fresh[:count] = self.view[start : self.tail]
        self.buffer, self.view, self.mark = fresh, memoryview(fresh), 0 if read else -1
        self.head, self.tail = read, count

    def _shrink(self) -> None:
        """A very large message is over: go on with a buffer of the usual size, if the rest fits."""
        count = self.tail - self.head
        if count < BUFFER_SIZE:
            fresh = bytearray(BUFFER_SIZE)
            fresh[:count] = self.view[self.head : self.tail]
            self.buffer, self.view, self.mark = fresh, memoryview(fresh), -1
            self.head, self.tail = 0, count

    def read_large(self, count: int) -> Steps[memoryview]:
        """Exactly `count` bytes as a view of a buffer of their own."""
        if count > self.limit:
            raise RemoteProtocolError(
                f"a message of {count} bytes is announced; the limit is {self.limit} bytes"
            )
        where, target = self.head, self._spare_buffer(count)
        view = memoryview(target)
        filled = had = min(self.tail - self.head, len(target))
        view[:filled] = self.view[self.head : self.head + filled]
        if self.mark >= 0:
            self._large += ((where, had, count, target),)
        self._big_filled = filled
        self.head += filled
        while filled < count:
            if filled == len(target):
                view.release()
                self.big = None
                more = bytes(min(len(target), count - filled))
                if _is_free(target):
                    target.extend(more)
                else:  # whoever keeps the traceback of an interrupted reader holds on to it
                    target = target + more
                    if self.mark >= 0:
                        self._large[-1:] = [(where, had, count, target)]
                view = memoryview(target)
            self.big, self._big_filled = view, filled
            if self._eof:
                self._ended()
            yield None
            filled = self._big_filled
        self.big = None
        self._proven = max(self._proven, count)
        return view

    def _spare_buffer(self, size: int) -> bytearray:
        """A buffer for `size` bytes: a used one whose message is gone, else a new one."""
        found = _first_free(self._spare, size, _UNUSED)
        if found is not None:
            return found
        fresh = bytearray(min(size, max(FIRST_GRANT, self._proven, self.tail - self.head)))
        if _UNUSED:
            self._spare = [*self._spare[-2:], fresh]
        return fresh


class ObjectStream(ByteStream):
    """A stream whose items are whole Python objects: the in-process carrier passes references."""

    __slots__ = ("items",)

    def __init__(self) -> None:
        super().__init__(size=1)
        self.items: list[object] = []  # that have come

    def feed_object(self, item: object) -> None:
        """An object has come."""
        self.items.append(item)

    def read_object(self) -> Steps[object]:
        """The next object."""
        while not self.items:
            if self._eof:
                self._ended()
            yield None
        return self.items.pop(0)

    def write_object(self, item: object) -> None:
        """Queue an object for the peer."""
        self.output.append(item)  # type: ignore[arg-type]


class DatagramStream(ByteStream):
    """A stream that keeps the borders of datagrams: each feed is one, each write is one."""

    __slots__ = ("_ready",)

    def __init__(self, limit: int = DEFAULT_LIMIT) -> None:
        super().__init__(limit)
        self._ready: list[bytes] = []

    def get_buffer(self) -> memoryview:
        return self.view

    def buffer_updated(self, count: int) -> None:
        self._ready += (bytes(self.view[:count]),)  # in one step: a signal comes before or after

    def rewind(self) -> bool:
        """Go on with the next datagram: one more that is lost is nothing new."""
        return True

    def feed(self, data: Buffer) -> None:
        self._ready.append(bytes(data))

    @property
    def waiting(self) -> int:
        return sum(map(len, self._ready))

    def read_datagram(self) -> Steps[bytes]:
        """The next datagram, whole."""
        while not self._ready:
            if self._eof:
                self._ended()
            yield None
        return self._ready.pop(0)


def run(steps: Steps[T], stream: ByteStream, feeds: Iterable[Buffer] = ()) -> T:
    """Drive `steps` to its end with `feeds` as the peer's bytes, then end of stream. For tests."""
    source = iter(feeds)
    rest = memoryview(b"")
    try:
        effect = next(steps)
        while True:
            if effect is not None:
                raise RemoteProtocolError(f"{effect} needs a driver")
            data = rest if rest else next(source, None)
            if data is None:
                stream.feed_eof()
            else:
                rest = memoryview(data).cast("B")
                room = len(stream.get_buffer())
                stream.feed(rest[:room])
                rest = rest[room:]
            effect = steps.send(None)
    except StopIteration as stop:
        value: T = stop.value
        return value
