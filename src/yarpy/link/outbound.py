"""Outbound: a connection that carries a port's messages away.

Rules: sends in the caller's thread, or in its own when background writing is asked for. One lock,
held for one message at a time. Acknowledgements are read late: up to `WINDOW` messages may be on
their way unconfirmed, then a send waits. When messages follow each other without a pause, the
first leaves at once and those behind it are gathered into one send; a short timer sends what a
writer leaves behind.
"""

from __future__ import annotations

import threading
import time
from typing import TYPE_CHECKING, Any, Final

from yarpy.errors import LinkClosed, LocalProtocolError, Timeout, YarpError
from yarpy.link.background import GATHER_SECONDS, Background, Sweeper
from yarpy.link.counter import Counter
from yarpy.qos import Sched
from yarpy.transports.tcp import TcpTransport
from yarpy.wire.message import CALL, Message, Packet

if TYPE_CHECKING:
    from yarpy.carriers.base import Carrier
    from yarpy.contact import Route
    from yarpy.link.driver import Driver
    from yarpy.monitors.chain import Chain
    from yarpy.wire.effects import Steps

# How far a sender may be ahead of acknowledgements: so many messages, bytes, seconds. A slow reader
# thus holds its sender up, as it does in C++, instead of getting old data.
WINDOW: Final = 256
WINDOW_BYTES: Final = 1 << 16
WINDOW_SECONDS: Final = 0.005
ASK_EVERY: Final = 32  # messages after which acknowledgements are looked for
UNSENT: Final = 1 << 16  # bytes of a lossy connection that the kernel may hold back
LISTEN_MOST: Final = 64  # reads at a time of what a reader says
LISTEN_PATIENCE: Final = 0.1  # seconds for an answer to what a reader says while we send
CLOSE_PATIENCE: Final = 1.0  # seconds to wait for the acknowledgement of `q`

# Gathering. A writer that comes back within RUSH times what a send takes on this machine, BURST
# times in a row, is flooding.
RUSH: Final = 3.0
BURST: Final = 16
GATHER: Final = 64  # messages


