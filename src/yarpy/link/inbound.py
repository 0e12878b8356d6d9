"""Inbound: a connection that brings messages to a port; one thread, or the reader's own.

Rules: the thread is the link, so its scheduling is the connection's. It reads and hands each
message to the port. A reader that is already waiting for the next message may take the turn and
read the socket itself (`borrow`), which saves the hop between threads; the thread then looks in
every few milliseconds and takes over as soon as the reader stays away.
"""

from __future__ import annotations

import logging
import threading
import time
from typing import TYPE_CHECKING, Protocol

from yarpy.data.bottle import Bottle
from yarpy.errors import LinkClosed, Timeout, YarpError
from yarpy.link.driver import Driver
from yarpy.link.receiver import PATIENCE, Receiver
from yarpy.qos import Sched
from yarpy.wire.message import CALL, DATA, QUIT, Message

if TYPE_CHECKING:
    from yarpy.carriers.base import Carrier
    from yarpy.monitors.chain import Chain

log = logging.getLogger("yarpy.link")

PARKED = 0.005  # seconds between looks while a reader has the turn


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


class Inbound(Receiver):
    """One connection into a port."""

    def __init__(self, owner: Owner, driver: Driver, carrier: Carrier) -> None:
        super().__init__(driver, carrier)
        self.owner = owner
        self.thread: threading.Thread | None = None
        self.sched = Sched()  # what somebody asked for; -1: nothing
        self.tos = 0
        self.own_chain: Chain | None = None  # the monitors that ride on it
        self.chain: Chain | None = None  # those, and the port's
        self.wanted = False  # a reader would like the turn
        self.visited = 0.0  # when a reader with the turn was last here
        self._turn = threading.Lock()  # who may read: the thread, or a reader that borrowed it
        self._woken = threading.Event()
        self._closing = False
        self._quit = False
        self._reversed = False
        self._asker = 0  # the thread that carries out a command of the peer

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

    # -- a reader with the turn -------------------------------------------------------------------

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

    def idle(self) -> bool:
        """Whether nothing has come yet; for who has the turn."""
        return not (self.driver.stream.waiting or self.carrier.holding or self.driver.try_fill())

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
                    return self._take(message, newest)
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

    def _take(self, message: Message, newest: bool) -> Message:
        """Accept a message; with `newest`, the last of those that have come already."""
        stream, parse, chain = self.driver.stream, self.carrier.parse, self.chain
        try:
            self.accept(message)
            while newest and message.key == DATA and stream.waiting:
                later = parse(stream)
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
        except YarpError:
            pass  # the sender has gone, or breaks the rules: who reads next meets it
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

    def _obey(self, message: Message) -> None:
        """A port command that is not data."""
        carrier, stream = self.carrier, self.driver.stream
        self.counter.messages -= 1  # nobody reads it
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
