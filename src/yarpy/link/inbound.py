"""Inbound: a connection that brings messages to a port; one thread, or the reader's own.

Rules: the thread is the link, so its scheduling is the connection's. It reads and hands each
message to the port, unless the port's reader has a lease to read the socket itself (`turn.py`).
"""

from __future__ import annotations

import math
import threading
import time
from typing import TYPE_CHECKING, Any, Protocol

from yarpy.carriers.base import Carrier
from yarpy.data.bottle import Bottle
from yarpy.errors import AccessRefused, LinkClosed, RemoteProtocolError, Timeout, YarpError
from yarpy.link.driver import Driver
from yarpy.link.receiver import Receiver
from yarpy.link.timing import Timing, chain_of, expected
from yarpy.link.turn import SILENCE, Turn
from yarpy.log import logger
from yarpy.qos import NOTHING_ASKED, Qos, Sched
from yarpy.wire.message import CALL, DATA, QUIT, Message

if TYPE_CHECKING:
    from collections.abc import Callable

    from yarpy.link.counter import Counter
    from yarpy.monitors.chain import Chain
    from yarpy.route import Route

log = logger("yarpy.link")


class Owner(Protocol):
    """What a link needs of its port."""

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


class Inbound:
    """One connection into a port."""

    def __init__(self, owner: Owner, driver: Driver, carrier: Carrier) -> None:
        self.owner = owner
        self.driver = driver
        self.carrier = carrier
        self.route: Route = carrier.route
        self.receiver = Receiver(driver, carrier)
        # The next message, and the answer to a port command: a guard takes their place.
        self.advance = self.receiver.advance
        self.answer: Callable[[Message], Bottle | list[str] | None] = self.carry_out
        self.counter: Counter = self.receiver.counter
        self.turn = Turn()
        self.successor = carrier  # the carrier that goes on when the peer becomes a reader
        self.thread: threading.Thread | None = None
        self.served = threading.Event()  # the thread has ended it, and has told everybody
        self.sched = Sched()  # as requested; -1: nothing was
        self.tos = 0
        self.asked = NOTHING_ASKED  # priorities, granted or not
        self.own_chain: Chain | None = None  # the monitors that ride on it
        self.port_chain: Chain | None = None  # those of the port
        self.timing: Timing | None = None  # when messages should come
        self.chain: Chain | None = None  # all of these
        self.failure = ""  # why the program could not use a message, the last time
        self._closing = False
        self._quit = False
        self._reversed = False
        self._asker = 0  # the thread that carries out a command of the peer

    @property
    def closing(self) -> bool:
        """Whether it is our side that ends the connection."""
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
        """When messages should come, None if nothing was said."""
        return None if self.timing is None else self.timing.wanted

    def _missed(self, lateness: float, silent: bool) -> None:
        self.owner.deadline_missed(self, lateness, silent)

    # -- the thread -------------------------------------------------------------------------------

    def serve(self) -> None:
        """Read until the connection ends. Runs in the link's own thread."""
        reason = ""
        idle_timeout = self.carrier.limits.idle_timeout
        limited = idle_timeout is not None
        try:
            while not self._quit and not self._reversed:
                with self.turn.lock:
                    if limited:
                        self.receiver.limit(idle_timeout)
                    limited = self._read_on()
                if limited:
                    self.turn.park(lambda: self.receiver.question is not None)
        except LinkClosed as error:
            reason = str(error)
        except YarpError as error:
            reason = f"{error}"
            if self.receiver.intake.reason:
                self.counter.drops += 1  # the message that had begun
            if idle_timeout is None or not isinstance(error, Timeout):
                self._tell(error)  # silence beyond a carrier's idle timeout is no fault
        except BaseException as error:  # even a callback's sys.exit() ends this link alone
            reason = f"{type(error).__name__}: {error}"
            log.exception("%s: connection %s fails on a defect", self.owner.name, self.route)
        if self._reversed:
            self.receiver.limit(idle_timeout)
            self.receiver.intake.leave()
            self.owner.reverse(self)
            return
        self.receiver.finish()
        self.owner.input_ended(self, reason, self._quit)

    def _read_on(self) -> bool:
        """Read and hand on until the link ends, or a reader has the lease: then True, and each
        wait is limited."""
        receiver, turn = self.receiver, self.turn
        while (message := self._next(None)) is not None:
            leased = turn.asked and turn.grant()
            if message.key == CALL:
                receiver.open_question(message)
            self.owner.receive(self, message)
            receiver.settle(message)
            if leased:
                receiver.limit(SILENCE)
                return True
        return False

    def _next(self, deadline: float | None) -> Message | None:
        """The next data message that the monitors let through; None if the link is over first."""
        while not self._quit and not self._reversed:
            message = self.advance(deadline)
            if message.key == DATA or message.key == CALL:
                if self.chain is None:
                    return message
                passed = self.chain.take(message)
                if passed is not None:
                    return passed
                self.receiver.refuse(message)
            else:
                self._obey(message)
        return None

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
        deadline: float | None,
        spin: bool = False,
        newest: bool = False,
        away: float = math.inf,
    ) -> Message | None:
        """The next data message, read in the thread of a reader that has the lease.

        None when the lease is over, or `deadline` has come. With `newest` it is the last of the
        messages that are there; the others are dropped and counted. A reader that was away for
        more than `away` seconds gives the lease up if that has kept the sender waiting.
        """
        turn, receiver = self.turn, self.receiver
        late = away < math.inf and time.perf_counter() - turn.seen > away
        if deadline is not None and deadline - time.monotonic() >= SILENCE:
            deadline = None
        if not turn.take(SILENCE if deadline is None else max(0.0, deadline - time.monotonic())):
            return None
        try:
            if receiver.question is not None:
                return None  # another thread of the program is answering
            if late and (receiver.waiting or self.driver.try_fill()):
                turn.end()
            if spin and not receiver.waiting and not self._spin(deadline):
                return None
            message = self._next(deadline)
            if message is not None:
                self._take(message)
                if newest and message.key == DATA and self.driver.stream.waiting:
                    message = self._newest(message)
                return message
        except Timeout:
            if deadline is None:
                turn.end()
            else:
                receiver.limit(SILENCE)
            return None
        except YarpError:
            pass  # the link's thread meets the same end at once, and reports it
        finally:
            turn.leave()
        turn.end()
        return None

    def _take(self, message: Message) -> None:
        """Acknowledge data; a question keeps the link's thread parked until its end."""
        if message.key == CALL and self.receiver.open_question(message):
            if message.answer is not None:
                message.answer.then = self.turn.stir
            return
        try:
            self.receiver.settle(message)
        except YarpError:
            pass  # the sender has gone: the next reader meets the same end

    def _newest(self, message: Message) -> Message:
        """Take the newest of the messages that have come behind this one already."""
        receiver, stream = self.receiver, self.driver.stream
        try:
            while message.key == DATA and stream.waiting:
                later = self.carrier.parse(stream)
                if later is None:
                    break
                receiver.count(later)
                if later.key != DATA and later.key != CALL:
                    self._obey(later)
                    continue
                passed = later if self.chain is None else self.chain.take(later)
                if passed is None:
                    receiver.refuse(later)
                    continue
                self.counter.drops += 1
                self._take(passed)
                message = passed
        except YarpError:
            pass  # the sender has gone, or breaks the rules: the next reader meets the same
        return message

    def _spin(self, deadline: float | None) -> bool:
        """Poll the socket instead of sleeping; False when the time is over."""
        self.receiver.send_acks()
        driver = self.driver
        until = deadline if deadline is not None else time.monotonic() + SILENCE
        while True:
            for _ in range(64):
                if driver.try_fill():
                    return True
            if time.monotonic() > until:
                return False

    def leave(self, message: Message) -> None:
        """The reader is done with a message: an unanswered question is closed."""
        try:
            self.receiver.settle(message)
        except YarpError:
            pass  # the asker has gone
        self.turn.stir()

    # -- ending -----------------------------------------------------------------------------------

    @property
    def asking(self) -> bool:
        """Whether the caller is carrying out a command that came over this very connection."""
        return self._asker == threading.get_ident()

    def close(self) -> None:
        """End the connection from our side; its thread notices. Any thread may call.

        A command that asks for the end of its own connection is answered first.
        """
        self._closing = True
        if self.asking:
            self._quit = True
            return
        self.turn.end()
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
        """What the protocol and the kernel lost on the way."""
        dropped: int = getattr(self.driver.transport, "dropped", 0)
        return self.carrier.lost + dropped

    def snapshot(self) -> dict[str, Any]:
        """Counters as plain numbers, with the protocol's and the kernel's own losses in `drops`."""
        found: dict[str, Any] = self.counter.as_dict()
        found["drops"] += self.lost
        if self.timing is not None:
            found["missed"] = self.timing.as_dict()["missed"]
        return found
