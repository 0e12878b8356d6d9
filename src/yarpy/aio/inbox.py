"""From the thread of a connection into the loop: the mailbox that leads there, and what arrives.

Rules: the connection's thread waits until its message may be followed by another: until there is
room, or until a question was answered or forgotten.
"""

from __future__ import annotations

import threading
from collections.abc import Callable

from yarpy.errors import PortClosed
from yarpy.link.inbound import Inbound
from yarpy.port.mailbox import Mailbox
from yarpy.wire.message import Answer, Message


class Door(Mailbox):
    """Hands each message to the loop, in the thread of its connection."""

    def __init__(self, take: Callable[[Inbound, Message], bool]) -> None:
        super().__init__()
        self._take = take

    def put(self, link: Inbound, message: Message) -> None:
        if self.stopped or not self._take(link, message):
            with self._gate:
                self._drop(link)

    def take(self, timeout: float | None = None) -> Message | None:
        raise PortClosed("this port is read in its event loop")


class Arrival:
    """A message and the connection's thread that may be waiting for room, or for a reply."""

    def __init__(self, link: Inbound, message: Message) -> None:
        self._link = link
        self._keep = message.wants_reply  # a question: its connection waits for the answer
        self._done = threading.Event()
        self._message: Message | None = message
        answer = message.answer
        if answer is not None:
            # The reader gets a copy, since the connection's thread holds on to the original. Once
            # the copy is garbage, nobody is left who could answer.
            reply = _Reply(answer.give, self._done.set)
            self._message = message.replaced(message.payload)
            self._message.spelling, self._message.answer = message.spelling, reply

    def hand_out(self) -> Message:
        """The message, once: from now on it is the reader's."""
        message, self._message = self._message, None
        assert message is not None
        return message

    def drop(self) -> None:
        """It will not be read: count it as dropped."""
        self._link.counter.drops += 1
        self.release()

    @property
    def done(self) -> bool:
        """Whether its connection may go on."""
        return self._done.is_set()

    def wait(self) -> None:
        """Wait, in the connection's thread, until it may go on."""
        self._done.wait()

    def go_on(self) -> None:
        """There is room; a question still waits for its answer."""
        if not self._keep:
            self._done.set()

    def release(self) -> None:
        """Nobody will answer or read it any more."""
        self._done.set()


class _Reply(Answer):
    """The way back of one question; its connection goes on when it is used or forgotten."""

    __slots__ = ()

    def __del__(self) -> None:
        if self.then is not None:
            self.then()
