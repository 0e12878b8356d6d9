"""Outbound: a connection that carries a port's messages away.

Rules: sends in the caller's thread, or in its own when background writing is asked for. A question
waits until every message before it was acknowledged, and for its reply.
"""

from __future__ import annotations

import threading
import time
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from yarpy.errors import LocalProtocolError, Timeout, YarpError
from yarpy.link.background import Background
from yarpy.link.following import Following
from yarpy.link.intake import Intake
from yarpy.link.listener import Listener
from yarpy.link.sender import Sender, interrupts, seconds
from yarpy.link.timing import Dated, expected, time_left
from yarpy.link.write_timeout import ALL, NOTHING, PART, STRANGERS
from yarpy.log import logger
from yarpy.qos import NOTHING_ASKED, Qos, Sched, schedule
from yarpy.transports.tcp import TcpTransport
from yarpy.wire.message import CALL, Message, Packet

if TYPE_CHECKING:
    from yarpy.carriers.base import Carrier
    from yarpy.link.counter import Counter
    from yarpy.link.driver import Driver
    from yarpy.monitors.chain import Chain
    from yarpy.route import Route

log = logger("yarpy.link")

UNSENT: Final = 1 << 16  # bytes of a lossy connection that the kernel may buffer
CLOSE_PATIENCE: Final = 1.0  # seconds to wait for the acknowledgement of `q`


class Rest(NamedTuple):
    """What is left to do for a message: all of it, or (None) its second part."""

    packet: Packet | None
    passed: bool = False  # the monitors have seen it
    due: float | None = None  # when it is too late (time.monotonic)


