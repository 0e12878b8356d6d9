"""Inbound: a connection that brings messages to a port; one thread, or the reader's own.

Rules: the thread is the link, so its scheduling is the connection's. It welcomes, then reads,
hands each message to the port, answers, acknowledges. Acknowledgements leave when there is nothing
more to read at once, so a burst costs one send. A reader that is already waiting for the next
message may take the turn and read the socket itself (`borrow`), which saves the hop between
threads; the thread then looks in every few milliseconds and takes over as soon as the reader stays
away.
"""

from __future__ import annotations

import logging
import threading
import time
from typing import TYPE_CHECKING, Any, Protocol

from yarpy.data.bottle import Bottle
from yarpy.errors import LinkClosed, RemoteProtocolError, Timeout, YarpError
from yarpy.link.counter import Counter
from yarpy.link.driver import Driver
from yarpy.qos import Sched
from yarpy.wire.message import CALL, DATA, QUIT, Message
from yarpy.wire.stream import LARGE

if TYPE_CHECKING:
    from yarpy.carriers.base import Carrier
    from yarpy.contact import Route
    from yarpy.monitors.chain import Chain
    from yarpy.wire.effects import Steps

log = logging.getLogger("yarpy.link")

PARKED = 0.005  # seconds between looks while a reader has the turn
PATIENCE = 0.02  # seconds a reader with the turn waits before it looks around
MAX_UNSENT_ACKS = 64


class Owner(Protocol):
    """What a link needs of its port."""

    name: str

    def receive(self, link: Inbound, message: Message) -> None:
        """Take a data message. May block; answers through `message.reply` if that is wanted."""

    def administer(self, link: Inbound, message: Message) -> Bottle:
        """Answer an administrative message."""

    def command(self, link: Inbound, message: Message) -> list[str]:
        """Carry out a port command (`/dest`, `!`, `~`, `*`, `?`); lines for a person to read."""

    def reverse(self, link: Inbound) -> None:
        """The peer wants to read: make its connection an output."""

    def closed(self, link: Inbound, reason: str, quit_: bool) -> None:
        """The link has ended. `quit_` tells that it ended in good order."""


