"""Sending from other threads than the writer's: a link's own thread, and the one that sweeps up.

Rules: both take the link's lock for one message at a time. The queue of a link's own thread holds
one message, so that what is sent is never old; a carrier for people may allow a few more.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from typing import TYPE_CHECKING, Final

from yarpy.errors import LinkClosed, YarpError
from yarpy.qos import schedule
from yarpy.wire.message import Packet

if TYPE_CHECKING:
    from yarpy.link.outbound import Outbound
    from yarpy.link.sender import Sender

GATHER_SECONDS: Final = 200e-6  # how long a burst's message may wait for others


class Background:
    """The queue and loop of a link's own sending thread: one message in flight, one waiting."""

    def __init__(self, link: Outbound) -> None:
        self._link = link
        self._waiting: deque[Packet] = deque()
        self._busy = False
        self._stopped = False
        self._changed = threading.Condition()  # writer and sender pass packets

    def put(self, packet: Packet, backlog: int = 0) -> bool:
        """Take the packet if the link is idle, or if fewer than `backlog` wait; else count a
        drop."""
        with self._changed:
            busy = self._busy or bool(self._waiting)
            if self._stopped or (busy and len(self._waiting) >= backlog):
                self._link.counter.drops += 1
                return False
            self._waiting.append(packet)
            self._changed.notify_all()
            return True

    def has_room(self, backlog: int) -> bool:
        """Whether `put` would take a packet now."""
        waiting = len(self._waiting)
        return not self._stopped and (waiting < backlog or not (waiting or self._busy))

    def wait_put(self, packet: Packet) -> None:
        """Take the packet; wait while an earlier one has not begun to leave."""
        with self._changed:
            self._changed.wait_for(lambda: not self._waiting or self._stopped)
            if self._stopped:
                self._link.counter.drops += 1
                raise LinkClosed(f'the connection to "{self._link.route.target}" is gone')
            self._waiting.append(packet)
            self._changed.notify_all()

    def wait_empty(self, timeout: float | None) -> bool:
        """Wait until nothing waits or leaves."""
        with self._changed:
            return self._changed.wait_for(
                lambda: self._stopped or not (self._waiting or self._busy), timeout
            )

    def stop(self) -> None:
        """Let the thread end."""
        with self._changed:
            self._stopped = True
            self._link.counter.drops += len(self._waiting)
            self._waiting.clear()
            self._changed.notify_all()

    def run(self) -> None:
        """Send what is put, until stopped."""
        link = self._link
        if link.sched.policy >= 0:
            try:
                schedule(0, link.sched)
            except YarpError:
                pass  # said when it was asked for; the link sends all the same
        while True:
            with self._changed:
                self._busy = False
                self._changed.notify_all()
                self._changed.wait_for(lambda: bool(self._waiting) or self._stopped)
                if self._stopped:
                    return
                packet = self._waiting.popleft()
                self._busy = True
                self._changed.notify_all()
            try:
                with link.lock:
                    link.send_now(packet)
            except YarpError:
                self.stop()


class Sweeper:
    """Sends what a burst left behind, if its writer does not come back to do so."""

    def __init__(self, link: Sender) -> None:
        self._link = link
        self._wake = threading.Semaphore(0)
        self._asleep = True
        threading.Thread(target=self._run, name=f"yarpy sweep {link.route}", daemon=True).start()

    def watch(self) -> None:
        """Something was gathered."""
        if self._asleep:
            self._asleep = False
            self._wake.release()

    def _run(self) -> None:
        while not self._link.broken:
            if not self._wake.acquire(timeout=5.0):
                continue
            while True:
                time.sleep(GATHER_SECONDS)
                self._link.sweep()
                if time.perf_counter() - self._link.left > 100 * GATHER_SECONDS:
                    break
            self._asleep = True
            self._link.sweep()