class Outbound:
    """One connection out of a port."""

    def __init__(self, driver: Driver, carrier: Carrier, dialled: bool = True) -> None:
        self.driver = driver
        self.carrier = carrier
        self.route: Route = carrier.route
        self.sender = Sender(driver, carrier, None if dialled else STRANGERS)
        self.counter: Counter = self.sender.counter
        self.intake = Intake(  # of a reply
            carrier.limits.message_timeout,
            lambda: driver.transport.interrupt(),
            lambda: driver.stream.forget(),
        )
        self.dialled = dialled  # by us; else the reader dialled us, and has to dial again
        self.sched = Sched()  # as requested; -1: nothing was
        self.tos = 0
        self.asked = NOTHING_ASKED  # priorities, granted or not
        self.chain: Chain | None = None  # the monitors that ride on it
        self.log = carrier.route.spec.log is not None  # gets what the port receives, not writes
        self.active = True  # of the multicast links of a port only one sends
        self.thread: threading.Thread | None = None
        self.wanted: Qos | None = None  # when messages should come
        self.limit: float | None = None  # seconds after which a message is not sent any more
        self.late = 0  # messages that were not sent for that
        self._due = 0.0  # when the carrier's interval is over
        steps = carrier.listen(driver.stream)
        self._listener = None if steps is None else Listener(self.sender, steps)
        self._queue: Background[Any] | None = None
        self._follow: Following | None = None
        self._decide()

    def _decide(self) -> None:
        """What `send` may pass straight on: as nearly always, there is nothing else to look at."""
        self._plain = (
            self.chain is None
            and self._queue is None
            and self.limit is None
            and not self.carrier.delivery.lossy
        )

    def ride(self, chain: Chain | None) -> None:
        """Monitors get to see its messages. Raises LocalProtocolError for one that wants to know
        when they are confirmed, over a carrier that cannot tell."""
        self.chain = chain
        if chain is not None and chain.watches:
            self._follow = Following(self.sender, chain, self._send_queued)
            self.start_background()
            chain.watch(lambda: 0 if self._queue is None else self._queue.pending)
        self._decide()

    @property
    def broken(self) -> bool:
        """Whether it has failed, or was closed."""
        return self.sender.broken

    @property
    def reason(self) -> str:
        """Why it has ended."""
        return self.sender.reason or "the peer hung up"

    # -- sending ----------------------------------------------------------------------------------

    def send(self, packet: Packet, deadline: float | None = None, passed: bool = False) -> bool:
        """Send one message; False if it was dropped.

        Returns once the kernel, or the gathering of a burst, has it. Blocks while the peer is
        WINDOW acknowledgements behind; where the carrier is lossy it never blocks, and the message
        may be dropped instead, as it is where it has not begun to leave by `deadline` (of
        time.monotonic). What has, follows by itself. `passed`: monitors have seen it. Raises
        LinkClosed.
        """
        if self._plain and deadline is None:
            self.sender.send(packet)
            return True
        due = None
        if self.limit is not None:
            due = time.monotonic() + time_left(packet, self.limit)
            if not self._is_in_time(due):
                return False
            deadline = due if deadline is None else min(deadline, due)
        if self.carrier.delivery.lossy:
            if self.sender.broken:
                raise self.sender.gone()
            if self.carrier.delivery.at_once:
                return self._send_at_once(packet)
            return self.try_send(packet)
        if self.chain is not None and not passed:
            seen = self._pass(self.chain, packet)
            if seen is None:
                return False
            packet = seen
        if self._queue is not None:
            if not self.carrier.prepare(packet):  # what cannot be sent is the writer's error
                self.counter.drops += 1
                return False
            if self._queue.wait_put(self._dated(packet), deadline):
                return True
            if self._queue.stopped:
                raise self.sender.gone()
            self.late += due is not None
            return False
        if deadline is None:
            self.sender.send(packet)
        elif self.sender.send(packet, deadline, copies=True) is NOTHING:
            self.late += due is not None
            self.counter.drops += 1
            return False
        return True

    def send_at_once(self, data: bytes) -> bool:
        """Send a message that is encoded already; False, and nothing is done, where `send` has more
        to do than that. Raises LinkClosed."""
        simple = self.chain is None and self._queue is None and not self.carrier.acks
        return simple and self.sender.send_at_once(data)

    def begin(self, rest: Rest, copies: bool = False) -> bool | Rest:
        """As `send`, without waiting: what is left to do, if that takes waiting.

        With `copies`, a message of which a part has left follows by itself.
        """
        packet, passed, due = rest
        if packet is None:
            return self.sender.finish(0.0) or rest
        if self.limit is not None:
            if due is None:
                due = time.monotonic() + time_left(packet, self.limit)
                rest = Rest(packet, passed, due)
            if not self._is_in_time(due):
                return False
        if self.carrier.delivery.lossy:
            return self.send(packet)
        if self._queue is not None:
            return self.send(packet, passed=passed) if self._queue.has_room(1) else rest
        if self.chain is not None and not passed:
            if self.sender.busy:
                return rest
            seen = self._pass(self.chain, packet)
            if seen is None:
                return False
            packet = seen
        sent = self.sender.send(packet, 0.0, copies)
        if sent is ALL or (copies and sent is PART):
            return True
        return Rest(packet if sent is NOTHING else None, passed=True, due=due)

    def finish(self, rest: Rest, deadline: float | None = None) -> bool:
        """Do what `begin` left to do; as `send`."""
        if rest.packet is not None:
            if rest.due is not None:
                deadline = rest.due if deadline is None else min(deadline, rest.due)
            return self.send(rest.packet, deadline, rest.passed)
        self.sender.finish(deadline)
        return True

    def try_send(self, packet: Packet) -> bool:
        """Send in the background unless the previous message is still going: then drop, and
        count."""
        if self._queue is None:
            self.start_background()
        if self.sender.window.open and not self.sender.caught_up():
            self.counter.drops += 1
            return False
        queue, carrier, delivery = self._queue, self.carrier, self.carrier.delivery
        assert queue is not None
        if self.limit is not None and not self._is_in_time(
            time.monotonic() + time_left(packet, self.limit)
        ):
            return False
        if not queue.has_room(delivery.backlog) or (delivery.lossy and not self._timely()):
            self.counter.drops += 1  # before any work on a message that will not be sent
            return False
        if self.chain is not None:
            passed = self._pass(self.chain, packet)
            if passed is None:
                return False
            packet = passed
        if not carrier.prepare(packet):
            self.counter.drops += 1
            return False
        return queue.put(self._dated(packet), delivery.backlog)

    def _send_at_once(self, packet: Packet) -> bool:
        """Send what leaves without waiting. What has begun follows by itself, and nothing else
        before it has."""
        if self.chain is not None:
            passed = self._pass(self.chain, packet)
            if passed is None:
                return False
            packet = passed
        if self.sender.send(packet, 0.0, copies=True) is NOTHING:
            self.counter.drops += 1
            return False
        return True

    def _pass(self, chain: Chain, packet: Packet) -> Packet | None:
        """What the monitors make of a packet; None, and counted, if one drops it."""
        passed = chain.send(packet)
        if passed is None:
            self.counter.drops += 1
        return passed

    def expect(self, wanted: Qos) -> None:
        """From now on messages should arrive like that. The receiver counts; we do not send what is
        late already, if late messages are to be dropped."""
        qos = expected(self.wanted, wanted)
        self.wanted = qos if qos.deadline or qos.rate else None
        if qos.deadline and qos.late == "drop":
            if self._queue is not None and self._follow is None:
                self._queue.send = self._send_queued
            self.limit = qos.deadline
        else:
            self.limit = None
        self._decide()

    def _is_in_time(self, due: float) -> bool:
        """Whether there is time left until `due`; if not, the message is dropped, and counted."""
        if time.monotonic() < due:
            return True
        self.late += 1
        self.counter.drops += 1
        return False

    def _dated(self, packet: Packet) -> Packet | Dated:
        """A packet for the queue: one that may become too late there says when."""
        if self.limit is None:
            return packet
        return Dated(packet, time.monotonic() + time_left(packet, self.limit))

    def _send_queued(self, queued: Packet | Dated) -> None:
        """Send what was in the queue, unless it is too late by now."""
        if isinstance(queued, Packet):
            self.sender.send(queued)
        elif self._is_in_time(queued.due) and (
            self.sender.send(queued.packet, queued.due, copies=True) is NOTHING
        ):
            self.late += 1
            self.counter.drops += 1

    def _timely(self) -> bool:
        """Whether the carrier's interval is over. On the average, so that no beat is missed."""
        now = time.perf_counter()
        if now < self._due:
            return False
        self._due = max(self._due + self.carrier.delivery.interval, now)
        return True

    def start_background(self) -> None:
        """Give the link a thread that sends; `send` and `try_send` then only hand over."""
        with self.sender.lock:
            if self._queue is None and not self.broken:
                transport = self.driver.transport
                if self.carrier.delivery.lossy and isinstance(transport, TcpTransport):
                    transport.limit_unsent(UNSENT)  # else the kernel's buffer is the growing queue
                send = self.sender.send if self.limit is None else self._send_queued
                if self._follow is not None:
                    send = self._follow.send
                self._queue = Background(send, self.counter)
                self._decide()
                self.thread = threading.Thread(
                    target=self._run, args=(self._queue,), name=f"yarpy {self.route}", daemon=True
                )
                self.thread.start()

    def _run(self, queue: Background[Any]) -> None:
        if self.sched.policy >= 0:
            try:
                schedule(0, self.sched)
            except YarpError:
                pass  # reported when it was requested; the link sends without it
        queue.run()

    def wait_sent(self, timeout: float | None = None) -> bool:
        """Wait until everything handed over was sent; False if `timeout` seconds were not
        enough."""
        done = self._queue.wait_empty(timeout) if self._queue is not None else True
        return done and self.sender.sweep(timeout)

    # -- questions --------------------------------------------------------------------------------

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
        self._take_lock(timeout)
        try:
            started = time.perf_counter()
            driver = self.driver
            try:
                if self.sender.window.open:
                    self.sender.window.collect(wait=True, until=deadline)
                carrier, stream = self.carrier, driver.stream
                stream.ending = getattr(packet.value, "ending", None)
                carrier.encode(stream, packet)
                self.sender.flush(deadline)
                if carrier.ping_interval:
                    self.sender.listen(True)
                if not stream.waiting:
                    driver.fill(deadline)
                reply = carrier.parse_reply(stream)
                if reply is None:
                    reply = driver.run(carrier.expect_reply(stream), deadline, self.intake)
                if carrier.acks and not carrier.parse_acks(stream, 1):
                    driver.run(carrier.expect_ack(stream), deadline)
            except Timeout:
                self.sender.give_up()
                raise Timeout(
                    f'"{self.route.target}" did not reply within {timeout} s; is its program stuck?'
                ) from None
            except BaseException as error:
                if interrupts(error):
                    # Its answer must not be taken for that of the next question.
                    self.sender.give_up()
                raise
            finally:
                if self.sender.listens:
                    self.sender.listen(False)
                if deadline is not None:
                    driver.transport.limit_waiting(None)
                if self.broken:
                    self.intake.leave()
            now = time.perf_counter()
            self.counter.count(now)
            self.counter.bytes = driver.bytes_out
            self.counter.measure(now - started)
            if reply is None:
                return None
            reply.source = self.route.target
            return reply if chain is None else chain.reply(reply)
        finally:
            self.sender.lock.release()

    def wait_acknowledged(self, timeout: float | None = None) -> None:
        """Wait until the peer has taken every message, unless it may miss some. Raises Timeout,
        LinkClosed."""
        if self.carrier.delivery.lossy:
            return
        if timeout is None:
            timeout = self.carrier.limits.ack_timeout
        deadline = None if timeout is None else time.monotonic() + timeout
        self._take_lock(timeout)
        try:
            self.sender.window.collect(wait=True, all_=True, until=deadline)
        except Timeout:
            raise
        except YarpError:
            self.sender.give_up()
            raise
        finally:
            self.sender.lock.release()

    def _take_lock(self, timeout: float | None) -> None:
        """Take the lock once nothing waits to be sent. Raises Timeout, LinkClosed."""
        sender = self.sender
        if self._queue is None and not sender.gathered and sender.lock.acquire(blocking=False):
            pass  # as nearly always
        elif not (self.wait_sent(timeout) and sender.lock.acquire(timeout=seconds(timeout))):
            raise Timeout(f'"{self.route.target}" did not take earlier messages within {timeout} s')
        if sender.broken:
            sender.lock.release()
            raise sender.gone()

    # -- ending -----------------------------------------------------------------------------------

    def watch(self) -> bool:
        """As `ended`, for whoever looks now and then while others send."""
        transport = self.driver.transport
        if self.dialled and isinstance(transport, TcpTransport):
            transport.spare_slow_reader()
        return self.ended()

    def ended(self) -> bool:
        """Whether the peer has hung up, found out without sending anything."""
        if self.sender.window.open:
            self.sender.caught_up()  # unread acknowledgements hide the end behind them
        if self._listener is not None:
            self._listener.hear()
        sender, transport = self.sender, self.driver.transport
        if not sender.broken and transport.ended():
            transport.interrupt()  # frees a thread that is stuck in sending
            with sender.lock:
                sender.give_up()
        return sender.broken

    def attend(self) -> None:
        """Hear what the reader says as soon as it does, in this thread, until the end."""
        if self._listener is not None:
            self._listener.attend()

    def retire(self) -> None:
        """Nobody writes to it any more: if it has failed, its thread ends."""
        if self.broken and self._queue is not None:
            self._queue.stop()

    def close(self, quit_: bool = True) -> None:
        """End the connection: say `q`, wait a moment for its acknowledgement, hang up."""
        if not self.wait_sent(CLOSE_PATIENCE):
            self.driver.transport.interrupt()  # free a thread that is stuck in sending
        if self._queue is not None:
            self._queue.stop()
        sender, driver = self.sender, self.driver
        with sender.lock:
            if self.broken:
                return
            known = self.carrier.acks or not (
                self.carrier.connectionless or driver.transport.ended()
            )
            if quit_ and known:
                try:
                    self._say_goodbye()
                except (YarpError, OSError):
                    known = False
            if quit_ and known:
                sender.end()
            else:
                sender.give_up()

    def _say_goodbye(self) -> None:
        sender, driver = self.sender, self.driver
        self.carrier.encode_quit(driver.stream)
        deadline = time.monotonic() + CLOSE_PATIENCE
        driver.flush()
        if not self.carrier.acks:
            driver.run(self.carrier.drain(driver.stream), deadline)
            return
        sender.window.open += 1
        try:
            sender.window.collect(wait=True, all_=True, until=deadline)
        except (YarpError, OSError):
            sender.window.open = max(sender.window.open - 1, 0)  # the goodbye is no message
            raise

    def snapshot(self) -> dict[str, Any]:
        """Counters as plain numbers."""
        found, sender = self.counter.as_dict(), self.sender
        found["unacknowledged"] = sender.window.open
        # What was no message of its protocol, and what nobody wanted.
        found["messages"] -= self.carrier.lost + self.carrier.unwanted
        found["drops"] += self.carrier.lost
        if not (self.carrier.acks or self.broken):
            fate = sender.fate
            found["messages"] -= fate.lost
            found["drops"] += fate.lost
            found["unacknowledged"] = fate.open
        return found
