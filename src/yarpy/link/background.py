"""Sending from threads other than the writer's: a link's own thread, and the sweeper's.

Rules: they do not know the link; they are handed a callable, which takes the link's lock for one
message at a time. The queue of a link's own thread holds one message, so that no stale message is
sent; a carrier for people may allow a few more.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable
from typing import Final, Generic, TypeVar

from yarpy.errors import YarpError
from yarpy.link.counter import Counter

T = TypeVar("T")  # a packet, as the link puts it

GATHER_SECONDS: Final = 200e-6  # how long a burst's message may wait for others


class Background(Generic[T]):
    """The queue and loop of a link's own sending thread: one message in flight, one waiting.

    What is dropped is counted in `counter`.
    """

    def __init__(self, send: Callable[[T], object], counter: Counter) -> None:
        self.send = send  # may be another one, for those that come later
        self._counter = counter
        self._waiting: deque[T] = deque()
        self._busy = False
        self._stopped = False
        self._changed = threading.Condition()  # writer and sender pass packets

    def put(self, packet: T, backlog: int = 0) -> bool:
        """Take the packet if the link is idle, or if fewer than `backlog` wait; else count a
        drop."""
        with self._changed:
            busy = self._busy or bool(self._waiting)
            if self._stopped or (busy and len(self._waiting) >= backlog):
                self._counter.drops += 1
                return False
            self._waiting.append(packet)
            self._changed.notify_all()
            return True

    def has_room(self, backlog: int) -> bool:
        """Whether `put` would take a packet now."""
        waiting = len(self._waiting)
        return not self._stopped and (waiting < backlog or not (waiting or self._busy))

    @property
    def pending(self) -> int:
        """Messages that wait, and the one that is being sent."""
        return len(self._waiting) + self._busy

    @property
    def stopped(self) -> bool:
        """Whether nothing is taken any more."""
        return self._stopped

    def wait_put(self, packet: T, deadline: float | None = None) -> bool:
        """Take the packet, once an earlier one has begun to leave. False, and counted, if the queue
        was stopped, or that takes until `deadline` (of time.monotonic).
        """
        with self._changed:
            timeout = None if deadline is None else deadline - time.monotonic()
            room = self._changed.wait_for(lambda: not self._waiting or self._stopped, timeout)
            if self._stopped or not room:
                self._counter.drops += 1
                return False
            self._waiting.append(packet)
            self._changed.notify_all()
            return True

    def wait_empty(self, timeout: float | None) -> bool:
        """Wait until nothing is queued or being sent."""
        with self._changed:
            return self._changed.wait_for(
                lambda: self._stopped or not (self._waiting or self._busy), timeout
            )

    def stop(self) -> None:
        """Let the thread end."""
        with self._changed:
            self._stopped = True
            self._counter.drops += len(self._waiting)
            self._waiting.clear()
            self._changed.notify_all()

    def run(self) -> None:
        """Send what is put, until stopped."""
        while True:
            with self._changed:
                self._busy = False
                self._changed.notify_all()
                self._changed.wait_for(lambda: bool(self._waiting) or self._stopped)
                if self._stopped:
                    return
                self._busy = True  # first, for `has_room` looks without the lock
                packet = self._waiting.popleft()
                self._changed.notify_all()
            try:
                self.send(packet)
            except YarpError:
                self.stop()
            except BaseException:  # a defect: nobody may wait for this thread
                self.stop()
                raise


class Sweeper:
    """Sends what a burst left behind, if its writer does not come back to do so.

    `sweep` does that, and says whether the burst may still go on.
    """

    def __init__(self, name: str, sweep: Callable[[], bool]) -> None:
        self._sweep = sweep
        self._wake = threading.Semaphore(0)
        self._asleep = True
        self._stopped = False
        self.thread = threading.Thread(target=self._run, name=name, daemon=True)
        self.thread.start()

    def watch(self) -> None:
        """Something was gathered."""
        if self._asleep:
            self._asleep = False
            self._wake.release()

    def stop(self) -> None:
        """Let the thread end."""
        self._stopped = True
        self._wake.release()

    def _run(self) -> None:
        while True:
            self._wake.acquire()
            if self._stopped:
                return
            while True:
                time.sleep(GATHER_SECONDS)
                if not self._sweep():
                    break
            self._asleep = True
            self._sweep()
