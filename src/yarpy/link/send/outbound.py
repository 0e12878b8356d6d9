"""Outbound: a connection that carries a port's messages away.

Rules: what becomes of a message is decided by its outbox (`outbox.py`), which is chosen when the
connection opens and when its options change. Monitors ride on it; its end is counted once.
"""

from __future__ import annotations

import sys
import threading
from collections.abc import Sequence
from contextlib import suppress
from itertools import accumulate
from typing import TYPE_CHECKING, Any, Final

from yarpy import scope
from yarpy.errors import LinkClosed, LocalProtocolError, Timeout, YarpError
from yarpy.link.ending import NEVER, Ending, moment
from yarpy.link.receive.incoming import Incoming
from yarpy.link.send.backlog import Backlog
from yarpy.link.send.dated import Dated
from yarpy.link.send.direct import Direct
from yarpy.link.send.followed import Followed
from yarpy.link.send.listener import Listener
from yarpy.link.send.lossy import Lossy
from yarpy.link.send.outbox import Outbox
from yarpy.link.send.question import exchange
from yarpy.link.send.queued import Queue, Queued
from yarpy.link.send.recent import Recent
from yarpy.link.send.sender import LETTING_GO, Hold, Sender
from yarpy.link.send.slow_reader import STRANGERS
from yarpy.link.timing import expected
from yarpy.qos import NOTHING_ASKED, Qos, Sched, schedule
from yarpy.wire.message import CALL, Message, Packet

if TYPE_CHECKING:
    from yarpy.carriers.base import Carrier
    from yarpy.link.counter import Counter
    from yarpy.link.driver import Driver
    from yarpy.monitors.chain import Chain
    from yarpy.route import Route

UNSENT: Final = 1 << 16  # bytes of a lossy connection that the kernel may buffer
CLOSE_TIMEOUT: Final = 1.0  # seconds to wait for the acknowledgement of `q`


