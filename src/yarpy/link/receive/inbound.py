"""Inbound: a connection that brings messages to a port; one thread, or the reader's own.

Rules: the thread is the link, so its scheduling is the connection's. It reads and hands each
message to the port, unless the port's reader has a lease to read the socket itself (`turn.py`).
"""

from __future__ import annotations

import math
import os
import threading
import time
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any, Protocol

from yarpy.callback_thread import waited_by
from yarpy.carriers.base import Carrier
from yarpy.data.bottle import Bottle
from yarpy.errors import AccessRefused, LinkClosed, RemoteProtocolError, Timeout, YarpError
from yarpy.link.driver import Driver
from yarpy.link.receive.receiver import FRESH, PASSED, SETTLED, Receiver
from yarpy.link.receive.turn import SILENCE, Lease, Turn
from yarpy.link.timing import Timing, chain_of, expected
from yarpy.log import logger
from yarpy.qos import NOTHING_ASKED, Qos, Sched
from yarpy.scope import Flag, Waiter
from yarpy.wire.message import CALL, DATA, QUIT, Message

if TYPE_CHECKING:
    from yarpy.link.counter import Counter
    from yarpy.monitors.chain import Chain
    from yarpy.route import Route

log = logger("yarpy.link")

# A thread with a real-time priority that never waits keeps all others of its program from the core.
give_way: Callable[[], object] = getattr(os, "sched_yield", partial(time.sleep, 0))


class Owner(Protocol):
    """The port of a connection, as far as its link needs it."""

    @property
    def name(self) -> str:
        """The port's name."""

    def receive(self, link: Inbound, message: Message) -> None:
        """Take a data message. May block; answers through `message.reply` if that is wanted."""

    def administer(self, link: Inbound, message: Message) -> Bottle:
        """Answer an administrative message."""

    def command(self, link: Inbound, message: Message) -> list[str]:
        """Carry out a port command (`/dest`, `!`, `~`, `*`, `?`); lines for a person to read."""

    def reverse(self, link: Inbound) -> None:
        """The peer wants to read: make its connection an output."""

    def input_ended(self, link: Inbound, reason: str, quit_: bool) -> None:
        """The link has ended; in good order if `quit_`."""

    def deadline_missed(self, link: Inbound, lateness: float, silent: bool) -> None:
        """A message came that many seconds after its deadline, or (`silent`) has not come yet."""


class Guard(Protocol):
    """Reads for a connection whose peer may not do everything."""

    def advance(self, link: Inbound, deadline: float | None) -> Message:
        """Return the next message that may come. Raises AccessRefused, which ends the link."""

    def answer(self, link: Inbound, message: Message) -> Bottle | list[str] | None:
        """Carry out a port command, or refuse it; return the answer."""


