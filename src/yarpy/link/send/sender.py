"""Sender: puts the messages of a connection on the wire, and takes in its acknowledgements.

Rules: one message at a time, under `lock`: an RLock, so that a signal handler can see that the
frame beneath it is at work. When messages follow each other without a pause, the first leaves at
once and those behind it are gathered into one send; so is the first if its writer says that `more`
follow. A short timer sends what a writer leaves behind. When a part of a message has left, its rest
waits in the stream and leaves before any other. Whatever interrupts a message on its way (Ctrl-C)
ends the connection, and is counted. Time limits are those of `link/ending.py`.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from enum import Enum, auto
from typing import TYPE_CHECKING, Any, Final

from yarpy.errors import LinkClosed, YarpError
from yarpy.link.counter import Counter
from yarpy.link.ending import NEVER, NOW, Ending
from yarpy.link.send.confirmation import Confirmation, Outcome
from yarpy.link.send.flusher import GATHER_SECONDS, Flusher
from yarpy.link.send.slow_reader import SlowReader
from yarpy.link.send.window import ASK_EVERY, Window
from yarpy.wire.message import Packet, is_unsent

if TYPE_CHECKING:
    from yarpy.carriers.base import Carrier
    from yarpy.link.driver import Driver
    from yarpy.monitors.chain import Chain
    from yarpy.route import Route

# Gathering. A writer that comes back within RUSH times what a send takes on this machine, BURST
# times in a row, is flooding. Who waits for an answer from the same machine takes little longer.
RUSH: Final = 2.0
BURST: Final = 16
LASTING: Final = 2 * GATHER_SECONDS
GATHER: Final = 64  # messages
AT_A_TIME: Final = 0.1  # seconds of each wait until a reader takes more
LETTING_GO: Final = 0.3  # seconds for whoever is at work on a connection to meet its end


class Sent(Enum):
    """The part of a message that has left, or is about to."""

    NOTHING = auto()
    PART = auto()  # the rest has to follow before anything else
    ALL = auto()


# Looking a member up in its class takes a while.
NOTHING: Final = Sent.NOTHING
PART: Final = Sent.PART
ALL: Final = Sent.ALL


class Sender:
    """The sending end of one connection."""

    def __init__(self, driver: Driver, carrier: Carrier, limit: float | None = None) -> None:
        self.driver = driver
        self._pushes = driver.pushes
        self.carrier = carrier
        self.route: Route = carrier.route
        self.counter = Counter(since=time.time())
        #: the reader may be of YARP 4; a group of them may be of both, which `Outputs` knows
        self.respells = carrier.spelling == "binary" and not carrier.delivery.broadcast
        self.chain: Chain | None = None  # the monitors that ride on it
        self.late = 0  # messages that were not sent since their deadline had come
        lock: Any = threading.RLock()
        self.lock = lock  # one message at a time on the wire
        self.held: Callable[[], bool] = lock._is_owned  # by this thread; see `ending`
        self.ending: Ending = NEVER  # of the port; what nobody waits for in person sets NEVER
        self.slow = SlowReader(carrier.route, limit)
        self._pause = threading.Lock()  # of `listens`, so that a ping ends before a message begins
        self.listens = False  # whoever holds `lock` has asked, and only waits for the answer
        self.asking = False  # a question is on its way, whose answer is waited for
        self.broken = False
        self._judged = False  # what was under way has been counted, since it ends
        self.reason = ""  # why we have ended it
        self.halfway = False  # the rest of a message waits in the stream
        self.window = Window(driver, carrier, self._flush_gathered, self.flush)
        self.confirmation = Confirmation(mute(carrier))  # of a carrier without acknowledgements
        self.more = False  # its writer says that others follow the next message at once
        self._rush = 0
        # What a send takes when nothing holds it up: the least seen, in seconds. A transport that
        # sends in threads of its own says what it takes at least.
        self._least = driver.transport.cost
        self._cost = max(12e-6, self._least)
        self._left = 0.0  # when the last send ended
        self.gathered = 0  # messages that wait in the stream for the next send
        self._leaving = False  # they are being sent, or were when a signal handler raised
        self._gathered_since = 0.0
        self._gathered_bytes = self._pieces = 0  # of those, without acknowledgements
        self._flusher: Flusher | None = None
        self.draining = False  # it is at work, and may have the lock

    def obey(self, ending: Ending) -> None:
        """From now on whoever waits here goes on, or not, as the port's `ending` says."""
        self.ending = self.driver.ending = ending

    # -- sending ----------------------------------------------------------------------------------

    def transmit(self, packet: Packet, until: float | None) -> Sent:
        """Send a message, or gather it, by `until`; return how much of it has left. The lock is
        held.

        If that is a part, `finish` sends the rest, or `leave` lets it follow by itself. Raises
        LinkClosed, and what the carrier raises for a value that it cannot encode.
        """
        counter = self.counter
        if self.broken:
            counter.drops += 1
            raise self.gone()
        carrier, driver, window = self.carrier, self.driver, self.window
        counted, sent = False, ALL
        gathered, gone = self.gathered, driver.bytes_out  # before this message
        now = time.perf_counter()
        full = window.open and (
            now > window.until or driver.bytes_out > window.reach or window.open >= window.size
        )
        try:
            if (full or self.halfway) and not self._make_room(bool(full), until):
                return NOTHING  # before any work on it
            gathered, gone = self.gathered, driver.bytes_out
            if self.route.yarp4 and self.respells:
                packet = packet.newest
            carrier.encode(driver.stream, packet)
            pause = now - self._left
            if pause > RUSH * self._cost and not self.more:
                # Who was flooding and paused for less than a burst lasts has been interrupted.
                self._rush = BURST - 1 if self._rush == BURST and pause < LASTING else 0
                pushed = self._pushes and not self.gathered and driver.push()
                left = pushed or self.flush(until)
            elif self._rush < BURST and not self.more:
                self._rush += 1
                pushed = self._pushes and not self.gathered and driver.push()
                left = pushed or self.flush(until)
            elif carrier.delivery.coalesces and carrier.gathers(packet):
                left = self._gather(now, until)
            else:
                left = self.flush(until)
            counter.bytes = driver.bytes_out
            if not left:
                sent = PART
            if not carrier.acks:
                if self.gathered:
                    size, self._pieces = driver.stream.written(self._pieces)
                    self._gathered_bytes += size
                self.confirmation.ends.append(driver.bytes_out + self._gathered_bytes)
            # In one step for signals, as in `give_up`: what ends the connection finds the message
            # in all of the books or in none.
            counted = True
            if self._judged:  # by a signal handler above us, which has counted what it knew of
                counter.unconfirmed += 1
            else:
                counter.messages += 1
                window.open += carrier.acks
            counter.count(now, 0)
            self._left = now
            if not self.gathered:
                # How long a send takes; it seems longer when the reader runs first.
                self._left = time.perf_counter()
                if self._left - now < self._cost:
                    self._cost = max(self._left - now, self._least)
            if (
                carrier.acks
                and (window.open == 1 or window.open % ASK_EVERY == 0 or driver.aside)
                and window.note(now)
                and not (self.halfway or self.broken)
            ):
                if window.open >= window.size:
                    self.wait(window.look, until)
                else:
                    window.look(until)
                self._left = time.perf_counter()
        except BaseException as error:
            if interrupts(error):
                if not counted:
                    whole = self._leaving or driver.bytes_out > gone
                    if whole and not isinstance(error, YarpError):  # which says that it did not go
                        counter.unconfirmed += 1
                    else:
                        counter.drops += 1
                        self.gathered = min(self.gathered, gathered)  # it is none of those
                self.give_up()
            raise
        return sent

    def _make_room(self, full: bool, until: float | None) -> bool:
        """Wait until the next message may go: what is halfway has left, and acknowledgements have
        come where the window is `full`. Return False if `until` comes first."""
        if self.halfway and not self.flush(until):
            return False
        return not full or self.wait(self.window.wait, until)

    def flush(self, until: float | None = None) -> bool:
        """Send what was written, and what was gathered before it; False if `until` comes first: the
        rest waits in the stream. The lock is held. Raises LinkClosed."""
        driver = self.driver
        self._leaving = True
        try:
            sent = (self._pushes and driver.push()) or driver.send(NOW)
        except YarpError:  # nothing has left, nor will it
            self._leaving = False
            raise
        if not sent and until != NOW:
            sent = self.wait(driver.send, until)
        self.counter.bytes = driver.bytes_out
        self.halfway = not sent
        self.gathered = 0 if sent else 1  # of those before it, some have left
        self._pieces = self._gathered_bytes = 0
        self._leaving = False
        return sent

    def wait(self, act: Callable[[float | None], bool], until: float | None) -> bool:
        """Do what takes the reader's part in it, by `until`. The log says if it takes long."""
        soon = self.slow.warning(until)
        if soon:
            if act(soon):
                return True
            if self.ending.slice(until):
                self.slow.warn()
        if act(until):
            self.slow.took()
            return True
        return False

    def finish(self, until: float | None) -> bool:
        """Send the rest of a message by `until`; return whether it has left. Raises LinkClosed."""
        hold = Hold(self, self.slow.limit_of(until))
        try:
            hold.take()
            done = False
            if hold.held:
                if self.broken:
                    raise self.gone()
                done = not self.halfway or self._flush(hold.until)
        finally:
            hold.give()
        if self.slow.over(done):
            raise self.cut()
        return done

    def _flush(self, until: float | None) -> bool:
        """As `flush`; whatever goes wrong ends the connection."""
        try:
            return self.flush(until)
        except BaseException:
            self.give_up()
            raise

    def leave(self) -> None:
        """The writer does not come back for `finish`: what is halfway follows by itself."""
        hold = Hold(self, NOW)
        try:
            hold.take()
            if hold.held:  # else another thread is sending it
                self.follow()
        finally:
            hold.give()

    def follow(self) -> None:
        """Let what is halfway follow by itself. The lock is held."""
        if self.halfway:
            self.driver.stream.snapshot_output()
            self._watch()

    def send_whole(self, data: bytes, ends: Sequence[int] = ()) -> bool:
        """Send a message that is encoded already, over a connection without acknowledgements; or
        several, which have these `ends` in it.

        False, and nothing has left, where something is in its way: another message, a reader that
        takes nothing just now, an error. Then `transmit` says what, or waits. What has begun
        follows by itself. Raises LinkClosed.
        """
        hold = Hold(self, NOW)
        try:
            hold.take()
            driver, counter = self.driver, self.counter
            if not hold.held or self.broken or self.halfway or driver.stream.output:
                return False
            unsent = self._begin(data)
            if unsent == len(data):
                return False
            start, ends = driver.bytes_out + unsent - len(data), ends or (len(data),)
            self.confirmation.ends.extend([start + end for end in ends])
            if self._judged:  # as in `transmit`
                counter.unconfirmed += len(ends)
            else:
                counter.messages += len(ends)
            counter.count(time.perf_counter(), 0, len(ends))
            if unsent:
                self._watch()
            return True
        finally:
            hold.give()

    def _begin(self, data: bytes) -> int:
        """Send bytes that are nobody else's to change, as far as they leave without waiting; return
        how many do not. All: nothing was done."""
        driver = self.driver
        try:
            left = driver.transport.try_send([data])
        except OSError:
            return len(data)  # whoever writes or looks meets the same end
        unsent = sum(map(len, left))
        if unsent < len(data):
            driver.bytes_out += len(data) - unsent
            self.counter.bytes = driver.bytes_out
            if left:
                driver.stream.put_back(left)
                self.halfway, self.gathered = True, 1
        return unsent

    def interject(self, data: bytes) -> bool:
        """Send what is no message, between two of them or while an answer is waited for; False, and
        nothing has left, where that would take waiting."""
        hold = Hold(self, NOW)
        try:
            hold.take()
            if hold.held:
                return self._interject(data)
        finally:
            hold.give()
        with self._pause:
            return self.listens and self._interject(data)

    def listen(self, whether: bool) -> None:
        """From now on the answer to a question is waited for, or not any more. The lock is held."""
        with self._pause:
            self.listens = whether

    def _interject(self, data: bytes) -> bool:
        if self.broken or self.halfway or self.driver.stream.output:
            return False
        return self._begin(data) < len(data)

    def _gather(self, now: float, until: float | None) -> bool:
        """Coalesce: leave the message in the stream for the next send, which comes soon."""
        if not self.gathered:
            self._gathered_since = now
            self._watch()
        late = now - self._gathered_since >= GATHER_SECONDS and not self.more
        if late or self.gathered + 1 >= GATHER:
            return self.flush(until)
        self.gathered += 1
        return True

    def _flush_gathered(self, until: float | None) -> bool:
        return not self.gathered or self.flush(until)

    # -- what others leave behind -----------------------------------------------------------------

    def _watch(self) -> None:
        """Let the flusher send what is left in the stream."""
        if self._flusher is None:
            self._flusher = Flusher(f"yarpy flush {self.route}", self._drain_all)
        if self.broken:  # a signal handler has ended the connection meanwhile
            self._flusher.stop()
        else:
            self._flusher.watch()

    def drain(self, until: float | None = None, ending: Ending = NEVER) -> bool:
        """Send what a burst left behind; return False if `until` comes first."""
        hold = Hold(self, self.slow.limit_of(until), ending)
        try:
            hold.take()
            try:
                done = hold.held and (self.broken or not self.gathered or self._flush(hold.until))
            except YarpError:
                done = True  # as far as ever
        finally:
            hold.give()
        if self.slow.over(done):
            self.cut()
        return done

    def _drain_all(self) -> bool:
        """Drain for the flusher: whether the burst may still go on. The lock is held for moments:
        writers have limits of their own."""
        while (self.halfway or self.gathered) and not self.broken:
            self.draining = True
            done = self.drain(NOW)
            self.draining = False
            if done:
                break
            if self.halfway:
                self.driver.transport.wait_writable(AT_A_TIME)
            else:
                time.sleep(GATHER_SECONDS)  # another thread is sending, and needs the processor
        return not self.broken and time.perf_counter() - self._gathered_since < 100 * GATHER_SECONDS

    # -- what comes back --------------------------------------------------------------------------

    @property
    def floods(self) -> bool:
        """Return whether its writer comes back without a pause."""
        return self._rush == BURST

    def keeps_up(self) -> bool:
        """Return whether the reader has taken what was sent, or will at once, or does not
        acknowledge. The lock is held."""
        try:
            self.window.collect(wait=False)
        except YarpError:
            self.give_up()
            return True  # sending finds out, and says so
        return self.window.free(self._left)

    def look(self) -> None:
        """Take in acknowledgements that have come, unless somebody is sending."""
        hold = Hold(self, NOW)
        try:
            hold.take()
            if hold.held:
                self.keeps_up()
        finally:
            hold.give()

    # -- the end ----------------------------------------------------------------------------------

    def gone(self) -> LinkClosed:
        """Return the error that a writer gets once the link is broken."""
        why = f": {self.reason}" if self.reason else ""
        return LinkClosed(f'the connection to "{self.route.target}" is gone{why}')

    def give_up(self, at_rest: bool = True) -> None:
        """The connection failed: what never left is dropped, and what may have arrived or not is
        unconfirmed. `at_rest`: nobody is sending, in another thread or the frame beneath."""
        if self.broken:
            return
        if not self._judged:
            self._judge(self.gathered if at_rest and not self._leaving else 0)
        self.end()

    def _judge(self, never_left: int) -> None:
        """Count what is known of the messages under way, of which the last ones never left."""
        counter, window = self.counter, self.window
        self.gathered = 0  # else looking for acknowledgements would send them now
        if self.carrier.acks:
            self._take_last_acks()
            outcome = Outcome(0, 0, max(window.open - never_left, 0))
        else:
            self.confirmation.recall(never_left)
            driver, left = self.driver, counter.messages - never_left
            taken = driver.transport.taken(driver.bytes_out, driver.bytes_in)
            outcome = (
                self._outcome(left) if taken is None else self.confirmation.end(left, taken[0])
            )
        # In one step for signals: nothing is counted twice.
        self._judged = True
        window.open = 0
        counter.messages -= never_left + outcome.lost + outcome.open
        counter.drops += never_left + outcome.lost
        counter.unconfirmed += outcome.open

    def _take_last_acks(self) -> None:
        """Those that came before the end, unless another thread reads them."""
        hold = Hold(self, NOW)
        try:
            if self.held() or hold.take():
                self.window.collect(wait=False)
        except (YarpError, ValueError):
            pass  # that was all, or the frame beneath a signal handler is reading them
        finally:
            hold.give()

    @property
    def outcome(self) -> Outcome:
        """Return the known outcome of the messages of a carrier without acknowledgements."""
        return self._outcome(self.counter.messages - self.gathered)

    def _outcome(self, left: int) -> Outcome:
        in_order = not self.carrier.delivery.connectionless
        return self.confirmation.outcome(left, in_order)

    def cut(self) -> LinkClosed:
        """End the connection to a reader that does not read; return the error that says so."""
        if not self.broken:
            self.reason = self.slow.disconnect()
        self.fail()
        return self.gone()

    def fail(self) -> None:
        """End the connection now, whoever is at work on it. Any thread, and signal handlers."""
        self.driver.transport.interrupt()  # frees a thread that is stuck in sending
        hold = Hold(self, time.monotonic() + LETTING_GO, NEVER)
        try:
            hold.take()
            if hold.held:
                self.give_up()
            # else the frame beneath, which is at work under the lock, meets the end and counts it
        finally:
            hold.give()

    def end(self) -> None:
        """Nothing is sent any more."""
        self.broken = True
        if self._flusher is not None:
            self._flusher.stop()
        if self.carrier.delivery.attentive:
            self.driver.transport.interrupt()  # wakes the thread that listens
        self.driver.transport.close()


