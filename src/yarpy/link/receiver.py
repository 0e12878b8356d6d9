"""Receiver: reads the messages of a connection one after the other, acknowledges and answers them.

Rules: one thread at a time; who that is, is the business of `Inbound`. Acknowledgements leave when
there is nothing more to read at once, so a burst costs one send; and always before what answers a
later message.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

from yarpy.data.bottle import Bottle
from yarpy.errors import RemoteProtocolError, Timeout
from yarpy.link.counter import Counter
from yarpy.link.driver import Driver
from yarpy.wire.message import CALL, QUIT, Message
from yarpy.wire.stream import LARGE

if TYPE_CHECKING:
    from yarpy.carriers.base import Carrier
    from yarpy.route import Route
    from yarpy.wire.effects import Steps

PATIENCE = 0.02  # seconds a reader with the turn waits before it looks around
MAX_UNSENT_ACKS = 64


class Receiver:
    """The receiving end of one connection."""

    def __init__(self, driver: Driver, carrier: Carrier) -> None:
        self.driver = driver
        self.carrier = carrier
        self.route: Route = carrier.route
        self.counter = Counter(since=time.time())
        self._steps: Steps[Message] | None = None
        self._leaving = False  # the thread of the connection leaves the turn to a reader
        self._begun = 0.0  # when a message that must hurry began to come; 0: none has
        self._unsent_acks = 0
        self._answering: Message | None = None

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

    def _limit(self, seconds: float | None) -> None:
        """Let each wait for bytes take so long; None: as long as the carrier has patience."""
        if seconds is None:
            seconds = self.carrier.patience
        try:
            self.driver.transport.limit_waiting(seconds)
        except OSError:
            pass  # closed meanwhile; reading tells

    # -- answering --------------------------------------------------------------------------------

    def accept(self, message: Message) -> None:
        """Prepare a data message for the port: whether it can be answered, and that it must be
        acked."""
        if message.key == CALL and self.carrier.replies:
            self._answering = message
            message.answer = self._reply
        else:
            self._acknowledge(message)

    def settle(self, message: Message) -> None:
        """The port is done with `message`: if nobody answered a question, an empty answer goes."""
        if self._answering is not message:
            return
        message.answer = None
        self._answering = None
        # Without any answer a caller waits for ever; one in C++ takes the acknowledgement for it. A
        # person at a text prompt, a name service, and a page are told nothing rather than that.
        if self.carrier.spelling != "text" and not self.carrier.lossy:
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

    def snapshot(self) -> dict[str, Any]:
        """Counters as plain numbers, with the protocol's and the kernel's own losses in `drops`."""
        found: dict[str, Any] = self.counter.as_dict()
        found["drops"] += self.lost
        return found

    @property
    def lost(self) -> int:
        """What the protocol and the kernel lost on the way."""
        dropped: int = getattr(self.driver.transport, "dropped", 0)
        return self.carrier.lost + dropped
