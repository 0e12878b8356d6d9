"""A pipe of bytes through Zenoh: what a TCP connection is where there is no way for one.

    kind (1 byte)   what follows
    DATA            number of the message (uint32 LE), bytes
    CREDIT          how many bytes the reader has taken, of all (uint64 LE)
    END             number of the message: nothing will come any more
    RESET           something was lost, or is not wanted: the pipe is broken
    SYNC, SYNCED    everything before this has come; said, and answered, where a priority changes

Rules: Zenoh keeps the order and loses nothing as long as all the links on the way stand. What is
missing when one breaks is seen by the numbers, and breaks the pipe: the ports make a new connection
then, and count what was lost. A sender has at most `WINDOW` bytes on their way, so a slow reader
holds up its own sender alone, and nobody has to keep more. The reading threads wait here, never one
of Zenoh. Errors are OSError, as everywhere in this room.
"""

from __future__ import annotations

import struct
import threading
import time
from collections.abc import Callable, Sequence
from queue import Empty, SimpleQueue
from typing import Any, Final

from yarpy.transports.base import Address
from yarpy.wire.stream import Buffer

DATA, CREDIT, END, RESET, SYNC, SYNCED = range(6)
WINDOW: Final = 1 << 23  # bytes on their way to a reader
PIECE: Final = 1 << 21  # bytes of one message of Zenoh
TOLD: Final = WINDOW // 4  # bytes that a reader takes before it says so,
SAY: Final = 0.1  # or the seconds after which it does
CHANGE: Final = 5.0  # seconds for what is on its way to arrive before the priority changes

_HEAD = struct.Struct("<BI")
_COUNT = struct.Struct("<BQ")
_END: Final = memoryview(b"")

Put = Callable[[bytes], object]
# DSCP numbers below which a priority of Zenoh is the right one: YARP's LOW, NORM (0), HIGH, CRIT.
_PRIORITIES: Final = ((8, "DATA"), (16, "DATA_LOW"), (24, "DATA_HIGH"), (32, "INTERACTIVE_LOW"))


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