class Inbound:
    """One connection into a port. A peer that may do everything has no guard, and pays nothing for
    one with each message."""

    def __init__(
        self, owner: Owner, driver: Driver, carrier: Carrier, guard: Guard | None = None
    ) -> None:
        self.owner = owner
        self.driver = driver
        self.carrier = carrier
        self.route: Route = carrier.route
        self.receiver = Receiver(driver, carrier)
        # The next message, and the answer to a port command.
        self.advance: Callable[[float | None], Message] = self.receiver.advance
        self.answer: Callable[[Message], Bottle | list[str] | None] = self.carry_out
        self.guarded = guard is not None
        if guard is not None:
            self.advance, self.answer = partial(guard.advance, self), partial(guard.answer, self)
        self.counter: Counter = self.receiver.counter
        self.turn = Turn()
        self.successor = carrier  # the carrier that goes on when the peer becomes a reader
        self.thread: threading.Thread | None = None
        self.served = Flag()  # the thread has ended it, and has told everybody
        self.sched = Sched()  # as requested; -1: nothing was
        self.tos = 0
        self.asked = NOTHING_ASKED  # priorities, granted or not
        self.own_chain: Chain | None = None  # the monitors that ride on it
        self.port_chain: Chain | None = None  # those of the port
        self.timing: Timing | None = None  # when messages should come
        self.chain: Chain | None = None  # all of these
        self.vouched = False  # the sending port knows of this connection, as it was asked
        self.failure = ""  # why the program could not use a message, the last time
        self.replaced = False  # by the next one of the same sender, before its own end was seen
        self._closing = False
        self._closed = False
        self._quit = False
        self._reversed = False
        self._asker = 0  # the thread that carries out a command of the peer

    @property
    def closing(self) -> bool:
        """Return whether our side ends the connection, or is about to."""
        return self._closing

    # -- what messages pass through ----------------------------------------------------------------

    def join(self, port_chain: Chain | None) -> None:
        """Let messages pass through the port's monitors, too, behind our own."""
        self.port_chain = port_chain
        chain = None if self.timing is None else chain_of(self.timing, str(self.route))
        for part in (self.own_chain, port_chain):
            if part is not None:
                chain = part if chain is None else chain.followed_by(part)
        self.chain = chain

    def expect(self, wanted: Qos) -> None:
        """From now on messages should come like that; see `Timing`."""
        qos = expected(self.wanted, wanted)
        self.timing = Timing(qos, self._missed) if qos.deadline or qos.rate else None
        self.join(self.port_chain)

    @property
    def wanted(self) -> Qos | None:
        """The timing that messages should have, None if nothing was said."""
        return None if self.timing is None else self.timing.wanted

    def _missed(self, lateness: float, silent: bool) -> None:
        self.owner.deadline_missed(self, lateness, silent)

    # -- the thread -------------------------------------------------------------------------------

    def serve(self) -> None:
        """Read until the connection ends. Runs in the link's own thread."""
        reason = ""
        idle_timeout = self.carrier.limits.idle_timeout
        receiver = self.receiver
        lease: Lease | None = None
        try:
            while not (self._quit or self._reversed) or receiver.held is not None:
                if lease is not None or idle_timeout is not None:
                    receiver.limit(idle_timeout)
                lease = self._read_on()
                if lease is not None:
                    self.turn.park(lease, self._is_asked)
                    if lease.forsaken:
                        self.counter.drops += receiver.held is not None
                        break
                    if receiver.question is not None:
                        break  # closed; whoever answers may be writing
        except LinkClosed as error:
            reason = "" if self._closing else str(error)  # whoever ends it himself knows
        except YarpError as error:
            reason = f"{error}"
            if receiver.incoming.reason:
                self.counter.drops += 1  # the message that had begun
            if idle_timeout is None or not isinstance(error, Timeout):
                self._tell(error)  # silence beyond a carrier's idle timeout is no fault
        except BaseException as error:  # even a callback's sys.exit() ends this link alone
            reason = f"{type(error).__name__}: {error}"
            log.exception("%s: connection %s fails on a defect", self.owner.name, self.route)
        if self._reversed:
            receiver.limit(idle_timeout)
            receiver.incoming.leave()
            self.owner.reverse(self)
            return
        if not (self._quit or self._closing) and (word := self.carrier.last_word()) is not None:
            self._hand_over_last(word)
        receiver.finish()
        self.owner.input_ended(self, reason, self._quit)

    def _is_asked(self) -> bool:
        """Return whether a reader's question is open, and worth waiting for."""
        return self.receiver.question is not None and not self._closed

    def _read_on(self) -> Lease | None:
        """Read and hand on until the link ends (None), or a reader has a lease: then each wait is
        limited."""
        receiver, turn = self.receiver, self.turn
        while (message := self._next(None)) is not None:
            lease = turn.grant() if turn.asked else None
            settled = receiver.stage == SETTLED  # by a reader that was interrupted behind that
            if receiver.spare is None:
                receiver.held, receiver.stage = None, FRESH  # as `release`
            else:
                receiver.release()
            if message.key == CALL and not settled:
                receiver.open_question(message)
            self.owner.receive(self, message)
            if not settled if message.answer is None else message.answer is receiver.question:
                while not receiver.settle(message):
                    self._let_answer(message)
            if lease is not None:
                receiver.limit(SILENCE)
                return lease
        return None

    def _let_answer(self, message: Message) -> None:
        """Wait until another thread has answered a question that its reader has left. Raises
        LinkClosed when our side closes the connection: that thread may be writing even then."""
        answer, done = message.answer, Waiter()
        assert answer is not None
        answer.left = done.wake
        while answer.busy:
            if self._closed:
                raise LinkClosed("closed while a question was being answered")
            done.wait()

    def _hand_over_last(self, word: Message) -> None:
        """Give the port what a peer that has gone without a goodbye has left for it."""
        self.driver.transport.interrupt()  # nothing is waited for behind that
        self.receiver.held, self.receiver.stage = word, FRESH
        try:
            self._read_on()
        except YarpError:
            pass  # the end that is known already
        except BaseException:
            log.exception("%s: the last message of %s fails", self.owner.name, self.route)

    def _next(self, deadline: float | None) -> Message | None:
        """Return the next data message that the monitors let through, which is held; None if the
        link is over first."""
        receiver = self.receiver
        while receiver.held is not None or not (self._quit or self._reversed):
            message = self.advance(deadline)
            if self.chain is None and (message.key == DATA or message.key == CALL):
                return message
            if self._pass(message):
                return receiver.held
        return None

    def _pass(self, message: Message) -> bool:
        """Let a message through the monitors, or carry out the command that it is; return whether
        it is one for the port, and held."""
        receiver = self.receiver
        data = message.key == DATA or message.key == CALL
        if data and receiver.stage < PASSED and self.chain is not None:
            passed = self.chain.take(message)
            if passed is not None:
                receiver.held, receiver.stage = passed, PASSED
                return True
        elif data:
            return True
        receiver.held, receiver.stage = None, FRESH
        try:
            if data:
                receiver.refuse(message)
            else:
                self._obey(message)
        except YarpError:
            raise
        except BaseException:
            receiver.tear()  # half of it may be done: nobody may do it once more
            raise
        return False

    def _obey(self, message: Message) -> None:
        """A port command that is not data."""
        self._asker = threading.get_ident()
        self.receiver.obey(message, self.answer)
        self._asker = 0

    def carry_out(self, message: Message) -> Bottle | list[str] | None:
        """Do what a port command says; the answer."""
        if message.key == "a":
            answered = self.owner.administer(self, message)
            self._quit = self._quit or getattr(answered, "is_last", False)
            return answered
        if message.key == QUIT:
            self._quit = True
        elif message.key == "r":
            if self.driver.silence and self.route.spec.log is None:
                if self.carrier.spelling == "text":
                    return [self.driver.silence]
                raise RemoteProtocolError(f"it wants to read: {self.driver.silence}")
            self._reversed = True
            if isinstance(message.payload, Carrier):
                self.successor = message.payload
        else:
            return self.owner.command(self, message)
        return None

    # -- a reader with the lease ------------------------------------------------------------------

    def read(
        self,
        lease: Lease,
        deadline: float | None,
        spin: bool = False,
        newest: bool = False,
        away: float = math.inf,
    ) -> Message | None:
        """Return the next data message, read by the thread that has the lease and is `busy`.

        It stays held, so that an exception out of a signal handler does not lose it, until its
        reader releases it. None when the lease is over, or `deadline` has come. With `newest` it is
        the last of the messages that are there; the others are dropped and counted. A reader that
        was away for more than `away` seconds gives the lease up if that has kept the sender
        waiting.
        """
        turn, receiver = self.turn, self.receiver
        lasts = deadline is None
        if deadline is not None and (now := time.monotonic()) + SILENCE <= deadline:
            # Signals come to the main thread, and make the limit of the lease longer.
            lasts, deadline = True, now + SILENCE if lease.main else None
        try:
            if receiver.held is None:
                if receiver.question is not None:
                    return None  # another thread of the program is answering
                late = away < math.inf and time.perf_counter() - lease.seen > away
                if late and (receiver.waiting or self.driver.try_fill()):
                    turn.end()
                if spin and not receiver.waiting and not self._spin(deadline):
                    return None
            message = None if self._quit or self._reversed else self.advance(deadline)
            if message is None or message.key != DATA or self.chain is not None:
                message = self._next(deadline)  # which has held it meanwhile
                if message is None:
                    turn.end()
                    return None
            if receiver.stage == SETTLED:
                pass
            elif message.key == DATA:  # as `_take`, spelled out
                if receiver.acks or message.answer is not None:
                    try:
                        receiver.settle(message)
                    except YarpError:
                        pass  # the sender has gone: the next reader meets the same end
                receiver.stage = SETTLED
            else:
                self._take(message)
            if newest and message.key == DATA:
                stream = self.driver.stream
                if stream.tail > stream.head:
                    return self._newest()
            return message
        except Timeout:
            if lasts:
                turn.end()
            else:
                receiver.limit(SILENCE)
            return None
        except YarpError:
            pass  # the link's thread meets the same end at once, and reports it
        except BaseException:
            if not self.driver.whole:
                receiver.tear()
            raise
        turn.end()
        return None

    def _take(self, message: Message) -> None:
        """Acknowledge data; a question keeps the link's thread parked until its end."""
        receiver = self.receiver
        if message.key == CALL and (message.answer is not None or receiver.open_question(message)):
            if message.answer is not None:
                message.answer.then = self.turn.stir
            receiver.stage = SETTLED
            return
        try:
            receiver.settle(message)
        except YarpError:
            pass  # the sender has gone: the next reader meets the same end
        receiver.stage = SETTLED

    def _newest(self) -> Message | None:
        """Take the newest of the messages that have come behind the one that is held."""
        receiver, stream = self.receiver, self.driver.stream
        try:
            while stream.waiting and receiver.parse_newer():
                message = receiver.advance(None)
                if not self._pass(message):
                    receiver.recall()
                    continue
                self.counter.drops += 1
                receiver.spare = None
                assert receiver.held is not None
                self._take(receiver.held)
                if message.key != DATA:
                    break
        except YarpError:
            receiver.recall()  # the sender has gone, or breaks the rules: the next reader sees it
        return receiver.held

    def _spin(self, deadline: float | None) -> bool:
        """Poll the socket instead of sleeping; False when the time is over."""
        self.receiver.send_acks()
        driver = self.driver
        until = deadline if deadline is not None else time.monotonic() + SILENCE
        while not driver.try_fill():
            give_way()
            if time.monotonic() > until:
                return False
        return True

    def leave(self, message: Message) -> None:
        """The reader is done with a message: an unanswered question is closed."""
        answer = message.answer
        try:
            while not self.receiver.settle(message) and answer is not None:
                answer.left = partial(self.leave, message)  # that its end is not missed
                if answer.busy:
                    return
        except YarpError:  # the asker has gone, or is to get no answer
            if answer is not None and answer.forsaken:
                self.driver.transport.interrupt()
        self.turn.stir()

    # -- ending -----------------------------------------------------------------------------------

    @property
    def asking(self) -> bool:
        """Return whether the caller is carrying out a command that came over this very
        connection."""
        return self._asker != 0 and self._asker == waited_by().ident

    @property
    def answering(self) -> bool:
        """Return whether a question is open, or another thread carries out a command."""
        return self.receiver.question is not None or not (self._asker == 0 or self.asking)

    def foresee_end(self) -> None:
        """Our side ends it when its sender has been told: what it meets until then is no failure,
        and nobody has it made again."""
        self._closing = True

    def close(self) -> None:
        """End the connection from our side; its thread notices. Any thread may call.

        A command that asks for the end of its own connection is answered first.
        """
        self._closing = True
        if self.asking:
            self._quit = True
            return
        lease = self.turn.lease
        if lease is not None and lease.busy and lease.reader == threading.get_ident():
            lease.forsaken = True  # a reader beneath us goes on, and finds the end, when we return
        self._closed = True
        self.turn.end()
        question = self.receiver.question
        if question is not None and question.left is not None:
            question.left()
        self.driver.transport.interrupt()

    def _tell(self, error: YarpError) -> None:
        """The one log line for a connection that ends on an error."""
        if not (self._closing or isinstance(error, AccessRefused)):  # which was logged already
            log.warning(
                "%s: connection from %s over %s closed: %s",
                self.owner.name,
                self.route.source or self._where(),
                self.route.carrier,
                error,
            )

    def _where(self) -> str:
        try:
            host, port = self.driver.transport.remote
        except OSError:
            return "somebody"
        return f"{host}:{port}"

    @property
    def lost(self) -> int:
        """Return how many messages the protocol and the kernel lost on the way."""
        return self.carrier.lost + self.driver.transport.dropped

    def snapshot(self) -> dict[str, Any]:
        """Counters as plain numbers, with the protocol's and the kernel's own losses in `drops`."""
        found: dict[str, Any] = self.counter.as_dict()
        found["drops"] += self.lost
        if self.timing is not None:
            found["missed"] = self.timing.as_dict()["missed"]
        return found
