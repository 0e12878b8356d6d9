"""Sender: puts the messages of a connection on the wire, and takes in its acknowledgements.

Rules: one message at a time, under `lock`. When messages follow each other without a pause, the
first leaves at once and those behind it are gathered into one send; a short timer sends what a
writer leaves behind. When a part of a message has left, its rest waits in the stream and leaves
before any other. A reader that keeps its writer waiting for longer than its `write_timeout` is cut
off.
"""

from __future__ import annotations

import threading
import time
from typing import TYPE_CHECKING, Final

from yarpy.errors import LinkClosed, Timeout, YarpError
from yarpy.link.background import GATHER_SECONDS, Sweeper
from yarpy.link.confirmation import Confirmation, Fate
from yarpy.link.counter import Counter
from yarpy.link.window import WINDOW, Window
from yarpy.link.write_timeout import ALL, NOTHING, PART, Sent, WriteTimeout
from yarpy.log import logger
from yarpy.wire.message import UNSENDABLE, Packet

if TYPE_CHECKING:
    from yarpy.carriers.base import Carrier
    from yarpy.link.driver import Driver
    from yarpy.route import Route

log = logger("yarpy.link")

# Gathering. A writer that comes back within RUSH times what a send takes on this machine, BURST
# times in a row, is flooding.
RUSH: Final = 3.0
BURST: Final = 16
LASTING: Final = 2 * GATHER_SECONDS
GATHER: Final = 64  # messages
MOMENT: Final = 0.02  # seconds
AT_A_TIME: Final = 0.1  # seconds of each wait until a reader takes more


