"""Receiver: reads the messages of a connection one after the other, acknowledges and answers them.

Rules: one thread at a time; who that is, `Turn` says. Acknowledgements leave when
there is nothing more to read at once, so a burst costs one send; and always before what answers a
later message.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from yarpy.data.bottle import Bottle
from yarpy.errors import RemoteProtocolError, Timeout, YarpError
from yarpy.link.counter import Counter
from yarpy.link.driver import Driver
from yarpy.wire.message import CALL, QUIT, Answer, Message
from yarpy.wire.stream import LARGE

if TYPE_CHECKING:
    from collections.abc import Callable

    from yarpy.carriers.base import Carrier
    from yarpy.route import Route
    from yarpy.wire.steps import Steps

MAX_UNSENT_ACKS = 64


class Receiver:
    """The receiving end of one connection."""

    def __init__(self, driver: Driver, carrier: Carrier) -> None:
        self.driver = driver
        self.carrier = carrier
        self.route: Route = carrier.route
        self.counter = Counter(since=time.time())
        self._steps: Steps[Message] | None = None
        self._wait: float | None = None  # seconds that each wait for bytes may take
        self._begun = 0.0  # when a message that must hurry began to come; 0: none has
        self._unsent_acks = 0
        self.question: Answer | None = None  # is open: nothing is read before it is answered

    # -- reading ----------------------------------------------------------------------------------

    def advance(self, deadline: float | None) -> Message:
        """The next message. Raises Timeout (what came is kept), LinkClosed."""
        driver = self.driver
        carrier = self.carrier
        message = None
        if self._steps is None and (driver.stream.waiting or carrier.holding):
            message = carrier.parse(driver.stream)
            if message is None:
                self._steps = carrier.decode(driver.stream)
        while message is None:
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
                self.send_acks()
            if carrier.finished:
                message = Message(QUIT)
                break
            if carrier.hurry is None:
                driver.fill(deadline)
            else:
                self._fill_in_time(carrier.hurry, deadline)
            if self._steps is None:
                message = carrier.parse(driver.stream)
                if message is None:  # there is a part of it, or the end; `decode` says which
                    self._steps = carrier.decode(driver.stream)
        if self._begun:
            self._forget_hurry()
        self.count(message)
        return message

    @property
    def waiting(self) -> bool:
        """Whether some of the next message has come already."""
        return bool(self.driver.stream.waiting) or self.carrier.holding

    def count(self, message: Message) -> None:
        """Number a message, and name its sender."""
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
            if self._wait is None or left < self._wait:
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
            self.limit(self._wait)

    def limit(self, seconds: float | None) -> None:
        """Let each wait for bytes take so long."""
        self._wait = seconds
        try:
            self.driver.transport.limit_waiting(seconds)
        except OSError:
            pass  # closed meanwhile; reading tells

    # -- answering --------------------------------------------------------------------------------

    def open_question(self, message: Message) -> bool:
        """Give a question its way back; False if `message` is none."""
        if message.key != CALL or not self.carrier.replies:
            return False
        self.question = message.answer = Answer(self._reply)
        return True

    def settle(self, message: Message) -> None:
        """The port is done with `message`: it is acknowledged, or answered if nobody did that."""
        answer = message.answer
        if answer is not None:
            if answer is not self.question:
                return  # answered in time, or long ago
            answer.open = False
            self.question = None
            # Without any answer a caller waits for ever; one in C++ takes the acknowledgement for
            # it. A person at a text prompt, a name service, and a page are told nothing rather than
            # that.
            if self.carrier.spelling != "text" and not self.carrier.lossy:
                self._reply(Bottle())
                return
        if self.carrier.acks:
            self._unsent_acks += 1
            # The sender of a large message is likely to wait: it is not let far ahead.
            if self._unsent_acks >= MAX_UNSENT_ACKS or (
                message.spelling == "binary" and len(message.payload) >= LARGE
            ):
                self.send_acks()

    def refuse(self, message: Message) -> None:
        """A monitor dropped it: its sender is told that it came, and no more."""
        self.counter.drops += 1
        self.open_question(message)
        self.settle(message)

    def obey(
        self, message: Message, answer: Callable[[Message], Bottle | list[str] | None]
    ) -> None:
        """A port command: what `answer` says to it goes back, and its acknowledgement."""
        carrier, stream = self.carrier, self.driver.stream
        self.counter.messages -= 1  # nobody reads it
        self._owe_acks()
        answered = answer(message)
        if isinstance(answered, Bottle):
            carrier.encode_reply(stream, answered)
        elif answered is not None:
            carrier.encode_lines(stream, answered)
        if carrier.acks:
            carrier.encode_ack(stream)
        self.driver.flush()

    def _reply(self, value: object) -> None:
        stream = self.driver.stream
        self._owe_acks()
        self.carrier.encode_reply(stream, value)  # a TypeError leaves the question open
        self.question = None
        if self.carrier.acks:
            self.carrier.encode_ack(stream)
        self.driver.flush()

    def send_acks(self) -> None:
        """Acknowledge what was held back, and send what else was written."""
        if self._unsent_acks:
            self.carrier.encode_acks(self.driver.stream, self._unsent_acks)
            self._unsent_acks = 0
        self.driver.flush()

    def finish(self) -> None:
        """The last acknowledgements, and the end."""
        try:
            self.send_acks()
        except YarpError:
            pass  # they find nobody
        self.driver.transport.close()

    def _owe_acks(self) -> None:
        """Put acknowledgements that were held back in front of what is written next."""
        if self._unsent_acks:
            self.carrier.encode_acks(self.driver.stream, self._unsent_acks)
            self._unsent_acks = 0
