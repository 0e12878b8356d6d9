"""A ring of bytes in shared memory, as the carrier `shmem` of C++ YARP has two of.

    0 moved to a larger one | 1 closed | 2 | int32 size, size of the larger one, head, tail,
    bytes in it, somebody waits | the bytes

Rules: the writer makes the ring, under a number that both sides know; the reader finds it.
Everything in it is read and changed under the mutex ACCESS. WAITDATA is held while the reader
waits, and the writer releases it. What the other side wrote there is believed only as far as the
memory goes. `peer` raises OSError once the other side is gone.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Final

from yarpy.errors import RemoteProtocolError
from yarpy.transports.shared.sysv import ELSEWHERE, Mutex, Segment
from yarpy.wire.stream import Buffer

HEADER: Final = 28
FIRST_SIZE: Final = 4096
MOST: Final = (1 << 31) - 1 - HEADER  # the numbers in it are int32
MAX_MOVES: Final = (1 << 15) - 1  # their count is the upper half of a key

_MOVED, _CLOSED = 0, 1  # bytes
_SAID: Final = 0xFFFF  # both, in the first of the numbers
_SIZE, _NEXT, _HEAD, _TAIL, _FILLED, _WAITING = range(1, 7)  # numbers

_PAUSE: Final = 20e-6  # seconds between tries to get a mutex
_LOOK_EVERY: Final = 0.05  # seconds after which a holder may be dead
_HELD: Final = 5.0  # seconds that the other side may have a mutex: copying takes milliseconds


def name_of(kind: str, number: int) -> str:
    """Return the path of C++'s mutex of that kind for a ring."""
    return os.path.join(os.environ.get("TMPDIR") or "/tmp", f"SHMEM_{kind}_MUTEX_{number}")


class _Ended(Segment):
    """The segment of a ring that is closed: empty, and marked as ended."""

    def __init__(self) -> None:
        self.size = HEADER
        self.bytes = memoryview(bytearray(HEADER))
        self.bytes[_CLOSED] = 1
        self.numbers = self.bytes.cast("i")

    def forget(self) -> None:
        """Do nothing: it has no name."""


_ENDED: Final = _Ended()


