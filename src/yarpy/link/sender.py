"""Sender: puts the messages of a connection on the wire, and takes in its acknowledgements.

Rules: the caller holds `lock`, for one message at a time. Acknowledgements are read late: up to
`WINDOW` messages may be on their way unconfirmed, then a send waits. When messages follow each
other without a pause, the first leaves at once and those behind it are gathered into one send; a
short timer sends what a writer leaves behind.
"""

from __future__ import annotations

import threading
import time
from typing import TYPE_CHECKING, Final

from yarpy.errors import LinkClosed, Timeout, YarpError
from yarpy.link.background import GATHER_SECONDS, Sweeper
from yarpy.link.counter import Counter
from yarpy.log import logger
from yarpy.wire.message import UNSENDABLE, Packet

if TYPE_CHECKING:
    from yarpy.carriers.base import Carrier
    from yarpy.link.driver import Driver
    from yarpy.route import Route
    from yarpy.wire.steps import Steps

log = logger("yarpy.link")

# How far a sender may be ahead of acknowledgements: in messages, bytes, seconds. Thus a slow reader
# holds its sender up (backpressure), as in C++, instead of getting old data.
WINDOW: Final = 256
WINDOW_BYTES: Final = 1 << 16
WINDOW_SECONDS: Final = 0.005
ASK_EVERY: Final = 32  # messages after which acknowledgements are looked for

# Gathering. A writer that comes back within RUSH times what a send takes on this machine, BURST
# times in a row, is flooding.
RUSH: Final = 3.0
BURST: Final = 16
GATHER: Final = 64  # messages


