"""Queued: a connection has a thread of its own, which sends.

Rules: one message is being sent and one waits, so that no stale message is sent; the writer waits
for its place. The thread has the connection's scheduling. It takes messages until the connection
ends, whether or not its port is interrupted meanwhile.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING

from yarpy.errors import YarpError
from yarpy.link.ending import NEVER, NOW, Ending
from yarpy.link.send.outbox import Outbox, Rest
from yarpy.threads import Thread

if TYPE_CHECKING:
    from yarpy.link.counter import Counter
    from yarpy.link.send.sender import Sender
    from yarpy.wire.message import Packet

Send = Callable[["Packet", "float | None"], object]


class Queue:
    """The places of messages, and the thread called `name`, which hands them to `send` with the
    moment until which they are due; it calls `begin` first. What is dropped is counted in
    `counter`."""

    def __init__(
        self, send: Send, counter: Counter, name: str, begin: Callable[[], None] | None = None
    ) -> None:
        self.send = send
        self.thread: threading.Thread | None = None  # once there is something to send
        self._name = name
        self._begin = begin
        self.stopped = False  # nothing is taken any more
        self._counter = counter
        self._waiting: deque[tuple[Packet, float | None]] = deque()
        self._busy = False
        # Writer and thread pass packets. Held by itself: where a signal handler raises, `with` of a
        # Condition, which is written in Python, may leave it locked.
        self._lock = threading.RLock()
        self._changed = threading.Condition(self._lock)

    def start(self) -> None:
        """Begin to send."""
        with self._lock:
            if self.thread is None and not self.stopped:
                self.thread = Thread(target=self._run, name=self._name, daemon=True)
                self.thread.start()

    def _add(self, packet: Packet, due: float | None) -> None:
        self._waiting.append((packet, due))
        if self.thread is None:
            self.start()
        self._changed.notify_all()

    def has_room(self, backlog: int) -> bool:
        """Return whether nothing waits or is being sent, or fewer than `backlog` messages wait."""
        waiting = len(self._waiting)
        return not self.stopped and (waiting < backlog or not (waiting or self._busy))

    @property
    def pending(self) -> int:
        """Messages that wait, and the one that is being sent."""
        return len(self._waiting) + self._busy

    def put(self, packet: Packet, due: float | None, backlog: int) -> bool:
        """Take a packet; return False if there is no room, see `has_room`."""
        with self._lock:
            if not self.has_room(backlog):
                return False
            self._add(packet, due)
            return True

    def push(self, packet: Packet, due: float | None, size: int) -> None:
        """Take a packet; of more than `size` that wait, the oldest is not sent."""
        with self._lock:
            if self.stopped:
                self._counter.drops += 1
                return
            while len(self._waiting) >= size:
                self._waiting.popleft()
                self._counter.replaced += 1
            self._add(packet, due)

    def wait_put(
        self, packet: Packet, due: float | None, until: float | None, ending: Ending
    ) -> bool:
        """Take a packet once the one before has begun to leave; return False if `until` comes
        first, or an end."""
        with self._lock:
            free = ending.wait_for(self._changed, lambda: not self._waiting or self.stopped, until)
            if self.stopped or not free:
                return False
            self._add(packet, due)
            return True

    def wait_empty(self, until: float | None, ending: Ending = NEVER) -> bool:
        """Wait until nothing is queued or being sent; return False if `until` comes first."""
        with self._lock:
            return ending.wait_for(
                self._changed, lambda: self.stopped or not (self._waiting or self._busy), until
            )

    def stop(self) -> None:
        """Let the thread end."""
        with self._lock:
            self.stopped = True
            self._counter.drops += len(self._waiting)
            self._waiting.clear()
            self._changed.notify_all()

    def _run(self) -> None:
        """Send what is put, until stopped."""
        if self._begin is not None:
            self._begin()
        while True:
            with self._lock:
                self._busy = False
                self._changed.notify_all()
                self._changed.wait_for(lambda: bool(self._waiting) or self.stopped)
                if self.stopped:
                    return
                self._busy = True  # first, for `has_room` looks without the lock
                packet, due = self._waiting.popleft()
                self._changed.notify_all()
            try:
                self.send(packet, due)
            except YarpError:
                self.stop()
            except BaseException:  # a defect: nobody may wait for this thread
                self.stop()
                raise


class Queued(Outbox):
    """Hands messages to the thread of `queue`."""

    def __init__(self, sender: Sender, queue: Queue) -> None:
        super().__init__(sender)
        self._queue = queue

    def offer(
        self, packet: Packet, until: float | None = None, due: float | None = None
    ) -> bool | Rest:
        if until == NOW and not self._queue.has_room(1) and not self._queue.stopped:
            return Later(self, packet, due)
        found = self.passed(packet)
        if found is None:
            return False
        if not self.sender.carrier.prepare(found):  # what cannot be sent is the writer's error
            return self.drop()
        return self.put(found, until, due)

    def put(self, packet: Packet, until: float | None, due: float | None) -> bool | Rest:
        sender, queue = self.sender, self._queue
        limit = until
        if due is not None:
            limit = due if until is None else min(until, due)
        if until == NOW:
            if queue.put(packet, due, 1):
                return True
        elif sender.wait(lambda by: queue.wait_put(packet, due, by, sender.ending), limit):
            return True
        if queue.stopped:
            sender.counter.drops += 1
            raise sender.gone()
        late = due is not None and time.monotonic() >= due
        if until == NOW and not late:
            return Rest(self, packet, due)
        self.drop(late)
        sender.ending.check()
        return False


class Later(Rest):
    """A message that nobody has looked at yet."""

    def offer(self, until: float | None) -> bool | Rest:
        """As `Outbox.offer`."""
        assert self._packet is not None
        return self._box.offer(self._packet, until, self._due)