class ZenohPipe:
    """One end of a pipe. `eager`: it is no use to poll, since what comes is brought by another
    thread. `connect` says how to send to the other one: it is given a priority, and
    returns what sends bytes and what ends that. `left` is called once, when it is closed."""

    eager: Final = False

    def __init__(
        self,
        local: Address,
        remote: Address,
        connect: Callable[[str], tuple[Put, Callable[[], object]]],
        left: Callable[[], object] = lambda: None,
    ) -> None:
        self.local = local
        self.remote = remote
        self.port = 0
        self._connect = connect
        self._left = left
        self._put: Put
        self._finish: Callable[[], object]
        self._put, self._finish = connect(priority_of(0))
        self._tos = 0
        # What has come.
        self._inbox: SimpleQueue[memoryview] = SimpleQueue()
        self._chunk = memoryview(b"")
        self._over = False  # the reading side has seen the end
        self._next = 0  # number of the message that comes next
        self._came = 0  # bytes
        self._taken = 0
        self._said = 0  # of those taken, how many the sender knows of
        self._due = 0.0  # when it is told again
        # What goes.
        self._number = 0
        self._sent = 0  # bytes
        self._allowed = WINDOW
        self._confirmed = 0  # bytes that the other end has taken
        self._changed = threading.Condition()  # of credit, and of the pipe's end
        self._sending = threading.Lock()  # messages leave in the order of their numbers
        self._synced = threading.Event()
        self._patience: float | None = None  # of receives
        self._send_patience: float | None = None
        self._ended = False  # the other end will say no more
        self._broken = ""  # why nothing goes any more
        self._interrupted = False
        self._closed = False

    @property
    def _silent(self) -> bool:
        """Whether nothing goes any more."""
        return bool(self._broken) or self._interrupted or self._closed

    # -- what comes from Zenoh, in its threads ----------------------------------------------------

    def deliver(self, data: bytes) -> None:
        """A message for this end."""
        kind = data[0] if data else RESET
        if kind == DATA and len(data) > _HEAD.size:
            self._take(data)
        elif kind == CREDIT and len(data) == _COUNT.size:
            with self._changed:
                taken = min(_COUNT.unpack(data)[1], self._sent)
                self._confirmed = max(self._confirmed, taken)
                self._allowed = self._confirmed + WINDOW
                self._changed.notify_all()
        elif kind == SYNC:
            # Not here: a thread of Zenoh may not wait until it can send.
            threading.Thread(target=self._say, args=(bytes([SYNCED]),), daemon=True).start()
        elif kind == SYNCED:
            self._synced.set()
        elif kind == END and len(data) == _HEAD.size and _HEAD.unpack(data)[1] == self._next:
            self._ended = True
            self._inbox.put(_END)
        else:
            self.break_off("the other end of the connection is gone")

    def _take(self, data: bytes) -> None:
        number = _HEAD.unpack_from(data)[1]
        size = len(data) - _HEAD.size
        if number != self._next or self._came + size - self._taken > WINDOW:
            self.break_off("something was lost on the way")
            self._reset()
            return
        self._next = (number + 1) & 0xFFFFFFFF
        self._came += size
        self._inbox.put(memoryview(data)[_HEAD.size :])

    def break_off(self, reason: str) -> None:
        """Nothing will come or go any more; what has come can still be read."""
        with self._changed:
            self._broken = self._broken or reason
            self._ended = True
            self._changed.notify_all()
        self._synced.set()
        self._inbox.put(_END)

    def _reset(self) -> None:
        threading.Thread(target=self._say, args=(bytes([RESET]),), daemon=True).start()

    def _say(self, data: bytes) -> None:
        try:
            self._put(data)
        except Exception:  # the session is closed, and the other end sees that, too
            self.break_off("the session with Zenoh is closed")

    # -- a transport ------------------------------------------------------------------------------

    def ready(self, look: Callable[[], object] | None = None) -> None:
        """It is, once it was opened."""

    def _wait(self, wait: bool, patience: float | None) -> bool:
        """Have bytes at hand; False at the end. Raises BlockingIOError."""
        if self._chunk:
            return True
        if self._over:
            return False
        try:
            self._chunk = self._inbox.get(wait, patience)
        except Empty:
            raise BlockingIOError("nothing has come") from None
        if self._chunk:
            return True
        self._over = True
        return False

    def recv_into(self, view: memoryview) -> int:
        return self._copy(view) if self._wait(True, self._patience) else 0

    def try_recv_into(self, view: memoryview) -> int:
        try:
            return self._copy(view) if self._wait(False, None) else 0
        except BlockingIOError:
            return -1

    def peek(self) -> int:
        """The first byte that comes, left unread; -1 for the end."""
        return self._chunk[0] if self._wait(True, self._patience) else -1

    def _copy(self, view: memoryview) -> int:
        count = min(len(view), len(self._chunk))
        view[:count] = self._chunk[:count]
        self._chunk = self._chunk[count:]
        self._taken += count
        now = time.monotonic()
        if (self._taken - self._said >= TOLD or now > self._due) and not self._broken:
            self._said, self._due = self._taken, now + SAY
            self._say(_COUNT.pack(CREDIT, self._taken))
        return count

    def send(self, buffers: Sequence[Buffer]) -> None:
        limit = self._send_patience
        deadline = None if limit is None else time.monotonic() + limit
        left = self.try_send(buffers)
        while left:
            if deadline is not None and time.monotonic() >= deadline:
                raise BlockingIOError("the other end does not read")
            self._wait_for_room(deadline)
            left = self.try_send(left)

    def try_send(self, buffers: Sequence[Buffer]) -> list[Buffer]:
        left = [buffer for buffer in buffers if len(buffer)]
        with self._sending:
            while left:
                room = min(self._allowed - self._sent, PIECE)
                if self._silent:
                    raise BrokenPipeError(self._broken or "the connection is closed")
                if not room:
                    return left
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
                data = b"".join((_HEAD.pack(DATA, self._number), *pieces))
                self._number = (self._number + 1) & 0xFFFFFFFF
                self._sent += len(data) - _HEAD.size
                self._say(data)
        return left

    def _wait_for_room(self, deadline: float | None) -> None:
        with self._changed:
            while self._allowed == self._sent and not self._silent:
                left = None if deadline is None else deadline - time.monotonic()
                if (left is not None and left <= 0) or not self._changed.wait(left):
                    return

    def wait_writable(self, seconds: float) -> bool:
        self._wait_for_room(time.monotonic() + seconds)
        return self._allowed != self._sent or self._silent

    def limit_waiting(self, seconds: float | None, sends: bool = True) -> None:
        self._patience = seconds
        if sends:
            self._send_patience = seconds

    def set_dscp(self, tos: int) -> None:
        """Send with another priority from now on. Raises TimeoutError if what is on its way does
        not arrive: what comes later may not overtake it."""
        if priority_of(tos) == priority_of(self._tos):
            self._tos = tos
            return
        with self._sending:
            self._synced.clear()
            self._say(bytes([SYNC]))
            if not self._synced.wait(CHANGE):
                raise TimeoutError("the other end does not answer")
            if not self._broken:
                self._finish()
                self._put, self._finish = self._connect(priority_of(tos))
                self._tos = tos

    def tos(self) -> int:
        return self._tos

    def ended(self) -> bool:
        return self._ended

    def taken(self, sent: int, received: int) -> tuple[int, bool] | None:
        return self._confirmed, False

    def interrupt(self) -> None:
        with self._changed:
            self._interrupted = True
            self._changed.notify_all()
        self._inbox.put(_END)

    def close(self) -> None:
        with self._changed:
            if self._closed:
                return
            self._closed = True
            self._changed.notify_all()
        self._inbox.put(_END)
        with self._sending:
            if not self._broken:
                self._say(_HEAD.pack(END, self._number))
            self._finish()
        self._left()


def open_publisher(session: Any, key: str) -> Callable[[str], tuple[Put, Callable[[], object]]]:
    """How a pipe sends over a session: nothing is dropped, and nothing waits for more to come."""

    def connect(priority: str) -> tuple[Put, Callable[[], object]]:
        import zenoh

        publisher = session.declare_publisher(
            key,
            congestion_control=zenoh.CongestionControl.BLOCK,
            priority=getattr(zenoh.Priority, priority),
            express=True,
        )
        return publisher.put, lambda: _forget(publisher)

    return connect


def _forget(publisher: Any) -> None:
    try:
        publisher.undeclare()
    except Exception:
        pass  # the session is closed
