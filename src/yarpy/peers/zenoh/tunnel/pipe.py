"""A pipe of bytes through Zenoh: what a TCP connection is where there is no way for one.

    kind (1 byte)   what follows
    DATA            number of the message (uint32 LE), bytes
    END             number of the message: nothing will come any more
    WAKE            nothing: a reader looks again what has changed; it is for one's own
    CREDIT          bytes that the reader has taken, of all (uint64 LE), and messages (uint32 LE)
    CLOSED          nothing: the other end has said END
    RESET           nothing: something was lost, or is not wanted: the pipe is broken

The first three come to the reader, who waits in Zenoh itself, so that a message wakes one thread
and not two; the others to the exchange, in a thread of Zenoh.

Rules: Zenoh keeps the order and loses nothing as long as all the links on the way stand and the
priority is the same. What comes too early waits for what is missing, for `REORDER_TIMEOUT` seconds:
then it was lost with a link, and the pipe is broken; the ports make a new connection, and count. A
sender has at most `WINDOW` bytes and `MESSAGES` messages on their way, so that a slow reader holds
up its own sender alone, and nobody has to keep more. Errors are OSError, as everywhere in this
room.
"""

from __future__ import annotations

import struct
import threading
import time
from collections.abc import Sequence
from typing import Final, Protocol

from yarpy.peers.zenoh.spare import Spare
from yarpy.peers.zenoh.tunnel.alarm import CLOCK
from yarpy.transports.base import Address, Answerable
from yarpy.wire.stream import Buffer

DATA, END, WAKE, CREDIT, CLOSED, RESET = range(6)
WINDOW: Final = 1 << 23  # bytes on their way to a reader
MESSAGES: Final = 1024
FRAGMENT: Final = 1 << 21  # bytes of one message of Zenoh
CREDIT_INTERVAL: Final = 0.1  # seconds until a reader says what it has taken, if not a quarter
RESET_RESEND: Final = 5.0  # seconds after which the other end is told once more of the end
REORDER_TIMEOUT: Final = 2.0  # seconds in which messages may overtake each other

_HEAD: Final = struct.Struct("<BI")
_SIZE: Final = _HEAD.size
_pack, _unpack = _HEAD.pack, _HEAD.unpack_from
_COUNT = struct.Struct("<BQI")
_ALL: Final = 1 << 32
_NOTHING: Final = memoryview(b"")

# DSCP numbers below which a priority of Zenoh is the right one: YARP's LOW, NORM (0), HIGH, CRIT.
_PRIORITIES: Final = ((8, "DATA"), (16, "DATA_LOW"), (24, "DATA_HIGH"), (32, "INTERACTIVE_LOW"))


class Line(Protocol):
    """The operations of Zenoh that a pipe uses. `put`, `tell` and the like raise whatever Zenoh
    raises."""

    def put(self, data: bytes | bytearray) -> object:
        """Send a copy to the other end's reader."""

    def tell(self, data: bytes) -> object:
        """Send to the other end's exchange."""

    def wake(self) -> object:
        """Send WAKE to our own reader. Called in any thread."""

    def recv(self) -> bytes:
        """Wait for the next data and return it."""

    def try_recv(self) -> bytes | None:
        """Return the next data, None if there is none yet."""

    def prefer(self, priority: str) -> object:
        """Send with that priority of Zenoh from now on."""

    def close(self) -> object:
        """The pipe is closed."""


def priority_of(tos: int) -> str:
    """Zenoh's priority for a TOS byte.

    >>> [priority_of(dscp << 2) for dscp in (10, 0, 36, 44)]
    ['DATA_LOW', 'DATA', 'INTERACTIVE_HIGH', 'REAL_TIME']
    """
    dscp = tos >> 2
    for limit, name in _PRIORITIES:
        if dscp < limit:
            return name
    return "INTERACTIVE_HIGH" if dscp < 40 else "REAL_TIME"