class Outbound:
    """One connection out of a port. `background` links send from a thread of their own."""

    def __init__(self, driver: Driver, carrier: Carrier, dialled: bool = True) -> None:
        self.driver = driver
        self.dialled = dialled  # by us; else the reader came to us, and has to come again
        self.carrier = carrier
        self.route: Route = carrier.route
        self.counter = Counter(since=time.time())
        self.unacknowledged = 0
        self._ahead_since = 0.0
        self._ahead_from = 0
        self._due = 0.0  # when the carrier's interval is over
        self.broken = False
        self.sched = Sched()  # what somebody asked for; -1: nothing
        self.tos = 0
        self.chain: Chain | None = None  # the monitors that ride on it
        self.active = True  # of the multicast links of a port only one sends
        self.thread: threading.Thread | None = None
        self.lock = threading.Lock()  # one message at a time on the wire
        self._acks: Steps[None] | None = None
        self._listening: Steps[None] | None = None
        self._queue: Background | None = None
        self._rush = 0
        self._cost = 12e-6  # what a send takes when nothing holds it up: the least seen, in seconds
        self.left = 0.0  # when the last send ended
        self._gathered = 0  # messages that wait in the stream for the next send
        self._gathered_since = 0.0
        self._sweeper: Sweeper | None = None

    # -- sending ----------------------------------------------------------------------------------

    def send(self, packet: Packet) -> bool:
        """Send one message; False if it was dropped.

        Returns once the kernel, or the gathering of a burst, has it. Blocks while the peer is
        WINDOW acknowledgements behind; where the carrier is lossy it never blocks, and the message
        may be dropped instead. Raises LinkClosed.
        """
        if self.carrier.lossy:
            if self.broken:
                raise LinkClosed(f'the connection to "{self.route.target}" is gone')
            return self.offer(packet)
        if self.chain is not None:
            passed = self._pass(self.chain, packet)
            if passed is None:
                return False
            packet = passed
        if self._queue is not None:
            packet.own(self.carrier.spelling)  # what cannot be sent is the writer's error
            self._queue.wait_put(packet)
            return True
        with self.lock:
            self.send_now(packet)
        return True

    def offer(self, packet: Packet) -> bool:
        """Send in the background unless the previous message is still going: then drop, and
        count."""
        if self._queue is None:
            self.start_background()
        if self.unacknowledged and not self._caught_up():
            self.counter.drops += 1
            return False
        queue, carrier = self._queue, self.carrier
        assert queue is not None
        if carrier.lossy and not (queue.has_room(carrier.backlog) and self._timely()):
            self.counter.drops += 1  # before anything is made of a message that does not go
            return False
        if self.chain is not None:
            passed = self._pass(self.chain, packet)
            if passed is None:
                return False
            packet = passed
        if not carrier.prepare(packet):
            self.counter.drops += 1
            return False
        return queue.put(packet, carrier.backlog)

    def _pass(self, chain: Chain, packet: Packet) -> Packet | None:
        """What the monitors make of a packet; None, and counted, if one drops it."""
        passed = chain.send(packet)
        if passed is None:
            self.counter.drops += 1
        return passed

    def _timely(self) -> bool:
        """Whether the carrier's interval is over. On the average, so that no beat is missed."""
        now = time.perf_counter()
        if now < self._due:
            return False
        self._due = max(self._due + self.carrier.interval, now)
        return True

    def _caught_up(self) -> bool:
        """Whether the reader has taken the last message."""
        if not self.lock.acquire(blocking=False):
            return False
        try:
            self._collect(wait=False)
        except YarpError:
            self._break()
            return True  # sending finds out, and says so
        finally:
            self.lock.release()
        return not self.unacknowledged

    def send_now(self, packet: Packet) -> None:
        if self.broken:
            self.counter.drops += 1
            raise LinkClosed(f'the connection to "{self.route.target}" is gone')
        carrier, driver = self.carrier, self.driver
        now = time.perf_counter()
        try:
            if self.unacknowledged and (
                now - self._ahead_since > WINDOW_SECONDS
                or driver.bytes_out - self._ahead_from > WINDOW_BYTES
            ):
                self._collect(wait=True, all_=True)
            carrier.encode(driver.stream, packet)
            if now - self.left > RUSH * self._cost:
                self._rush = 0
                self._flush_at_once(now)
            elif self._rush < BURST:
                self._rush += 1
                self._flush_at_once(now)
            elif carrier.gathers and packet.small:
                self._gather(now)
            else:
                self._flush()
        except YarpError:
            self.counter.drops += 1
            self._break()
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
        self.left = time.perf_counter()

    def _look_for_acks(self) -> None:
        try:
            self._collect(wait=self.unacknowledged >= WINDOW)
        except YarpError:
            self._break()
            raise

    def _flush(self) -> None:
        self.driver.flush()
        self._gathered = 0

    def _flush_at_once(self, now: float) -> None:
        """Send, and learn what that takes; often it seems more, when the reader runs first."""
        self._flush()
        self._cost = min(self._cost, time.perf_counter() - now)

    def _gather(self, now: float) -> None:
        """Leave the message in the stream for the next send of many, which comes soon."""
        if not self._gathered:
            self._gathered_since = now
            if self._sweeper is None:
                self._sweeper = Sweeper(self)
            self._sweeper.watch()
        if self._gathered + 1 >= GATHER or now - self._gathered_since >= GATHER_SECONDS:
            self._flush()
        else:
            self._gathered += 1

    def sweep(self, timeout: float | None = None) -> bool:
        """Send what a burst left behind; False if somebody is stuck in sending for `timeout`
        seconds."""
        if not self.lock.acquire(timeout=_seconds(timeout)):
            return False
        try:
            if self._gathered and not self.broken:
                self._flush()
        except YarpError:
            self._break()
        finally:
            self.lock.release()
        return True

    def start_background(self) -> None:
        """Give the link a thread that sends; `send` and `offer` then only hand over."""
        with self.lock:
            if self._queue is None and not self.broken:
                transport = self.driver.transport
                if self.carrier.lossy and isinstance(transport, TcpTransport):
                    transport.limit_unsent(UNSENT)  # else the kernel is the growing queue
                self._queue = Background(self)
                self.thread = threading.Thread(
                    target=self._queue.run, name=f"yarpy {self.route}", daemon=True
                )
                self.thread.start()

    def drain(self, timeout: float | None = None) -> bool:
        """Wait until everything handed over was sent; False if `timeout` seconds were not
        enough."""
        done = self._queue.wait_empty(timeout) if self._queue is not None else True
        return done and self.sweep(timeout)

    # -- what comes back --------------------------------------------------------------------------

    def call(self, packet: Packet, timeout: float | None = None) -> Message | None:
        """Send a question and wait for its reply; None if the peer has none to give.

        Raises Timeout (the link is then closed: a late reply must not answer the next question).
        """
        if not self.carrier.replies:
            raise LocalProtocolError(
                f'"{self.carrier.name}" carries no replies; connect to '
                f'"{self.route.target}" with tcp'
            )
        assert packet.key == CALL or packet.key == "a"
        chain = self.chain if packet.key == CALL else None
        if chain is not None:
            passed = self._pass(chain, packet)
            if passed is None:
                return None
            packet = passed
        deadline = None if timeout is None else time.monotonic() + timeout
        self._take_turn(timeout)
        try:
            started = time.perf_counter()
            driver = self.driver
            try:
                self._collect(wait=True, deadline=deadline)
                self.carrier.encode(driver.stream, packet)
                self._flush()
                reply = driver.run(self.carrier.expect_reply(driver.stream), deadline)
                if self.carrier.acks:
                    driver.run(self.carrier.expect_ack(driver.stream), deadline)
            except Timeout:
                self._break()
                raise Timeout(
                    f'"{self.route.target}" did not reply within {timeout} s; is its program stuck?'
                ) from None
            except YarpError:
                self._break()
                raise
            now = time.perf_counter()
            self.counter.count(now)
            self.counter.bytes = driver.bytes_out
            self.counter.measure(now - started)
            if reply is None:
                return None
            reply.source = self.route.target
            return reply if chain is None else chain.reply(reply)
        finally:
            self.lock.release()

    def _take_turn(self, timeout: float | None) -> None:
        """Take the lock once nothing waits to be sent. Raises Timeout, LinkClosed."""
        if not (self.drain(timeout) and self.lock.acquire(timeout=_seconds(timeout))):
            raise Timeout(f'"{self.route.target}" did not take earlier messages within {timeout} s')
        if self.broken:
            self.lock.release()
            raise LinkClosed(f'the connection to "{self.route.target}" is gone')

    def wait_acknowledged(self, timeout: float | None = None) -> None:
        """Wait until the peer has taken every message, unless it may miss some. Raises Timeout,
        LinkClosed."""
        if self.carrier.lossy:
            return
        deadline = None if timeout is None else time.monotonic() + timeout
        self._take_turn(timeout)
        try:
            self._collect(wait=True, all_=True, deadline=deadline)
        except Timeout:
            raise
        except YarpError:
            self._break()
            raise
        finally:
            self.lock.release()

    def _collect(self, wait: bool, all_: bool = False, deadline: float | None = None) -> None:
        """Read acknowledgements: those that are there; with `wait`, until half the window is
        free."""
        target = 0 if all_ or (wait and self.unacknowledged < WINDOW) else WINDOW // 2
        driver = self.driver
        if self._gathered:
            self._flush()
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
        if deadline is not None:
            driver.transport.limit_waiting(None)

    # -- ending -----------------------------------------------------------------------------------

    def _break(self) -> None:
        """The connection failed: what was never acknowledged is lost, and counted."""
        if not self.broken:
            self.broken = True
            lost = self.unacknowledged if self.carrier.acks else self._gathered
            self.counter.messages -= lost
            self.counter.drops += lost
            self.unacknowledged = self._gathered = 0
            self.driver.transport.close()

    def ended(self) -> bool:
        """Whether the peer has hung up, found out without sending anything."""
        if self.unacknowledged:
            self._caught_up()  # acknowledgements that nobody read hide the end behind them
        if self.carrier.listens:
            self._listen()
        if not self.broken and self.driver.transport.ended():
            self.driver.transport.interrupt()  # frees who is stuck in sending
            with self.lock:
                self._break()
        return self.broken

    def _listen(self) -> None:
        """Let the protocol deal with what the reader said meanwhile."""
        if not self.lock.acquire(blocking=False):
            return  # next time
        try:
            if self.broken:
                return
            driver = self.driver
            if self._listening is None:
                self._listening = self.carrier.listen(driver.stream)
                next(self._listening)
            for _ in range(LISTEN_MOST):
                if not driver.try_fill():
                    break
                next(self._listening)
            driver.transport.limit_waiting(LISTEN_PATIENCE)
            driver.flush()
            driver.transport.limit_waiting(None)
        except (StopIteration, YarpError):
            self._say_last_words()
            self._break()
        finally:
            self.lock.release()

    def _say_last_words(self) -> None:
        try:
            self.driver.transport.limit_waiting(LISTEN_PATIENCE)
            self.driver.flush()
        except YarpError:
            pass  # nobody is there to hear them

    def close(self, quit_: bool = True) -> None:
        """End the connection: say `q`, wait a moment for its acknowledgement, hang up."""
        if not self.drain(CLOSE_PATIENCE):
            self.driver.transport.interrupt()  # nothing is taken: free who is stuck in sending
        if self._queue is not None:
            self._queue.stop()
        with self.lock:
            if self.broken:
                return
            driver = self.driver
            try:
                if quit_:
                    self.carrier.encode_quit(driver.stream)
                    deadline = time.monotonic() + CLOSE_PATIENCE
                    driver.flush()
                    if self.carrier.acks:
                        self.unacknowledged += 1
                        self._collect(wait=True, all_=True, deadline=deadline)
                    else:
                        driver.run(self.carrier.hear_out(driver.stream), deadline)
            except (YarpError, OSError):
                lost = max(self.unacknowledged - 1, 0)
                self.counter.messages -= lost
                self.counter.drops += lost
            self.broken = True
            driver.transport.close()

    def snapshot(self) -> dict[str, Any]:
        """Counters as plain numbers."""
        return {**self.counter.as_dict(), "unacknowledged": self.unacknowledged}


def _seconds(timeout: float | None) -> float:
    """A time limit as locks want it."""
    return -1 if timeout is None else timeout