class Sender:
    """The sending end of one connection."""

    def __init__(self, driver: Driver, carrier: Carrier, limit: float | None = None) -> None:
        self.driver = driver
        self.carrier = carrier
        self.route: Route = carrier.route
        self.counter = Counter(since=time.time())
        self.lock = threading.Lock()  # one message at a time on the wire
        self.write_timeout = WriteTimeout(limit)
        self._pause = threading.Lock()  # of `listens`, so that a ping ends before a message begins
        self.listens = False  # whoever holds `lock` has asked, and only waits for the answer
        self.broken = False
        self.reason = ""  # why we have ended it
        self.halfway = False  # the rest of a message waits in the stream
        self.window = Window(driver, carrier, self._flush_gathered)
        self.confirmation = Confirmation(mute(carrier))  # of a carrier without acknowledgements
        self._rush = 0
        # What a send takes when nothing holds it up: the least seen, in seconds. A transport that
        # sends in threads of its own says what it takes at least.
        self._least: float = getattr(driver.transport, "cost", 0.0)
        self._cost = max(12e-6, self._least)
        self._left = 0.0  # when the last send ended
        self.gathered = 0  # messages that wait in the stream for the next send
        self._gathered_since = 0.0
        self._gathered_bytes = self._pieces = 0  # of those, without acknowledgements
        self._sweeper: Sweeper | None = None

    # -- sending ----------------------------------------------------------------------------------

    def send(self, packet: Packet, deadline: float | None = None, copies: bool = False) -> Sent:
        """Send a message, or gather it, by `deadline`; how much of it has left by then.

        If that is a part, `finish` sends the rest. With `copies` it follows by itself, and the
        message may be changed. Raises LinkClosed.
        """
        if self.write_timeout.limit is None:
            if deadline is None:
                with self.lock:
                    return self._send(packet, None, copies)
            if not self._lock_by(self._patience(deadline)):
                return NOTHING
            try:
                return self._send(packet, deadline, copies)
            finally:
                self.lock.release()
        until = self.write_timeout.until(deadline)
        sent = NOTHING
        if self._lock_by(self._patience(until)):
            try:
                sent = self._send(packet, until, copies)
            finally:
                self.lock.release()
        if self.write_timeout.over(sent is ALL):
            self.counter.drops += sent is NOTHING
            raise self.cut()
        return sent

    def send_at_once(self, data: bytes) -> bool:
        """Send a message that is encoded already, over a connection without acknowledgements.

        False, and nothing has left, where something is in its way: another message, a reader that
        takes nothing just now, an error. Then `send` says what, or waits. Raises LinkClosed.
        """
        if not self.lock.acquire(blocking=False):
            return False
        try:
            driver = self.driver
            if self.broken or self.halfway or driver.stream.output:
                return False
            try:
                left = driver.transport.try_send([data])
            except OSError:
                return False
            unsent = sum(map(len, left))
            if unsent == len(data):
                return False
            driver.bytes_out += len(data) - unsent
            counter = self.counter
            counter.count(time.perf_counter())
            counter.bytes = driver.bytes_out
            self.confirmation.ends.append(driver.bytes_out + unsent)
            if not unsent:
                return True
            driver.stream.put_back(left)
            self.halfway, self.gathered = True, 1
        finally:
            self.lock.release()
        return self.finish()

    def interject(self, data: bytes) -> bool:
        """Send what is no message, between two of them or while an answer is waited for; False, and
        nothing has left, where that would take waiting."""
        if not self.lock.acquire(blocking=False):
            with self._pause:
                return self.listens and self._interject(data)
        try:
            return self._interject(data)
        finally:
            self.lock.release()

    def listen(self, whether: bool) -> None:
        """From now on the answer to a question is waited for, or not any more. The lock is held."""
        with self._pause:
            self.listens = whether

    def _interject(self, data: bytes) -> bool:
        try:
            driver = self.driver
            if self.broken or self.halfway or driver.stream.output:
                return False
            left = driver.transport.try_send([data])
            unsent = sum(map(len, left))
            if unsent == len(data):
                return False
            driver.bytes_out += len(data) - unsent
            if left:
                driver.stream.put_back(left)
                self.halfway, self.gathered = True, 1
            return True
        except OSError:
            return True  # whoever writes or looks meets the same end

    def finish(self, deadline: float | None = None) -> bool:
        """Send the rest of a message by `deadline`; whether it has left. Raises LinkClosed."""
        until = self.write_timeout.until(deadline)
        done = False
        if self._lock_by(until):
            try:
                if self.broken:
                    raise self.gone()
                done = not self.halfway or self._flush_by(until)
                self.counter.bytes = self.driver.bytes_out
            finally:
                self.lock.release()
        if self.write_timeout.over(done):
            raise self.cut()
        return done

    def flush_at_once(self) -> None:
        """Send what was written as far as it leaves without waiting; the rest follows by itself.
        The lock is held. Raises LinkClosed."""
        try:
            self.flush(0.0)
        except Timeout:
            self.driver.stream.snapshot_output()
            self._watch()

    def leave(self) -> None:
        """The writer does not come back for `finish`: what is halfway follows by itself."""
        if self.lock.acquire(blocking=False):  # else another thread is sending it
            try:
                if self.halfway:
                    self.driver.stream.snapshot_output()
                    self._watch()
            finally:
                self.lock.release()

    @property
    def busy(self) -> bool:
        """Whether another message would have to wait."""
        return self.halfway or self.lock.locked()

    def _patience(self, until: float | None) -> float | None:
        """Until when to wait for the lock. What is to be sent at once waits while another thread
        does something short, but not behind the rest of a message."""
        if until == 0.0 and self.carrier.delivery.at_once and not self.halfway:
            return time.monotonic() + MOMENT
        return until

    def _lock_by(self, until: float | None) -> bool:
        if until is None:
            return self.lock.acquire()
        if not until:
            return self.lock.acquire(blocking=False)
        return self.lock.acquire(timeout=max(0.0, until - time.monotonic()))

    def _send(self, packet: Packet, until: float | None, copies: bool) -> Sent:
        if self.broken:
            self.counter.drops += 1
            raise self.gone()
        carrier, driver, window = self.carrier, self.driver, self.window
        sent = ALL
        now = time.perf_counter()
        full = window.open and (
            now > window.until or driver.bytes_out > window.reach or window.open >= WINDOW
        )
        try:
            if (full or self.halfway) and not self._has_room(bool(full), until):
                return NOTHING  # before any work on it
            carrier.encode(driver.stream, packet)
            try:
                pause = now - self._left
                if pause > RUSH * self._cost:
                    # Who was flooding and paused for less than a burst lasts has been interrupted.
                    self._rush = BURST - 1 if self._rush == BURST and pause < LASTING else 0
                    self.flush(until)
                elif self._rush < BURST:
                    self._rush += 1
                    self.flush(until)
                elif carrier.delivery.coalesces and carrier.gathers(packet):
                    self._gather(now, until)
                else:
                    self.flush(until)
            except Timeout:
                if until is None:
                    raise
                sent = PART
                if copies:
                    driver.stream.snapshot_output()
                    self._watch()
        except BaseException as error:
            if interrupts(error):
                self.counter.drops += 1
                self.give_up()
            raise
        counter = self.counter
        counter.count(now)
        counter.bytes = driver.bytes_out
        self._left = now
        if not self.gathered:
            # How long a send takes; it seems longer when the reader runs first.
            self._left = time.perf_counter()
            if self._left - now < self._cost:
                self._cost = max(self._left - now, self._least)
        if carrier.acks:
            if window.count(now) and not self.halfway:
                self._look_for_acks(until)
                self._left = time.perf_counter()
        else:
            if self.gathered:
                size, self._pieces = driver.stream.written(self._pieces)
                self._gathered_bytes += size
            self.confirmation.ends.append(driver.bytes_out + self._gathered_bytes)
        return sent

    def _has_room(self, full: bool, until: float | None) -> bool:
        """Whether the next message may go: what is halfway has left, and acknowledgements have
        come where the window is `full`, which is waited for."""
        try:
            if self.halfway and until is not None:
                self.flush(until)
            if full:
                self.window.wait(until)
        except Timeout:
            if until is None:
                raise
            return False
        return True

    def gone(self) -> LinkClosed:
        """The error that a writer gets once the link is broken."""
        why = f": {self.reason}" if self.reason else ""
        return LinkClosed(f'the connection to "{self.route.target}" is gone{why}')

    def flush(self, until: float | None = None) -> None:
        """Send what was written, and what was gathered before it. Raises Timeout: the rest waits
        in the stream."""
        try:
            self.driver.flush(until)
        except Timeout:
            self.halfway, self.gathered = True, 1  # of those before it, some have left
            self._pieces = self._gathered_bytes = 0
            raise
        self.halfway = False
        self.gathered = self._pieces = self._gathered_bytes = 0

    def _flush_by(self, until: float | None) -> bool:
        """Whether what waits has left by then. Raises LinkClosed."""
        try:
            self.flush(until)
        except Timeout:
            if until is None:
                self.give_up()
                raise
            return False
        except BaseException:
            self.give_up()
            raise
        return True

    def _gather(self, now: float, until: float | None) -> None:
        """Coalesce: leave the message in the stream for the next send, which comes soon."""
        if not self.gathered:
            self._gathered_since = now
            self._watch()
        if self.gathered + 1 >= GATHER or now - self._gathered_since >= GATHER_SECONDS:
            self.flush(until)
        else:
            self.gathered += 1

    def _watch(self) -> None:
        """Let the sweeper send what is left in the stream."""
        if self._sweeper is None:
            self._sweeper = Sweeper(f"yarpy sweep {self.route}", self._sweep_up)
        self._sweeper.watch()

    def sweep(self, timeout: float | None = None) -> bool:
        """Send what a burst left behind; False if that takes longer than `timeout` seconds."""
        until = self.write_timeout.until(None if timeout is None else time.monotonic() + timeout)
        if not self._lock_by(until):
            return False
        try:
            done = self.broken or not self.gathered or self._flush_by(until)
        except YarpError:
            done = True  # as far as ever
        finally:
            self.lock.release()
        if self.write_timeout.over(done):
            self.cut()
        return done

    def _sweep_up(self) -> bool:
        """Sweep for the sweeper: whether the burst may still go on."""
        if self.carrier.delivery.at_once:  # no writer shall wait for the lock meanwhile
            while (self.halfway or self.gathered) and not self.broken:
                self.driver.transport.wait_writable(AT_A_TIME)
                self.sweep(0.0)
        else:
            self.sweep()
        return not self.broken and time.perf_counter() - self._left < 100 * GATHER_SECONDS

    # -- what comes back --------------------------------------------------------------------------

    def _flush_gathered(self, until: float | None) -> None:
        if self.gathered:
            self.flush(until)

    def _look_for_acks(self, until: float | None) -> None:
        try:
            self.window.look(until)
        except YarpError:
            self.give_up()
            raise

    def caught_up(self) -> bool:
        """Whether the reader has taken the last message, or does not acknowledge."""
        if not self.lock.acquire(blocking=False):
            return False
        try:
            self.window.collect(wait=False)
        except YarpError:
            self.give_up()
            return True  # sending finds out, and says so
        finally:
            self.lock.release()
        return self.window.free()

    def give_up(self) -> None:
        """The connection failed: what never left is dropped, and what may have arrived or not is
        unconfirmed."""
        if self.broken:
            return
        counter, gathered = self.counter, self.gathered
        self.gathered = 0
        counter.messages -= gathered
        counter.drops += gathered
        if self.carrier.acks:
            self._take_last_acks()
            left = max(self.window.open - gathered, 0)
            counter.messages -= left
            counter.unconfirmed += left
            self.window.open = 0
        else:
            self.confirmation.recall(gathered)
            driver = self.driver
            taken = driver.transport.taken(driver.bytes_out, driver.bytes_in)
            self._settle(self.fate if taken is None else self._end(*taken))
        self.end()

    def _take_last_acks(self) -> None:
        """Those that came before the end."""
        try:
            self.window.collect(wait=False)
        except YarpError:
            pass  # that was all

    @property
    def fate(self) -> Fate:
        """What is known to have become of the messages of a carrier without acknowledgements."""
        in_order = not self.carrier.connectionless
        return self.confirmation.fate(self.counter.messages - self.gathered, in_order)

    def _end(self, taken: int, certain: bool) -> Fate:
        return self.confirmation.end(self.counter.messages, taken, certain)

    def _settle(self, fate: Fate) -> None:
        """Count messages that nobody will tell more about."""
        counter = self.counter
        counter.messages -= fate.lost + fate.open
        counter.drops += fate.lost
        counter.unconfirmed += fate.open

    def cut(self) -> LinkClosed:
        """End the connection to a reader that does not read; the error that says so."""
        self.driver.transport.interrupt()  # frees a thread that is stuck in sending
        with self.lock:
            if not self.broken:
                limit = self.write_timeout.limit
                self.reason = f"it did not take a message within {limit:g} s"
                log.warning(
                    "%s: %s does not read, and is disconnected: %s",
                    self.route.source,
                    self.route.target,
                    self.reason,
                )
                self.give_up()
        return self.gone()

    def end(self) -> None:
        """Nothing is sent any more."""
        self.broken = True
        if self._sweeper is not None:
            self._sweeper.stop()
        if self.carrier.attentive:
            self.driver.transport.interrupt()  # wakes the thread that listens
        self.driver.transport.close()


def mute(carrier: Carrier) -> bool:
    """Whether a receiver says nothing by itself of what came, and can be asked."""
    says = carrier.acks or carrier.delivery.lossy or carrier.spelling == "object"
    return not (says or carrier.foreign)


def interrupts(error: BaseException) -> bool:
    """Whether a dialogue that met `error` is left half way, such as by Ctrl-C; a value that could
    not be encoded has not begun one."""
    return isinstance(error, YarpError) or not isinstance(error, UNSENDABLE)


def seconds(timeout: float | None) -> float:
    """A time limit as locks want it."""
    return -1 if timeout is None else timeout