class Ring:
    """One direction of a connection. Raises OSError where it cannot be had."""

    def __init__(self, number: int, create: bool, peer: Callable[[], None]) -> None:
        self._number = number
        self._moves = 0
        self._peer = peer
        self._named = True  # in the file system, and among the segments
        self._left: list[Segment] = []  # by the writer, who has moved; the reader may be there
        if create:
            self._segment = Segment.create(number, FIRST_SIZE + HEADER, HEADER)
            self._segment.numbers[_SIZE] = FIRST_SIZE
        else:
            self._segment = Segment.attach(number, HEADER)
        try:
            self._access = Mutex(name_of("ACCESS", number), create)
            try:
                self._data = Mutex(name_of("WAITDATA", number), create)
            except BaseException:
                if create:
                    self._access.forget()
                raise
        except BaseException:
            if create:
                self._segment.forget()
            raise
        if not create:
            self._data.hold()  # C++ waits for data by taking it once more

    @property
    def found(self) -> bool:
        """Return whether the reader has come, and has done all that takes names."""
        return self._segment.attached > 1 and self._data.held

    def forget(self) -> None:
        """Take its names away, once both sides have found it."""
        if self._named:
            self._named = False
            self._segment.forget()
            self._access.forget()
            self._data.forget()

    @property
    def closed(self) -> bool:
        """Return whether one of the sides has closed it."""
        return bool(self._segment.bytes[_CLOSED])

    @property
    def filled(self) -> int:
        """The number of bytes in it that nobody has read, about."""
        return self._segment.numbers[_FILLED]

    # -- the reader -------------------------------------------------------------------------------

    def read_into(self, view: memoryview) -> int:
        """Take bytes out; -1 if there are none, 0 if there will be none. Raises OSError,
        RemoteProtocolError."""
        segment = self._segment
        if not (segment.numbers[_FILLED] or segment.numbers[0] & _SAID):
            return -1  # without the mutex: a look, as often as it likes
        self._acquire()
        try:
            if not self._follow():
                return 0
            segment = self._segment
            size, _, tail, filled = self._numbers(segment)
            count = min(filled, len(view))
            if not count:
                return 0 if segment.bytes[_CLOSED] else -1
            first = min(count, size - tail)
            start = HEADER + tail
            view[:first] = segment.bytes[start : start + first]
            if count > first:
                view[first:count] = segment.bytes[HEADER : HEADER + count - first]
            segment.numbers[_FILLED] = filled - count
            segment.numbers[_TAIL] = (tail + count) % size
            return count
        finally:
            self._access.release()

    def wait(self, seconds: float) -> None:
        """Sleep until there may be something to read, or `wake`, or the time is over."""
        self._acquire()
        try:
            numbers = self._segment.numbers
            if numbers[_FILLED] or numbers[0] & _SAID:
                return
            self._data.hold()
            numbers[_WAITING] = 1  # C++ adds one for each wait, also for those in vain
        finally:
            self._access.release()
        self._data.wait(seconds)

    def wake(self) -> None:
        """Wake a thread of ours that waits."""
        self._data.wake()

    def _follow(self) -> bool:
        """Go where the writer has moved; False if nothing is there any more."""
        while self._segment.bytes[_MOVED]:
            closed = self.closed
            if self._moves == MAX_MOVES:
                raise RemoteProtocolError("the peer moves its shared memory without end")
            self._moves += 1
            try:
                self._segment = Segment.attach((self._moves << 16) + self._number, HEADER)
            except FileNotFoundError:
                if closed:
                    return False
                raise
            self._segment.forget()
        return True

    # -- the writer -------------------------------------------------------------------------------

    def write(self, buffers: Sequence[Buffer], count: int) -> None:
        """Put `count` bytes in, making it larger if need be. Raises OSError."""
        self._acquire()
        try:
            segment = self._segment
            if segment.bytes[_CLOSED]:
                raise BrokenPipeError("the peer has closed the shared memory")
            size, head, _, filled = self._numbers(segment)
            if size - filled < count:
                segment = self._move(size + 2 * count)
                size, head, _, filled = self._numbers(segment)
            at = head
            for buffer in buffers:
                rest = memoryview(buffer).cast("B")
                while rest:
                    piece = rest[: size - at]
                    segment.bytes[HEADER + at : HEADER + at + len(piece)] = piece
                    at = (at + len(piece)) % size
                    rest = rest[len(piece) :]
            segment.numbers[_FILLED] = filled + count
            segment.numbers[_HEAD] = at
            if segment.numbers[_WAITING] > 0:
                segment.numbers[_WAITING] = 0
                self._data.release()
        finally:
            self._access.release()
        if self._left and self._segment.attached > 1:
            self._forget_moves()

    def _move(self, size: int) -> Segment:
        """Go on in a larger piece of memory, with what nobody has read yet."""
        old, size = self._segment, min(size, MOST)
        was, _, tail, filled = self._numbers(old)
        if self._moves == MAX_MOVES or size < filled:
            raise OSError(f"no message of that size goes through shmem; {ELSEWHERE}")
        key = ((self._moves + 1) << 16) + self._number
        new = Segment.create(key, size + HEADER, HEADER)
        first = min(filled, was - tail)
        new.bytes[HEADER : HEADER + first] = old.bytes[HEADER + tail : HEADER + tail + first]
        new.bytes[HEADER + first : HEADER + filled] = old.bytes[HEADER : HEADER + filled - first]
        new.numbers[_SIZE], new.numbers[_HEAD], new.numbers[_FILLED] = size, filled, filled
        new.numbers[_WAITING] = old.numbers[_WAITING]
        old.numbers[_NEXT] = size
        old.bytes[_MOVED] = 1
        self._moves += 1
        self._left.append(old)
        self._segment = new
        return new

    def _forget_moves(self) -> None:
        """The reader has followed, or will not."""
        for segment in (*self._left, self._segment):
            segment.forget()
        self._left.clear()

    # -- both -------------------------------------------------------------------------------------

    def close(self) -> None:
        """Tell the other side that this is the end, and leave nothing behind."""
        with suppress(OSError, RemoteProtocolError):
            self._follow()  # to where a writer that has died had moved: nobody else knows
        try:
            self._acquire()
        except OSError:
            pass  # it ended while it had the mutex: nobody listens
        else:
            with suppress(OSError):
                for segment in (*self._left, self._segment):
                    segment.bytes[_CLOSED] = 1
                self._segment.numbers[_WAITING] = 0
                self._data.release()
                self._access.release()
        self._forget_moves()
        self.forget()
        self._segment = _ENDED

    def _numbers(self, segment: Segment) -> tuple[int, int, int, int]:
        """Size, head, tail and how much is in it. Raises RemoteProtocolError for what cannot be."""
        _, size, _, head, tail, filled, _ = segment.numbers
        room = min(size, segment.size - HEADER)
        if not (room == size > head >= 0 <= tail < size >= filled >= 0):
            raise RemoteProtocolError("the numbers in the shared memory cannot be right")
        return size, head, tail, filled

    def _acquire(self) -> None:
        """Take ACCESS. Raises OSError if the other side keeps it, or died with it."""
        if self._access.try_acquire():
            return
        look = time.monotonic() + _LOOK_EVERY
        end = look + _HELD
        while not self._access.try_acquire():
            now = time.monotonic()
            if now > look:
                self._peer()
                look = now + _LOOK_EVERY
            if now > end:
                raise ConnectionAbortedError("the peer does not give the shared memory back")
            time.sleep(_PAUSE)
