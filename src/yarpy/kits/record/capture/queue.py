"""The queue of a recorder: messages wait here, in bounded memory, for the thread that writes.

Rules: the threads of connections put, one thread takes. Nobody who puts ever waits: where memory is
full the message is lost, or replaces older ones of its port, counted, and its sender knows nothing
of it. Messages are numbered by
nothing but their order; `received_ns` never runs backwards within what is taken at once, unless the
clock of the machine does.
"""

from __future__ import annotations

import fnmatch
import threading
import time
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

from yarpy.errors import YarpError
from yarpy.kits.record.mcap.writer import LARGEST
from yarpy.wire.message import UNSENDABLE, Message

MEMORY: Final = 256 << 20  # bytes
OVERHEAD: Final = 400  # bytes that a message takes besides its payload
SPARE: Final = 1 << 16  # bytes that a view may keep alive beyond its own, and as many again


class QueuedMessage(NamedTuple):
    """A message that waits to be written; `size` is the memory that it takes. `follows`: whatever
    came from its port since the message before was taken, too."""

    port: str
    received_ns: int
    envelope: str
    payload: bytes | memoryview
    size: int
    follows: bool = True


@dataclass(slots=True)
class Count:
    """The counts of a port: `messages` and `bytes` that were taken, `lost` for want of memory,
    `replaced` by newer ones for want of it, `left_out` to keep to a rate, `missed` that the counts
    of its envelopes say did not arrive."""

    messages: int = 0
    bytes: int = 0
    lost: int = 0
    left_out: int = 0
    missed: int = 0
    replaced: int = 0
    next_ns: int = 0  # before this, messages are left out
    sequence: int = -1  # of the envelope of the last one that was written
    broken: bool = True  # something that came was not taken

    def refuse(self) -> None:
        """A message is lost."""
        self.lost += 1
        self.broken = True


class MessageQueue:
    """Takes messages in, up to `memory` bytes that were not written yet.

    rates: patterns of ports (`/cam/*`) with the messages a second that are taken of them. newest:
    patterns of those whose newest messages are worth more than older ones that still wait. now: the
    clock of the times of receipt, in nanoseconds.
    """

    def __init__(
        self,
        memory: int = MEMORY,
        rates: Mapping[str, float] | None = None,
        now: Callable[[], int] = time.time_ns,
        newest: Sequence[str] = (),
    ) -> None:
        self._now = now
        self.memory = memory
        self.paused = False
        self.counts: dict[str, Count] = {}
        self.held = 0  # bytes
        self._rates = dict(rates or {})
        self._periods: dict[str, int] = {}  # nanoseconds between messages of a port
        self._waiting: list[QueuedMessage | None] = []  # None was replaced
        self._newest = tuple(newest)
        self._places: dict[str, deque[int]] = {}  # of such ports, what waits
        self._ended = False
        self._lock = threading.Lock()  # links come from threads of their own
        self._urgent = threading.Event()

    def put(self, message: Message) -> None:
        """Take a message, or count why not. Called in the thread of its connection."""
        port = message.source
        if self.paused:
            known = self.counts.get(port)
            if known is not None:
                known.broken = True
            return
        if self._rates and (period := self._period(port)) and self._leave_out(port, period):
            return
        try:
            payload = message.payload
            if type(payload) is not bytes or message.spelling != "binary":
                payload = own(message)
        except (YarpError, *UNSENDABLE):
            with self._lock:
                self._count(port).refuse()
            return
        length = len(payload)
        size = length + OVERHEAD
        with self._lock:
            count = self._count(port)
            places = self._replaceable(port) if self._newest else None
            while places and self.memory - size < self.held and size <= self.memory:
                self._replace(count, places)
            if self.held + size > self.memory or length > LARGEST or self._ended:
                count.refuse()
                return
            now = self._now()
            self.held += size
            count.messages += 1
            count.bytes += length
            follows, count.broken = not count.broken, False
            if places is not None:
                places.append(len(self._waiting))
            self._waiting.append(QueuedMessage(port, now, message.envelope, payload, size, follows))
            urgent = self.held > self.memory // 8
        if urgent:
            self._urgent.set()

    def _count(self, port: str) -> Count:
        """Return what is counted of a port; inside the lock."""
        count = self.counts.get(port)
        if count is None:
            count = self.counts[port] = Count()
        return count

    def _replaceable(self, port: str) -> deque[int] | None:
        """Return where messages of a port wait, None if none of them is replaced."""
        places = self._places.get(port)
        if places is None and any(fnmatch.fnmatchcase(port, one) for one in self._newest):
            places = self._places[port] = deque()
        return places

    def _replace(self, count: Count, places: deque[int]) -> None:
        """Drop the oldest message of a port that waits; inside the lock."""
        place = places.popleft()
        old, self._waiting[place] = self._waiting[place], None
        assert old is not None
        self.held -= old.size
        count.messages -= 1
        count.bytes -= len(old.payload)
        count.replaced += 1
        if places and (after := self._waiting[places[0]]) is not None:
            self._waiting[places[0]] = after._replace(follows=False)
        else:
            count.broken = True

    def _period(self, port: str) -> int:
        period = self._periods.get(port)
        if period is None:
            found = [rate for name, rate in self._rates.items() if fnmatch.fnmatchcase(port, name)]
            period = self._periods[port] = round(1e9 / min(found)) if found else 0
        return period

    def _leave_out(self, port: str, period: int) -> bool:
        """Return whether a message comes too early, which is counted."""
        now = time.monotonic_ns()
        with self._lock:
            count = self._count(port)
            if now < count.next_ns:
                count.left_out += 1
                count.broken = True
                return True
            late = now - count.next_ns
            count.next_ns = (now if late > period else count.next_ns) + period
        return False

    def wait(self, seconds: float) -> None:
        """Return after so many seconds, or at once when much is waiting."""
        self._urgent.wait(seconds)
        self._urgent.clear()

    def wake(self) -> None:
        """Let `wait` return."""
        self._urgent.set()

    def take(self) -> list[QueuedMessage]:
        """Return what waits. Its memory counts until `free`."""
        with self._lock:
            queued, self._waiting = self._waiting, []
            self._places.clear()
        return [one for one in queued if one is not None]

    def end(self) -> list[QueuedMessage]:
        """Return what waits, and refuse what comes from now on."""
        with self._lock:
            self._ended = True
        return self.take()

    def free(self, size: int) -> None:
        """Note that so many bytes of the memory are free again."""
        with self._lock:
            self.held -= size

    def forget(self, port: str) -> None:
        """A port is connected anew: its numbers may begin anywhere."""
        with self._lock:
            self._count(port).broken = True

    def lose(self, queued: QueuedMessage) -> None:
        """A message could not be written."""
        with self._lock:
            count = self._count(queued.port)
            count.messages -= 1
            count.bytes -= len(queued.payload)
            count.lost += 1


def own(message: Message) -> bytes | memoryview:
    """Return the payload of a message for keeps: a view of memory that nobody else uses, else a
    copy. Raises as encoding does."""
    payload = message.to_bytes()
    if type(payload) is bytes:
        return payload
    if isinstance(payload, memoryview) and payload.contiguous:
        whole = payload.obj
        # What is shared with other programs, or is much larger, would be kept from its owner.
        if type(whole) is bytearray and len(whole) <= 2 * len(payload) + SPARE:
            return payload.cast("B") if payload.format != "B" or payload.ndim != 1 else payload
    return bytes(payload)