class Sender:
    """The sending end of one connection."""

    def __init__(self, driver: Driver, carrier: Carrier) -> None:
        self.driver = driver
        self.carrier = carrier
        self.route: Route = carrier.route
        self.counter = Counter(since=time.time())
        self.lock = threading.Lock()  # one message at a time on the wire
        self.broken = False
        self.unacknowledged = 0
        self._acks: Steps[None] | None = None
        self._mute = False  # the peer does not acknowledge: nothing waits for it to
        self._ahead_since = 0.0
        self._ahead_from = 0
        self._rush = 0
        self._cost = 12e-6  # what a send takes when nothing holds it up: the least seen, in seconds
        self._left = 0.0  # when the last send ended
        self.gathered = 0  # messages that wait in the stream for the next send
        self._gathered_since = 0.0
        self._sweeper: Sweeper | None = None

    # -- sending ----------------------------------------------------------------------------------

    def send(self, packet: Packet) -> None:
        """Send a message, or gather it. Raises LinkClosed."""
        with self.lock:
            self._send(packet)

    def _send(self, packet: Packet) -> None:
        if self.broken:
            self.counter.drops += 1
            raise self.gone()
        carrier, driver = self.carrier, self.driver
        now = time.perf_counter()
        try:
            if self.unacknowledged and carrier.limits.ack_timeout is not None:
                self._confirm(carrier.limits.ack_timeout)
            elif self.unacknowledged and (
                now - self._ahead_since > WINDOW_SECONDS
                or driver.bytes_out - self._ahead_from > WINDOW_BYTES
            ):
                self.collect(wait=True, all_=True)
            carrier.encode(driver.stream, packet)
            if now - self._left > RUSH * self._cost:
                self._rush = 0
                self._flush_at_once(now)
            elif self._rush < BURST:
                self._rush += 1
                self._flush_at_once(now)
            elif carrier.delivery.coalesces and packet.small:
                self._gather(now)
            else:
                self.flush()
        except BaseException as error:
            if interrupts(error):
                self.counter.drops += 1
                self.give_up()
            raise
        counter = self.counter
        counter.count(now)
        counter.bytes = driver.bytes_out
        if carrier.acks:
            if not self.unacknowledged:
                self._ahead_since = now
                self._ahead_from = driver.bytes_out
            self.unacknowledged += 1
            if self.unacknowledged % ASK_EVERY == 0:
                self._look_for_acks()
        self._left = time.perf_counter()

    def gone(self) -> LinkClosed:
        """The error that a writer gets once the link is broken."""
        return LinkClosed(f'the connection to "{self.route.target}" is gone')

    def flush(self) -> None:
        """Send what was written, and what was gathered before it."""
        self.driver.flush()
        self.gathered = 0

    def _flush_at_once(self, now: float) -> None:
        """Send, and learn how long that takes; it seems longer when the reader runs first."""
        self.flush()
        self._cost = min(self._cost, time.perf_counter() - now)

    def _gather(self, now: float) -> None:
        """Coalesce: leave the message in the stream for the next send, which comes soon."""
        if not self.gathered:
            self._gathered_since = now
            if self._sweeper is None:
                self._sweeper = Sweeper(f"yarpy sweep {self.route}", self._sweep_up)
            self._sweeper.watch()
        if self.gathered + 1 >= GATHER or now - self._gathered_since >= GATHER_SECONDS:
            self.flush()
        else:
            self.gathered += 1

    def sweep(self, timeout: float | None = None) -> bool:
        """Send what a burst left behind; False if a thread is stuck in sending for `timeout`
        seconds."""
        if not self.lock.acquire(timeout=seconds(timeout)):
            return False
        try:
            if self.gathered and not self.broken:
                self.flush()
        except YarpError:
            self.give_up()
        finally:
            self.lock.release()
        return True

    def _sweep_up(self) -> bool:
        """Sweep for the sweeper: whether the burst may still go on."""
        self.sweep()
        return not self.broken and time.perf_counter() - self._left < 100 * GATHER_SECONDS

    # -- what comes back --------------------------------------------------------------------------

    def _confirm(self, limit: float) -> None:
        """Wait for the acknowledgement of the last message before the next one goes, `limit`
        seconds at most."""
        if self._mute:
            self.collect(wait=False)
            return
        try:
            self.collect(wait=True, all_=True, deadline=time.monotonic() + limit)
        except Timeout:
            self._fall_mute(limit)
        finally:
            self.driver.transport.limit_waiting(None)

    def _fall_mute(self, limit: float) -> None:
        self._mute = True
        log.warning(
            '%s: "%s" does not respond to messages over %s within %g s; from now on '
            "acknowledgements are not waited for, and missing ones count as drops when the "
            "connection ends. Connect with tcp if you can",
            self.route.source,
            self.route.target,
            self.carrier.name,
            limit,
        )

    def _look_for_acks(self) -> None:
        try:
            self.collect(wait=self.unacknowledged >= WINDOW and not self._mute)
        except YarpError:
            self.give_up()
            raise

    def collect(self, wait: bool, all_: bool = False, deadline: float | None = None) -> None:
        """Read acknowledgements: those that are there; with `wait`, until half the window is
        free."""
        target = 0 if all_ or (wait and self.unacknowledged < WINDOW) else WINDOW // 2
        driver = self.driver
        if self.gathered:
            self.flush()
        before = self.unacknowledged
        while self.unacknowledged > (target if wait else 0):
            if self._acks is None:
                found = self.carrier.parse_acks(driver.stream, self.unacknowledged)
                if found:
                    self.unacknowledged -= found
                    continue
                self._acks = self.carrier.expect_ack(driver.stream)
            try:
                next(self._acks)
            except StopIteration:
                self._acks = None
                self.unacknowledged -= 1
                continue
            if wait:
                driver.fill(deadline)
            elif not driver.try_fill():
                break
        if self.unacknowledged < before:
            self._ahead_since = time.perf_counter()
            self._ahead_from = driver.bytes_out
        if not self.unacknowledged:
            self._mute = False
        if deadline is not None:
            driver.transport.limit_waiting(None)

    def caught_up(self) -> bool:
        """Whether the reader has taken the last message, or does not acknowledge."""
        if not self.lock.acquire(blocking=False):
            return False
        try:
            self.collect(wait=False)
        except YarpError:
            self.give_up()
            return True  # sending finds out, and says so
        finally:
            self.lock.release()
        limit = self.carrier.limits.ack_timeout
        late = limit is not None and time.perf_counter() - self._ahead_since > limit
        if self.unacknowledged and late and limit is not None and not self._mute:
            self._fall_mute(limit)
        return not self.unacknowledged or self._mute

    def give_up(self) -> None:
        """The connection failed: what was never acknowledged is lost, and counted."""
        if not self.broken:
            lost = self.unacknowledged if self.carrier.acks else self.gathered
            self.counter.messages -= lost
            self.counter.drops += lost
            self.unacknowledged = self.gathered = 0
            self.end()

    def end(self) -> None:
        """Nothing is sent any more."""
        self.broken = True
        if self._sweeper is not None:
            self._sweeper.stop()
        self.driver.transport.close()


def interrupts(error: BaseException) -> bool:
    """Whether a dialogue that met `error` is left half way, such as by Ctrl-C; a value that could
    not be encoded has not begun one."""
    return isinstance(error, YarpError) or not isinstance(error, UNSENDABLE)


def seconds(timeout: float | None) -> float:
    """A time limit as locks want it."""
    return -1 if timeout is None else timeout