class Hold:
    """The sender's lock for a while, if it is to be had by `until`: `held`. It is not where the
    frame beneath this one, as of a signal handler, holds it. `ending`: who may end the waits
    meanwhile, by default the port; whoever takes the lock says so to the driver.

        hold = Hold(sender, until)
        try:
            hold.take()
            ...
        finally:
            hold.give()

    A signal handler may raise where Python code begins, as that of an `__exit__`, which would then
    not give the lock back. `give` is a function of the interpreter.
    """

    __slots__ = ("_ending", "_sender", "give", "held", "until")

    def __init__(self, sender: Sender, until: float | None, ending: Ending | None = None) -> None:
        self._sender = sender
        self._ending = sender.ending if ending is None else ending
        self.until = until
        self.held = False
        self.give: Callable[[], object] = _nothing

    def take(self) -> bool:
        """Take the lock; return whether it is `held` now."""
        sender = self._sender
        if sender.held():
            return False
        self.give = sender.lock.release
        try:
            if self._ending.acquire(sender.lock, self.until):
                self.held, sender.driver.ending = True, self._ending
            else:
                self.give = _nothing
        except BaseException:
            if not sender.held():
                self.give = _nothing
            raise
        return self.held


def _nothing() -> None:
    """Give back a lock that was not to be had."""


def mute(carrier: Carrier) -> bool:
    """Return whether a receiver says nothing by itself of what came, and can be asked."""
    says = carrier.acks or carrier.delivery.lossy or carrier.spelling == "object"
    return not (says or carrier.reaches.foreign)


def interrupts(error: BaseException) -> bool:
    """Return whether a dialogue that met `error` is left half way, such as by Ctrl-C; a value that
    could not be encoded has not begun one, whatever its own methods raised."""
    if isinstance(error, YarpError) or not isinstance(error, Exception):
        return True
    return not is_unsent(error)