class Outbound:
    """One connection out of a port. `box` takes its messages; `reliable` is the one that waits for
    the reader, where `box` prefers new messages."""

    def __init__(self, driver: Driver, carrier: Carrier, dialled: bool = True) -> None:
        self.driver = driver
        self.carrier = carrier
        self.route: Route = carrier.route
        self._waits = carrier.delivery.at_once and carrier.delivery.backlog > 0
        self.sender = Sender(driver, carrier, None if dialled or self._waits else STRANGERS)
        self.counter: Counter = self.sender.counter
        self.incoming = Incoming(  # of a reply
            carrier.limits.message_timeout,
            lambda: driver.transport.interrupt(),
            lambda: driver.stream.forget(),
        )
        self.dialled = dialled  # by us; else the reader dialled us, and has to dial again
        self.sched = Sched()  # as requested; -1: nothing was
        self.tos = 0
        self.asked = NOTHING_ASKED  # priorities, granted or not
        self.log = carrier.route.spec.log is not None  # gets what the port receives, not writes
        self.left = False  # the reader had hung up in good order when we ended the connection
        self.active = True  # of the multicast links of a port only one sends
        self.wanted: Qos | None = None  # when messages should come
        self.limit: float | None = None  # seconds after which a message is not sent any more
        self._newest = False  # its port's writers do not wait
        self._keep = 0  # nor, if so many messages may wait for it
        steps = carrier.listen(driver.stream)
        self._listener = None if steps is None else Listener(self.sender, steps)
        self._queue: Queue | None = None  # of its own thread
        self._choose()

    def _choose(self) -> None:
        """Choose the outbox."""
        sender, queue, delivery = self.sender, self._queue, self.carrier.delivery
        lossy = delivery.lossy or self._newest
        # Pictures and texts for people take long to make: not in the writer's thread.
        slow = delivery.lossy or self.carrier.spelling == "text"
        if self._waits or (lossy and slow and queue is None and not delivery.at_once):
            queue = self._make_queue()
        if self._keep:
            queue = self._make_queue()
        box = self._dated(Direct(sender) if queue is None else Queued(sender, queue))
        newest = self._dated(Lossy(sender, queue)) if lossy else box
        if self._waits and queue is not None:
            newest = self._dated(Backlog(sender, queue, delivery.backlog, delivery.held))
        if self._keep and queue is not None:
            newest = self._dated(Recent(sender, queue, self._keep))
        self.box: Outbox = newest
        self.reliable: Outbox = newest if delivery.lossy else box

    def _dated(self, box: Outbox) -> Outbox:
        return box if self.limit is None else Dated(box, self.limit)

    def join(self, ending: Ending, newest: bool) -> None:
        """Belong to a port from now on: `ending` says when its operations are over, and its writers
        do not wait if the `newest` message is what counts."""
        self.sender.obey(ending)
        self._newest = newest
        self._choose()

    def keep(self, count: int) -> None:
        """Let writers not wait for this reader: while it is behind, the last `count` messages wait
        for it."""
        self._keep = count
        self._choose()

    def ride(self, chain: Chain | None) -> None:
        """Let monitors see its messages. Raises LocalProtocolError for one that wants to know when
        they are confirmed, over a carrier that cannot tell."""
        self.sender.chain = chain
        if chain is not None and chain.watches:
            self._make_queue().send = Followed(self.sender, chain).put_due
            self._choose()
            chain.watch(lambda: 0 if self._queue is None else self._queue.pending)

    @property
    def chain(self) -> Chain | None:
        """The monitors that ride on it."""
        return self.sender.chain

    @property
    def broken(self) -> bool:
        """Return whether it has failed, or was closed."""
        return self.sender.broken

    @property
    def reason(self) -> str:
        """The reason why it has ended."""
        return self.sender.reason or "the peer hung up"

    @property
    def late(self) -> int:
        """Messages that were not sent since their deadline had come."""
        return self.sender.late

    # -- sending ----------------------------------------------------------------------------------

    def send(self, packet: Packet, until: float | None = None) -> bool:
        """Send one message; return False if it was dropped or replaced. See `Outbox.offer`."""
        return self.box.offer(packet, until) is True

    def send_whole(self, data: bytes, ends: Sequence[int] = ()) -> bool:
        """Send a message that is encoded already, or several that have these `ends` in it; return
        False, and do nothing, where `send` has more to do than that. Raises LinkClosed."""
        box, queue = type(self.box), self._queue
        at_once = box is Direct or (box is Recent and queue is not None and not queue.pending)
        simple = at_once and self.chain is None and not self.carrier.acks
        return simple and self.sender.send_whole(data, ends)

    def send_burst(self, packets: Sequence[Packet]) -> bool:
        """Send messages in one piece; return False, and do nothing, as `send_whole`."""
        frames = self.carrier.frames(packets)
        if not frames:
            return False
        return self.send_whole(b"".join(frames), [*accumulate(map(len, frames))])

    def expect(self, wanted: Qos) -> None:
        """Note how messages should arrive from now on. The receiver counts; we do not send what is
        late already, if late messages are to be dropped."""
        qos = expected(self.wanted, wanted)
        self.wanted = qos if qos.deadline or qos.rate else None
        self.limit = qos.deadline if qos.deadline and qos.late == "drop" else None
        self._choose()

    # -- its own thread ---------------------------------------------------------------------------

    @property
    def thread(self) -> threading.Thread | None:
        """Its own thread, which sends."""
        return None if self._queue is None else self._queue.thread

    def start_background(self) -> None:
        """Give the link a thread that sends; outboxes then only hand over."""
        self._make_queue().start()
        self._choose()

    def _make_queue(self) -> Queue:
        queue = self._queue
        if queue is None:
            # Else the kernel's buffer is the growing queue.
            if self.carrier.delivery.lossy and not self._waits:
                self.driver.transport.limit_unsent(UNSENT)
            send = Direct(self.sender, NEVER).put_due
            name = f"yarpy {self.route}"
            queue = self._queue = Queue(send, self.counter, name, self._take_priority)
            if self.broken:
                queue.stop()
        return queue

    def _take_priority(self) -> None:
        """In its own thread: be scheduled as was asked."""
        if self.sched.policy >= 0:
            try:
                schedule(0, self.sched)
            except YarpError:
                pass  # reported when it was requested; the link sends without it

    def wait_sent(self, until: float | None = None, ending: Ending = NEVER) -> bool:
        """Wait until everything handed over was sent; return False if `until` comes first, or the
        `ending`."""
        queue = self._queue
        return (queue is None or queue.wait_empty(until, ending)) and self.sender.drain(
            until, ending
        )

    def wait_acknowledged(self, until: float | None = None) -> bool:
        """Wait until the peer has taken every message, unless it may miss some; return False if
        `until` comes first. Raises LinkClosed, PortClosed."""
        if self.carrier.delivery.lossy:
            return True
        limit = self.carrier.limits.ack_timeout
        if until is None:
            until = moment(limit)
        sender = self.sender
        done = False
        if self.wait_sent(until, sender.ending):
            hold = Hold(sender, until)
            try:
                hold.take()
                if hold.held:
                    if sender.broken:
                        raise sender.gone()
                    try:
                        done = sender.window.collect(wait=True, all_=True, until=until)
                    except BaseException:
                        sender.give_up()
                        raise
            finally:
                hold.give()
        if not done:
            sender.ending.check()
        return done

    # -- questions --------------------------------------------------------------------------------

    def call(self, packet: Packet, until: float | None = None) -> Message | None:
        """Send a question and wait for its reply; return None if the peer has none to give.

        Raises Timeout; LinkClosed; PortClosed, as soon as the port is interrupted or closed.
        """
        sender, carrier = self.sender, self.carrier
        if not carrier.replies:
            raise LocalProtocolError(
                f'"{carrier.name}" carries no replies; connect to "{self.route.target}" with tcp'
            )
        assert packet.key == CALL or packet.key == "a"
        chain = sender.chain if packet.key == CALL else None
        if chain is not None:
            passed = self.box.passed(packet)
            if passed is None:
                return None
            packet = passed
        if sender.held():
            raise LocalProtocolError(
                f'"{self.route.target}" cannot be asked by a signal handler that has interrupted '
                "another use of the same connection"
            )
        queue = self._queue
        try:
            waits = sender.gathered or (queue is not None and queue.pending)
            if waits or not sender.lock.acquire(False):
                self._wait_for_lock(until)
            if sender.broken:
                raise sender.gone()
            self.driver.ending = sender.ending
        except BaseException:
            if sender.held():
                sender.lock.release()
            raise
        try:
            reply = exchange(sender, self.incoming, packet, until)
        finally:
            sender.lock.release()  # nothing before it: a signal handler could raise there
        if reply is None:
            return None
        reply.source = self.route.target
        return reply if chain is None else chain.reply(reply)

    def _wait_for_lock(self, until: float | None) -> None:
        """Take the lock once nothing waits to be sent. Raises Timeout, LinkClosed, PortClosed."""
        sender, ending = self.sender, self.sender.ending
        if not (self.wait_sent(until, ending) and ending.acquire(sender.lock, until)):
            ending.check()
            raise Timeout(f'"{self.route.target}" did not take earlier messages in time')

    def interrupt(self) -> None:
        """Wake whoever waits for an answer: the port has ended. Any thread, and signal handlers."""
        if self.sender.asking:
            self.driver.transport.interrupt()

    # -- ending -----------------------------------------------------------------------------------

    def watch(self) -> bool:
        """As `ended`, for whoever looks now and then while others send: also where the reader has
        said something before that is said to nobody, since nothing is expected of it."""
        sender, transport = self.sender, self.driver.transport
        if self.dialled:
            transport.spare_slow_reader()
        if self.ended():
            return True
        if not (sender.window.open or sender.asking) and transport.hung_up():
            sender.fail()
        return sender.broken

    def ended(self) -> bool:
        """Return whether the peer has hung up, found out without sending anything."""
        sender, transport = self.sender, self.driver.transport
        if sender.window.open:
            sender.look()  # unread acknowledgements hide the end behind them
        if self._listener is not None:
            self._listener.hear()
        if not sender.broken and transport.ended():
            sender.fail()
        return sender.broken

    def attend(self) -> None:
        """Hear what the reader says as soon as it does, in this thread, until the end."""
        if self._listener is not None:
            self._listener.attend()

    def retire(self) -> None:
        """End its thread if it has failed: nobody writes to it any more."""
        if self.broken and self._queue is not None:
            self._queue.stop()

    def close(self, quit_: bool = True, until: float | None = None) -> None:
        """End the connection: say `q`, wait for its acknowledgement, hang up. That takes until
        `until`, or CLOSE_TIMEOUT. Where the frame beneath is at work on it, as under a signal
        handler, it ends at once."""
        sender, driver = self.sender, self.driver
        by = scope.until(moment(CLOSE_TIMEOUT) if until is None else until)
        if sender.held():
            driver.transport.interrupt()
            sender.give_up(at_rest=False)
        elif not self.wait_sent(by):
            driver.transport.interrupt()  # free a thread that is stuck in sending
        if self._queue is not None:
            self._queue.stop()
        if sender.broken:
            return
        hold = Hold(sender, moment(LETTING_GO), NEVER)
        try:
            hold.take()
            if sender.broken:
                return
            known = hold.held and (
                self.carrier.acks
                or not (self.carrier.delivery.connectionless or driver.transport.ended())
            )
            before = driver.bytes_out
            if quit_ and known:
                try:
                    known = self._say_goodbye(by)
                except (YarpError, OSError):
                    known = False
            if quit_ and known:
                sender.end()
            else:
                self.left = hold.held and self._has_left(before)
                driver.transport.interrupt()
                sender.give_up(at_rest=hold.held)
        finally:
            hold.give()

    def _say_goodbye(self, by: float | None) -> bool:
        """Return whether the peer has taken the goodbye, and all before it, as far as that is to
        be known."""
        sender, driver = self.sender, self.driver
        before = driver.bytes_out
        self.carrier.encode_quit(driver.stream)
        if not driver.send(by):
            return False
        if not self.carrier.acks:
            if self.carrier.spelling == "text":
                # The welcome, and all else that they say: closing with unread input resets the
                # connection and loses our last output.
                with suppress(LinkClosed):  # their end, which says that they have read ours
                    driver.run(driver.stream.skip(sys.maxsize), by)
            aloud = driver.bytes_out > before and not self.carrier.reaches.foreign
            return not aloud or self.carrier.delivery.lossy or self._hangs_up(by)
        sender.window.open += 1
        taken = False
        try:
            taken = sender.window.collect(wait=True, all_=True, until=by)
        finally:
            if not taken:
                sender.window.open = max(sender.window.open - 1, 0)  # the goodbye is no message
        return taken

    def _hangs_up(self, by: float | None) -> bool:
        """Wait until the peer, which has been told goodbye, hangs up; return whether it has read
        all before that. True where the system cannot tell."""
        driver = self.driver
        transport = driver.transport
        if transport.taken(driver.bytes_out, driver.bytes_in) is None:
            return True
        with suppress(YarpError):  # the end, or the time is over
            driver.run(driver.stream.skip(sys.maxsize), by)
        taken = transport.taken(driver.bytes_out, driver.bytes_in)
        return taken is not None and taken[1] and taken[0] >= driver.bytes_out

    def _has_left(self, before: int) -> bool:
        """Return whether the peer had hung up by itself when it had taken all `before` our goodbye,
        in bytes, as far as the system can tell."""
        sender, driver = self.sender, self.driver
        if sender.gathered or sender.halfway or not driver.transport.ended():
            return False
        taken = driver.transport.taken(driver.bytes_out, driver.bytes_in)
        return taken is None or (taken[1] and taken[0] >= before)

    def snapshot(self) -> dict[str, Any]:
        """Return counters as plain numbers."""
        found, sender = self.counter.as_dict(), self.sender
        found["unacknowledged"] = sender.window.open
        # What was no message of its protocol, and what nobody wanted.
        found["messages"] -= self.carrier.lost + self.carrier.unwanted
        found["drops"] += self.carrier.lost
        if not (self.carrier.acks or self.broken):
            outcome = sender.outcome
            found["messages"] -= outcome.lost
            found["drops"] += outcome.lost
            found["unacknowledged"] = outcome.open
        return found
