"""Receiver: reads the messages of a connection one after the other, acknowledges and answers them.

Rules: one thread at a time; `Turn` says which. Acknowledgements leave when there is nothing more to
read at once, so a burst costs one send; and always before the answer to a later message. A message
that has begun must come along (`Incoming`); a time limit that a wait got for that stays until it is
over in vain, so that a stream of messages pays for one.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from yarpy.carriers.base import Carrier
from yarpy.data.bottle import Bottle
from yarpy.data.failure import raised
from yarpy.data.yarp4 import is_yarp4
from yarpy.errors import (
    DecodeError,
    LinkClosed,
    LocalProtocolError,
    RemoteProtocolError,
    Timeout,
    YarpError,
)
from yarpy.link.counter import Counter
from yarpy.link.driver import Driver
from yarpy.link.receive.incoming import Incoming
from yarpy.link.send.slow_reader import STRANGERS
from yarpy.log import logger
from yarpy.wire.aside_stream import AsideStream
from yarpy.wire.effects import Claim, Flush, May, Show, Within
from yarpy.wire.message import CALL, DATA, Answer, Message, in_yarp4, mark_unsent
from yarpy.wire.stream import LARGE, ByteStream

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from yarpy.route import Route
    from yarpy.wire.steps import Effect, Steps

log = logger("yarpy.link")

MAX_UNSENT_ACKS = 64
# How far a message is that is held: read, counted, let through by monitors, acknowledged or asked.
FRESH, COUNTED, PASSED, SETTLED = range(4)
TELLING = 1 << 16  # bytes of a question that is looked through
LEAST = 1 << 16  # bytes of answers that a peer must take within STRANGERS seconds


class Receiver:
    """The receiving end of one connection."""

    def __init__(self, driver: Driver, carrier: Carrier) -> None:
        self.driver = driver
        self.carrier = carrier
        self.acks = carrier.acks
        self.route: Route = carrier.route
        self.counter = Counter(since=time.time())
        stream = driver.stream
        self._beside = stream if isinstance(stream, AsideStream) else None
        self.page: Callable[[str, Mapping[str, str]], object] = (
            _no_page  # the program's, for `Show`
        )
        # A message that was read and that the port does not have yet, and how far it is. When a
        # reader is interrupted, whoever reads next goes on with it. `spare`: one that it replaces.
        self.held: Message | None = None
        self.stage: int = FRESH
        self._cut = False  # the steps that read a message were interrupted, and are gone
        self.spare: Message | None = None
        self.question: Answer | None = None  # open: nothing is read before it is answered
        self.yarp4 = False  # answers are spelled as YARP 4 does
        #: nothing that the peer has said tells how to spell them
        self._unsure = carrier.spelling == "binary" and not carrier.reaches.foreign
        self.guess: Callable[[], bool] = _older  # whether it is of YARP 4, then
        self._steps: Steps[Message] | None = None
        self._parses = type(carrier).parse is not Carrier.parse
        self.incoming = Incoming(
            None if carrier.delivery.connectionless else carrier.limits.message_timeout,
            lambda: driver.transport.interrupt(),
            lambda: driver.stream.forget(),
        )
        self._begins = 0  # how many bytes had come before the message that `_steps` read
        self._wait: float | None = None  # seconds that each wait for bytes may take
        self._armed = False  # a wait is limited for the sake of a message that had begun
        self._due = 0.0  # deadline of a message that has begun; 0: none has
        self._unsent_acks = 0
        self._paced = 0.0  # when a message came whose pace is not measured yet; 0: none

    @property
    def heard(self) -> float:
        """Return when the last message came, by time.perf_counter; 0.0: none has."""
        return self._paced or self.counter.last

    # -- reading ----------------------------------------------------------------------------------

    def advance(self, deadline: float | None) -> Message:
        """Return the next message, which stays `held` until it is released. Raises Timeout (what
        came is kept), LinkClosed."""
        driver, carrier = self.driver, self.carrier
        if self._paced:  # now, while the peer has its answer
            self.counter.count(self._paced, 0)
            self._paced = 0.0
        if self._cut:
            self._begin_again()
        if self.held is None and self.spare is not None:
            self.recall()
        if self.held is None and self._steps is None:
            stream = driver.stream
            come = stream.tail > stream.head or (
                type(stream) is not ByteStream and stream.waiting > 0  # such as datagrams
            )
            if come:
                self.held = carrier.parse(driver.stream)
            elif self._unsent_acks and not self._parses:
                self.send_acks()
            if self.held is None and (come or not self._parses):
                self._steps = self._decode()
        while self.held is None:
            if self._steps is not None:
                try:
                    effect = next(self._steps)
                    while effect is not None:
                        effect = self._steps.send(self._perform(effect))
                except StopIteration as stop:
                    self.held = stop.value
                    self._steps = None
                    break
                except YarpError as error:
                    self._steps = None  # the next read meets the same end
                    if self.incoming.reason:
                        raise RemoteProtocolError(self.incoming.reason) from error
                    raise
                except BaseException:
                    self._steps, self._cut = None, True
                    raise
            if self._unsent_acks:
                carrier.encode_ack(driver.stream, self._unsent_acks)  # as `send_acks`, spelled out
                self._unsent_acks = 0
            if driver.stream.output and not driver.push():
                self._flush()
            if self._due:
                self._fill_in_time(deadline)
            elif self._steps is not None and (
                driver.bytes_in > self._begins if not driver.stream.paused else self._is_begun()
            ):
                self._fill_on(deadline)
            else:
                try:
                    driver.fill(deadline)
                except Timeout:
                    if not self._armed:
                        raise
                    self.limit(None)  # no message has begun: the silence may last
                    continue
            if self._steps is None:
                self.held = carrier.parse(driver.stream)
                if self.held is None:  # there is a part of it, or the end; `decode` says which
                    self._steps = self._decode()
        if self._due:
            self._allow(None)
        self.incoming.since = 0.0  # whole
        if driver.stream.mark >= 0:
            driver.stream.finish()
        message = self.held
        if self.stage == FRESH:
            if not message.source:  # a subscription to many topics knows better
                message.source = self.route.source
            counter = self.counter
            counter.bytes = driver.bytes_in
            if self._beside is not None:
                counter.bytes += self._beside.came_aside
            self._paced = time.perf_counter()
            counter.messages += 1
            self.stage = COUNTED  # at once, that no message is counted twice
        return message

    def _begin_again(self) -> None:
        """Read a message from its beginning: the steps that read it were interrupted."""
        if not self.driver.stream.rewind():
            self.tear()
        self._cut = False

    def parse_newer(self) -> bool:
        """Hold the next message instead of the one that is held, if it is there whole. The other
        becomes `spare`."""
        older = self.held
        # In one step for signals: neither is held twice, or not at all.
        self.held, self.stage, self.spare = self.carrier.parse(self.driver.stream), FRESH, older
        if self.held is not None:
            return True
        self.held, self.stage, self.spare = older, SETTLED, None
        return False

    def recall(self) -> None:
        """Hold the spare message again, if there is one."""
        if self.spare is not None:
            self.held, self.stage, self.spare = self.spare, SETTLED, None

    def release(self) -> None:
        """The port has the message that was held."""
        self.held, self.stage = None, FRESH
        if self.spare is not None:
            self.spare = None
            self.counter.drops += 1

    def tear(self) -> None:
        """End the connection: an exception out of a signal handler came where what was under way
        can neither be finished nor begun again."""
        self.incoming.end("its reader was interrupted in the middle of a message")

    def _decode(self) -> Steps[Message]:
        """Begin to read a message."""
        self._pause()
        self.driver.stream.begin()
        return self.carrier.decode(self.driver.stream)

    def _pause(self) -> None:
        """No message is under way; what waits in the stream is of the next one."""
        self.incoming.since = 0.0
        self.driver.stream.paused = False
        self._begins = self.driver.bytes_in - self.driver.stream.waiting

    @property
    def waiting(self) -> bool:
        """Return whether part of the next message may have arrived already."""
        held = self._steps is None and not self._parses
        return held or bool(self.driver.stream.waiting)

    def _perform(self, effect: Effect) -> object:
        if isinstance(effect, Within):
            self._allow(effect.seconds)
            return None
        if isinstance(effect, Flush):
            self.send_acks()
            return None
        if isinstance(effect, Show):
            return self.page(effect.path, effect.fields)
        if isinstance(effect, May | Claim):
            return self.driver.judge(effect)
        raise LocalProtocolError(f"{effect} is nothing that a message can ask for")

    def _allow(self, seconds: float | None) -> None:
        """A message has begun and must end within `seconds`; None: none has begun."""
        if seconds is not None:
            self._due = time.monotonic() + seconds
            return
        self._pause()
        if self._due:
            self._due = 0.0
            self.limit(self._wait)

    def _is_begun(self) -> bool:
        """Return whether part of a message has arrived after the last one that was read."""
        self._pause()
        self.driver.stream.begin()
        return self.driver.bytes_in > self._begins

    def _fill_on(self, deadline: float | None) -> None:
        """Wait for more bytes of a message, and see that it comes along."""
        driver, incoming = self.driver, self.incoming
        incoming.advance(driver.bytes_in - self._begins)
        if self._wait is None and not self._armed and incoming.silence is not None:
            self._armed = True
            driver.transport.limit_waiting(incoming.silence, sends=False)
        try:
            driver.fill(deadline)
        except Timeout:
            incoming.wait()
            raise

    def _fill_in_time(self, deadline: float | None) -> None:
        """Wait for more bytes of a message, but no longer than it may take."""
        left = self._due - time.monotonic()
        try:
            if left <= 0:
                raise Timeout("the peer is too slow")
            if self._wait is None or left < self._wait:
                self.driver.transport.limit_waiting(left)
            self.incoming.advance(self.driver.bytes_in - self._begins)
            # As a deadline: that limit of the system's begins anew behind each signal.
            self.driver.fill(self._due if deadline is None else min(deadline, self._due))
        except Timeout as error:
            steps = self._steps
            if steps is not None and time.monotonic() > self._due - 0.01:
                self._steps = None
                told = self.driver.tell_late(steps, error)
                if isinstance(told, Timeout):
                    told = RemoteProtocolError("the peer sends a message too slowly")
                raise told from error
            raise

    def limit(self, seconds: float | None) -> None:
        """Limit each wait for bytes to `seconds`."""
        self._wait = seconds
        self._armed = False
        self.driver.transport.limit_waiting(seconds)

    # -- answering --------------------------------------------------------------------------------

    def open_question(self, message: Message) -> bool:
        """Give a question its way back; False if `message` is none."""
        if message.key != CALL or not self.carrier.replies:
            return False
        self.question = message.answer = Answer(self)
        if self._unsure:
            self._learn(message)
        return True

    def _learn(self, message: Message) -> None:
        """Find out by a question how to spell the answers. Where it holds no floats, one that is
        decoded later may tell (`Answer.note_yarp4`)."""
        found = None
        if message.spelling == "binary" and len(message.payload) <= TELLING:
            try:
                found = is_yarp4(message.payload)
            except DecodeError:
                pass
        self.yarp4 = self.guess() if found is None else found
        self._unsure = found is None and self.yarp4

    def settle(self, message: Message) -> bool:
        """The port is done with `message`: it is acknowledged, or, if still open, answered. Return
        False if another thread is answering, who alone may write."""
        answer = message.answer
        if answer is not None:
            if answer is not self.question:
                return True  # answered in time, or long ago
            try:
                del answer.right[0]  # as `Answer.give`
            except IndexError:
                return answer is not self.question
            # Without any answer a caller waits for ever; one in C++ takes the acknowledgement for
            # it. For a person at a text prompt, a name service or a page, silence is better than an
            # empty answer.
            carrier = self.carrier
            try:
                if answer.forsaken and carrier.reaches.topic:  # where others ask, too
                    self.reply(raised("PortClosed", "the port is interrupted, or closes"))
                    return True
                if answer.forsaken:
                    self.question = None
                    raise LinkClosed("the port was interrupted or closed before it had answered")
                if carrier.spelling != "text" and not carrier.delivery.lossy:
                    self.reply(Bottle())
                    return True
                self.question = None
            finally:
                if answer is self.question:  # interrupted: whoever comes next closes it
                    answer.right.append(True)
        if self.carrier.acks:
            self._unsent_acks += 1
            if self.held is message:
                self.stage = SETTLED
            # The sender of a large message is likely to wait: acknowledge soon.
            if self._unsent_acks >= MAX_UNSENT_ACKS or (
                message.spelling == "binary" and len(message.payload) >= LARGE
            ):
                self.send_acks()
        return True

    def refuse(self, message: Message) -> None:
        """A monitor dropped it: its sender gets an acknowledgement and no more."""
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
            # As C++ does behind an answer to a node, before it hangs up.
            carrier.encode_ack(stream, 2 if getattr(answered, "is_last", False) else 1)
        self._flush()

    def reply(self, value: object) -> None:
        """Answer the open question."""
        driver, stream = self.driver, self.driver.stream
        if self._unsent_acks:
            self._owe_acks()
        try:
            if self.yarp4:
                value = in_yarp4(value)
            self.carrier.encode_reply(stream, value)
        except Exception as error:
            mark_unsent(error)  # which leaves the question open
            raise
        except BaseException:
            self.tear()
            self.question = None
            raise
        try:
            if self.carrier.acks:
                self.carrier.encode_ack(stream, 1)
            if not driver.push():
                self._flush()
        except YarpError:
            raise
        except BaseException:
            self.tear()
            raise
        finally:
            self.question = None  # not before: a port that closes waits for that

    def send_acks(self) -> None:
        """Acknowledge what was held back, and send what else was written."""
        if not self.try_acks():
            self._flush()

    def try_acks(self) -> bool:
        """As `send_acks`, as far as that needs no waiting; return whether all has left."""
        if self._unsent_acks:
            self.carrier.encode_ack(self.driver.stream, self._unsent_acks)
            self._unsent_acks = 0
        return self.driver.push()

    def _flush(self) -> None:
        """Send what was written. Who dialled us and does not read must not keep a thread of the
        program waiting: LinkClosed for a peer that takes less than LEAST bytes in its time."""
        driver = self.driver
        if driver.push():
            return
        while True:
            before = driver.bytes_out
            try:
                driver.flush(time.monotonic() + STRANGERS)
                return
            except Timeout as error:
                if driver.bytes_out - before < LEAST:
                    why = f"it did not take an answer within {STRANGERS:g} s"
                    log.warning(
                        "%s: %s does not read, and is disconnected: %s",
                        self.route.target,
                        self.route.source or "somebody",
                        why,
                    )
                    driver.transport.interrupt()
                    raise LinkClosed(f'"{self.route.source}" is gone: {why}') from error
            except LinkClosed:
                raise
            except BaseException:
                self.tear()
                raise

    def finish(self) -> None:
        """The last acknowledgements, unless another thread writes an answer, and the end."""
        try:
            if self._ends_question():
                self.send_acks()
        except YarpError:
            pass  # the peer has gone
        self.close()
        self.incoming.leave()

    def _ends_question(self) -> bool:
        """Let nobody answer any more; return False if a thread is at it."""
        question = self.question
        if question is not None:
            try:
                del question.right[0]
            except IndexError:
                return False
            self.question = None
        return True

    def close(self) -> int:
        """Hang up; return how many messages had come that nobody reads: they are counted."""
        left = (one for one in self.driver.close() if isinstance(one, Message))
        lost = sum(one.key in (DATA, CALL) for one in left)
        self.counter.messages += lost
        self.counter.drops += lost
        return lost

    def _owe_acks(self) -> None:
        """Put acknowledgements that were held back in front of what is written next."""
        if self._unsent_acks:
            self.carrier.encode_ack(self.driver.stream, self._unsent_acks)
            self._unsent_acks = 0


def _older() -> bool:
    """Nobody says that peers are of YARP 4."""
    return False


def _no_page(path: str, fields: Mapping[str, str]) -> None:
    """No program shows anything."""