class ZenohPipe(Answerable):
    """One end of a pipe."""

    scheme = "zenoh"
    eager = False  # it is no use to poll, Python's lock is in the way
    cost = 15e-6  # most of it in threads of Zenoh
    lends = True
    local: Address = ("", 0)
    remote: Address = ("", 0)

    def __init__(self, local: Address, remote: Address, line: Line) -> None:
        self.local = local
        self.remote = remote
        self._line = line
        self._tos = 0
        # What comes. Only the thread that reads changes it.
        self._chunk = _NOTHING
        self._whole = b""  # that which `_chunk` is the rest of
        self._over = False  # the reading side has seen the end
        self._next = 0  # number of the message that comes next
        self._early: dict[int, bytes] = {}  # what has overtaken that
        self._gap = 0.0  # until when it may come
        self._taken = 0  # bytes
        self._said = self._said_number = 0  # of those taken, how many the sender knows of
        self._due = 0.0  # when it is told again
        self._alarm = 0.0  # when we are woken, 0: we are not
        # What goes.
        self._number = 0
        self._sent = 0  # bytes
        self._spare = Spare()
        self._confirmed = self._confirmed_number = 0  # what the other end has taken
        self._changed = threading.Condition()  # of credit, and of the pipe's end
        self._sending = threading.RLock()  # messages leave in the order of their numbers
        self._halfway = False  # in sending one
        self._timeout: float | None = None  # of receives
        self._send_timeout: float | None = None
        self._ended = False  # the other end will say no more
        self._deaf = False  # nor listen
        self._broken = ""  # why nothing goes any more
        self._silent = False  # nothing goes any more: broken, interrupted or closed
        self._closed = False

    # -- what the exchange brings, in threads of Zenoh --------------------------------------------

    def told(self, data: bytes) -> None:
        """Take a control message of the other end's exchange."""
        kind = data[0] if data else RESET
        if kind == CREDIT and len(data) == _COUNT.size:
            _, taken, number = _COUNT.unpack(data)
            with self._changed:
                self._confirmed = max(self._confirmed, min(taken, self._sent))
                if (self._number - number) % _ALL < MESSAGES:
                    self._confirmed_number = number
                self._changed.notify_all()
        elif kind == CLOSED:  # what it has sent before may come later
            with self._changed:
                self._ended = self._deaf = True
                self._changed.notify_all()
        else:
            self.break_off("the other end of the connection is gone")

    def break_off(self, reason: str) -> None:
        """Nothing will come or go any more; what has come can still be read."""
        with self._changed:
            self._broken = self._broken or reason
            self._ended = self._silent = True
            self._changed.notify_all()
        self._wake()

    def _wake(self) -> None:
        try:
            self._line.wake()
        except Exception:
            pass  # the session is closed, which wakes everybody

    # -- receiving --------------------------------------------------------------------------------

    def _wait(self, wait: bool, timeout: float | None) -> bool:
        """Have bytes at hand; False at the end. Raises BlockingIOError."""
        deadline = None
        while not self._chunk and not self._over:
            if not wait or self._early or self._silent:
                data = self._early.pop(self._next, None) or self._look()
                if data is not None:
                    self._accept(data)
                    continue
                if self._silent:
                    self._over = True
                    break
                if not wait:
                    raise BlockingIOError("nothing has come")
            if timeout is not None:
                now = time.monotonic()
                if deadline is None:
                    deadline = now + timeout
                elif now >= deadline:
                    raise BlockingIOError("nothing has come")
            if self._early or deadline is not None:
                self._set_alarm(deadline)
            try:
                data = self._line.recv()  # woken by whoever says `silent`, or by the alarm
            except Exception:
                self._fail()
                continue
            if not self._early and data[:_SIZE] == _pack(DATA, self._next) != data:
                self._next = (self._next + 1) % _ALL
                self._whole, self._chunk = data, memoryview(data)[_SIZE:]
            else:
                self._accept(data)
        return not self._over

    def _look(self) -> bytes | None:
        try:
            return self._line.try_recv()
        except Exception:
            self._fail()
            return None

    def _fail(self) -> None:
        with self._changed:
            self._broken = self._broken or "the session with Zenoh is closed"
            self._silent = True
            self._changed.notify_all()

    def _set_alarm(self, deadline: float | None) -> None:
        """Be woken at that time, and when something is missing for too long."""
        if self._early:
            deadline = self._gap if deadline is None else min(deadline, self._gap)
        if deadline is not None and not 0 < self._alarm <= deadline:
            self._alarm = deadline
            CLOCK.set(deadline, self._ring)

    def _ring(self) -> None:
        self._alarm = 0.0
        self._wake()

    def _accept(self, data: bytes) -> None:
        if self._early and self._next not in self._early and time.monotonic() > self._gap:
            self._lose("something was lost on the way")
            return
        if not data or data[0] == WAKE:
            return
        kind, number = _unpack(data) if len(data) >= _SIZE else (RESET, 0)
        if kind not in (DATA, END):
            self._lose("what comes is no message")
        elif number != self._next:
            if not self._early:
                self._gap = time.monotonic() + REORDER_TIMEOUT
            self._early[number] = data
            if len(self._early) > MESSAGES:
                self._lose("too much was lost on the way")
        elif kind == END:
            self._over = self._ended = True
        else:
            self._next = (number + 1) % _ALL
            self._gap = time.monotonic() + REORDER_TIMEOUT if self._early else 0.0
            self._whole, self._chunk = data, memoryview(data)[_SIZE:]

    def _lose(self, reason: str) -> None:
        self._over = True
        self._early.clear()
        self.break_off(reason)
        self._tell(bytes([RESET]))

    def recv_into(self, view: memoryview) -> int:
        return self._copy(view) if self._chunk or self._wait(True, self._timeout) else 0

    def try_recv_into(self, view: memoryview) -> int:
        try:
            return self._copy(view) if self._chunk or self._wait(False, None) else 0
        except BlockingIOError:
            return -1

    def peek(self) -> int:
        """The first byte that comes, left unread; -1 for the end."""
        return self._chunk[0] if self._wait(True, self._timeout) else -1

    def _copy(self, view: memoryview) -> int:
        chunk = self._chunk
        count = len(chunk)
        if count <= len(view):
            view[:count] = chunk
            self._whole, self._chunk = b"", _NOTHING
        else:
            count = len(view)
            view[:] = chunk[:count]
            self._chunk = chunk[count:]
        self._take(count)
        return count

    def borrow(self, count: int, back: int) -> memoryview | None:
        """The next `count` bytes, read-only, where they have come, or None. They begin with the
        last `back` bytes of those that were received."""
        whole = self._whole
        start = len(whole) - len(self._chunk) - back
        end = start + count
        if start < _SIZE or end > len(whole) or 2 * count < len(whole):
            return None  # they lie elsewhere, or would keep much more than themselves
        view = memoryview(whole)
        self._chunk = view[end:]
        if not self._chunk:
            self._whole = b""
        self._take(count - back)
        return view[start:end]

    def _take(self, count: int) -> None:
        """So many bytes were taken, which the sender is told now and then."""
        self._taken += count
        now = time.monotonic()
        if (
            now > self._due
            or self._taken - self._said >= WINDOW // 4
            or (self._next - self._said_number) % _ALL >= MESSAGES // 4
        ) and not self._broken:
            self._said, self._said_number, self._due = (
                self._taken,
                self._next,
                now + CREDIT_INTERVAL,
            )
            self._tell(_COUNT.pack(CREDIT, self._taken, self._next))

    def _tell(self, data: bytes) -> None:
        try:
            self._line.tell(data)
        except Exception:  # the other end sees that, too
            self._broken = self._broken or "the session with Zenoh is closed"
            self._silent = True

    # -- sending ----------------------------------------------------------------------------------

    def send(self, buffers: Sequence[Buffer]) -> None:
        left = self.try_send(buffers)
        if not left:
            return
        limit = self._send_timeout
        deadline = None if limit is None else time.monotonic() + limit
        while left:
            if deadline is not None and time.monotonic() >= deadline:
                raise BlockingIOError("the other end does not read")
            self._wait_for_room(deadline)
            left = self.try_send(left)

    def _room(self) -> int:
        """Return how many bytes may go now."""
        if (self._number - self._confirmed_number) % _ALL >= MESSAGES:
            return 0
        return max(0, self._confirmed + WINDOW - self._sent)

    def try_send(self, buffers: Sequence[Buffer]) -> list[Buffer]:
        size = sum(map(len, buffers))
        with self._sending:
            self._halfway = True
            try:
                room = self._confirmed + WINDOW - self._sent
                if (  # as nearly always
                    0 < size <= FRAGMENT
                    and size <= room
                    and (self._number - self._confirmed_number) % _ALL < MESSAGES
                    and not (self._silent or self._deaf)
                ):
                    self._go(size, buffers)
                    return []
                return self._send_some([buffer for buffer in buffers if len(buffer)])
            finally:
                self._halfway = False

    def _send_some(self, left: list[Buffer]) -> list[Buffer]:
        while left:
            if self._silent or self._deaf:
                raise BrokenPipeError(self._broken or "the connection is closed")
            room = min(self._room(), FRAGMENT)
            if not room:
                break
            pieces: list[Buffer] = []
            while left and room:
                piece = left[0]
                if len(piece) > room:
                    left[0] = memoryview(piece)[room:]
                    piece = memoryview(piece)[:room]
                else:
                    left.pop(0)
                pieces.append(piece)
                room -= len(piece)
            self._go(sum(map(len, pieces)), pieces)
        return left

    def _go(self, size: int, pieces: Sequence[Buffer]) -> None:
        """Send a message of so many bytes."""
        data = self._spare.join((_pack(DATA, self._number), *pieces))
        self._number = (self._number + 1) % _ALL
        self._sent += size
        try:
            self._line.put(data)
            self._spare.give_back(data)
        except Exception as error:
            self.break_off("the session with Zenoh is closed")
            raise BrokenPipeError(self._broken) from error

    def _wait_for_room(self, deadline: float | None) -> None:
        with self._changed:
            while not (self._room() or self._silent or self._deaf):
                left = None if deadline is None else deadline - time.monotonic()
                if (left is not None and left <= 0) or not self._changed.wait(left):
                    return

    def wait_writable(self, seconds: float) -> bool:
        self._wait_for_room(time.monotonic() + seconds)
        return bool(self._room()) or self._silent or self._deaf

    # -- the rest of a transport ------------------------------------------------------------------

    def limit_waiting(self, seconds: float | None, sends: bool = True) -> None:
        self._timeout = seconds
        if sends:
            self._send_timeout = seconds

    def set_dscp(self, tos: int) -> None:
        with self._sending:
            if priority_of(tos) != priority_of(self._tos) and not self._silent:
                self._line.prefer(priority_of(tos))
            self._tos = tos

    def tos(self) -> int:
        return self._tos

    def ended(self) -> bool:
        return self._ended

    def taken(self, sent: int, received: int) -> tuple[int, bool] | None:
        return self._confirmed, False

    def interrupt(self) -> None:
        with self._changed:
            self._silent = True
            self._changed.notify_all()
        self._wake()

    def close(self) -> None:
        with self._changed:
            if self._closed:
                return
            self._closed = self._silent = True
            self._changed.notify_all()
        self._wake()
        with self._sending:
            if self._broken or self._halfway:  # beneath a signal handler, and will not end it
                self._tell(bytes([RESET]))
                # Again, when a link may be back: it may not know.
                CLOCK.set(time.monotonic() + RESET_RESEND, lambda: self._tell(bytes([RESET])))
            else:
                try:
                    self._line.put(_HEAD.pack(END, self._number))
                except Exception:
                    pass  # the session is closed
                self._tell(bytes([CLOSED]))
        self._line.close()