class Inbound:
    """One connection into a port."""

    def __init__(self, owner: Owner, driver: Driver, carrier: Carrier) -> None:
        self.owner = owner
        self.driver = driver
        self.carrier = carrier
        self.route: Route = carrier.route
        self.counter = Counter(since=time.time())
        self.thread: threading.Thread | None = None
        self.sched = Sched()  # what somebody asked for; -1: nothing
        self.tos = 0
        self.own_chain: Chain | None = None  # the monitors that ride on it
        self.chain: Chain | None = None  # those, and the port's
        self.wanted = False  # a reader would like the turn
        self.visited = 0.0  # when a reader with the turn was last here
        self._turn = threading.Lock()  # who may read: the thread, or a reader that borrowed it
        self._steps: Steps[Message] | None = None
        self._leaving = False  # the thread leaves the turn to a reader
        self._begun = 0.0  # when a message that must hurry began to come; 0: none has
        self._unsent_acks = 0
        self._answering: Message | None = None
        self._closing = False
        self._quit = False
        self._reversed = False
        self._asker = 0  # the thread that carries out a command of the peer
        self._woken = threading.Event()

    @property
    def closing(self) -> bool:
        """Whether it is our side that ends the connection."""
        return self._closing

    # -- the thread -------------------------------------------------------------------------------

    def serve(self) -> None:
        """Read until the connection ends. Runs in the link's own thread."""
        reason = ""
        if self.carrier.patience is not None:
            self._limit(None)
        try:
            while not self._quit and not self._reversed:
                with self._turn:
                    self._read_on()
                if self._leaving and not self._quit:
                    self._park()
        except LinkClosed as error:
            reason = str(error)
        except YarpError as error:
            reason = f"{error}"
            if self.carrier.patience is None or not isinstance(error, Timeout):
                self._tell(error)  # silence beyond a carrier's patience is nobody's fault
        except BaseException as error:  # a callback's sys.exit() too ends this link, and no more
            reason = f"{type(error).__name__}: {error}"
            log.exception("%s: connection %s fails on a defect", self.owner.name, self.route)
        if self._reversed:
            self._limit(None)
            self.owner.reverse(self)
            return
        self._finish()
        self.owner.closed(self, reason, self._quit)

    def _read_on(self) -> None:
        """Read and hand on until the link ends or a reader wants the turn."""
        while not self._quit and not self._reversed:
            message = self.advance(None)
            if message.key == DATA or message.key == CALL:
                if self.chain is not None:
                    passed = self.chain.take(message)
                    if passed is None:
                        self._refuse(message)
                        continue
                    message = passed
                # Decided before the reader can see the message: when it comes back, the turn is
                # free or about to be.
                self._leaving = self.wanted
                self._deliver(message)
                if self._leaving:
                    self._limit(PATIENCE)  # so often a reader with the turn looks around
                    return
            else:
                self._obey(message)

    def _park(self) -> None:
        """Leave reading to the port's reader while it keeps coming back."""
        self._woken.clear()
        self.visited = time.perf_counter()
        while self._leaving and not self._closing:
            self._woken.wait(PARKED)
            if not self._turn.acquire(blocking=False):
                continue  # the reader is waiting for data right now
            try:
                gone = time.perf_counter() - self.visited > PARKED
                if (gone or not self.wanted) and self._answering is None:
                    self.wanted = self._leaving = False
                    self._limit(None)
            finally:
                self._turn.release()
        self.wanted = self._leaving = False

    def _limit(self, seconds: float | None) -> None:
        """Let each wait for bytes take so long; None: as long as the carrier has patience."""
        if seconds is None:
            seconds = self.carrier.patience
        try:
            self.driver.transport.limit_waiting(seconds)
        except OSError:
            pass  # closed meanwhile; reading tells

    # -- reading ----------------------------------------------------------------------------------

    def advance(self, deadline: float | None) -> Message:
        """The next message. The caller has the turn. Raises Timeout (what came is kept),
        LinkClosed."""
        driver = self.driver
        carrier = self.carrier
        while True:
            stream = driver.stream
            if self._steps is None and (stream.waiting or carrier.holding):
                message = carrier.parse(stream)
                if message is not None:
                    break
                self._steps = carrier.decode(stream)
            if self._steps is not None:
                try:
                    next(self._steps)
                except StopIteration as stop:
                    self._steps = None
                    message = stop.value
                    break
                except BaseException:
                    self._steps = None  # whoever reads next meets the same end
                    raise
            if self._unsent_acks or driver.stream.pending:
                self._send_acks()
            if carrier.finished:
                message = Message(QUIT)
                break
            if carrier.hurry is None:
                driver.fill(deadline)
            else:
                self._fill_in_time(carrier.hurry, deadline)
            if self._steps is None and not driver.stream.waiting:
                self._steps = carrier.decode(driver.stream)  # meets the end, and says how
        if self._begun:
            self._forget_hurry()
        self._count(message)
        return message

    def _count(self, message: Message) -> None:
        message.source = self.route.source
        counter = self.counter
        counter.count(time.perf_counter())
        counter.bytes = self.driver.bytes_in

    def _fill_in_time(self, hurry: float, deadline: float | None) -> None:
        """Wait for more bytes, but for a message that has begun no longer than it may take."""
        if not self.carrier.midway:
            self._forget_hurry()
            self.driver.fill(deadline)
            return
        now = time.monotonic()
        self._begun = self._begun or now
        left = self._begun + hurry - now
        try:
            if left <= 0:
                raise Timeout("the peer is too slow")
            if not self._leaving:  # a reader with the turn looks around often enough
                self.driver.transport.limit_waiting(left)
            self.driver.fill(deadline)
        except Timeout as error:
            steps = self._steps
            if steps is not None and time.monotonic() > self._begun + hurry - 0.01:
                self._steps = None
                self.driver.tell_late(steps, error)
                raise RemoteProtocolError("the peer sends a message too slowly") from error
            raise

    def _forget_hurry(self) -> None:
        """Nothing has begun to come: wait as long as usual."""
        if self._begun:
            self._begun = 0.0
            self._limit(PATIENCE if self._leaving else None)

    def borrow(self) -> bool:
        """Take the turn for a reader, if the link's thread is not reading itself."""
        if not (self.wanted and self._leaving) or not self._turn.acquire(timeout=PATIENCE):
            return False
        if not (self.wanted and self._leaving) or self._closing:
            self._turn.release()
            return False
        return True

    def release(self) -> None:
        """The reader takes the turn no more: the link's thread reads on at once."""
        self.wanted = False
        self._woken.set()

    def give_back(self) -> None:
        """End of `borrow`."""
        self.visited = time.perf_counter()
        self._turn.release()

    def fetch(
        self, deadline: float | None, spin: bool = False, newest: bool = False
    ) -> Message | None:
        """The next data message, read by a borrower; None when it should look around again.

        `deadline` is for waits shorter than PATIENCE only. With `newest` it is the last of those
        that are there; the others are dropped and counted.
        """
        try:
            while True:
                idle = not (self.driver.stream.waiting or self.carrier.holding)
                if spin and idle and not self._spin(deadline):
                    return None
                message = self.advance(deadline)
                if message.key == DATA or message.key == CALL:
                    if self.chain is not None:
                        passed = self.chain.take(message)
                        if passed is None:
                            self._refuse(message)
                            continue
                        message = passed
                    self.accept(message)
                    return self._newest(message) if newest else message
                self._obey(message)
                if self._quit or self._reversed:
                    break
        except Timeout:
            if deadline is not None:
                self._limit(PATIENCE)
            return None
        except YarpError:
            pass  # the link's thread meets the same end at once, and tells of it
        self.wanted = False
        self._woken.set()
        return None

    def _newest(self, message: Message) -> Message:
        """The last of the messages that have come already; `message` has been accepted."""
        stream, parse, chain = self.driver.stream, self.carrier.parse, self.chain
        while message.key == DATA and stream.waiting and not (self._quit or self._reversed):
            try:
                later = parse(stream)
            except YarpError:
                break  # whoever reads next meets the same
            if later is None:
                break
            self._count(later)
            if later.key != DATA and later.key != CALL:
                self._obey(later)
                continue
            passed = later if chain is None else chain.take(later)
            if passed is None:
                self._refuse(later)
                continue
            self.counter.drops += 1
            message = passed
            self.accept(message)
        return message

    def _spin(self, deadline: float | None) -> bool:
        """Ask the socket again and again instead of sleeping; False when the time is over."""
        if self._unsent_acks:
            self._send_acks()
        driver = self.driver
        until = deadline if deadline is not None else time.monotonic() + PATIENCE
        while True:
            for _ in range(64):
                if driver.try_fill():
                    return True
            if time.monotonic() > until:
                return False

    # -- handing on -------------------------------------------------------------------------------

    def accept(self, message: Message) -> None:
        """Prepare a data message for the port: whether it can be answered, and that it must be
        acked."""
        if message.key == CALL and self.carrier.replies:
            self._answering = message
            message.answer = self._reply
        else:
            self._acknowledge(message)

    def _deliver(self, message: Message) -> None:
        if message.key == CALL and self.carrier.replies:
            self._answering = message
            message.answer = self._reply
            self.owner.receive(self, message)
            self.settle(message)
        else:
            self.owner.receive(self, message)
            self._acknowledge(message)

    def _refuse(self, message: Message) -> None:
        """A monitor dropped it: its sender is told that it came, and no more."""
        self.counter.drops += 1
        self.accept(message)
        self.settle(message)

    def settle(self, message: Message) -> None:
        """The port is done with `message`: if nobody answered a question, an empty answer goes."""
        if self._answering is not message:
            return
        message.answer = None
        self._answering = None
        # Without any answer a C++ caller takes the acknowledgement for one and waits for ever. A
        # person at a text prompt, and a name service, are told nothing rather than an empty line.
        if self.carrier.spelling == "binary" and self.carrier.acks:
            self._reply(Bottle())
        else:
            self._acknowledge(message)

    def _reply(self, value: object) -> None:
        stream = self.driver.stream
        self._owe_acks()
        self.carrier.encode_reply(stream, value)  # a TypeError leaves the question open
        self._answering = None
        if self.carrier.acks:
            self.carrier.encode_ack(stream)
        self.driver.flush()

    def _eager_for_ack(self, message: Message) -> bool:
        """Whether the sender is likely to wait: it is not let far ahead with large messages."""
        return message.spelling == "binary" and len(message.payload) >= LARGE

    def _acknowledge(self, message: Message) -> None:
        if self.carrier.acks:
            self._unsent_acks += 1
            if self._unsent_acks >= MAX_UNSENT_ACKS or self._eager_for_ack(message):
                self._send_acks()

    def _send_acks(self) -> None:
        self._owe_acks()
        self.driver.flush()

    def _owe_acks(self) -> None:
        """Put acknowledgements that were held back in front of what is written next."""
        if self._unsent_acks:
            self.carrier.encode_acks(self.driver.stream, self._unsent_acks)
            self._unsent_acks = 0

    def _obey(self, message: Message) -> None:
        """A port command that is not data."""
        carrier, stream = self.carrier, self.driver.stream
        self._owe_acks()
        self._asker = threading.get_ident()
        if message.key == "a":
            carrier.encode_reply(stream, self.owner.administer(self, message))
        elif message.key == QUIT:
            self._quit = True
        elif message.key == "r":
            self._reversed = True
        else:
            carrier.encode_lines(stream, self.owner.command(self, message))
        self._asker = 0
        if carrier.acks:
            carrier.encode_ack(stream)
        self.driver.flush()

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
        self._woken.set()
        self.driver.transport.interrupt()

    def _tell(self, error: YarpError) -> None:
        """The one log line for a connection that ends on an error."""
        if not self._closing:
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

    def _finish(self) -> None:
        try:
            self._send_acks()
        except YarpError:
            pass  # the last acknowledgements find nobody
        self.driver.transport.close()

    def snapshot(self) -> dict[str, Any]:
        """Counters as plain numbers, with the protocol's and the kernel's own losses in `drops`."""
        found: dict[str, Any] = self.counter.as_dict()
        found["drops"] += self.carrier.lost + getattr(self.driver.transport, "dropped", 0)
        return found
