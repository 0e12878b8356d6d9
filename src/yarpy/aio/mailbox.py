"""Mailboxes of an event loop's ports, with a bell for the loop.

Rules: the mailboxes are those of other ports. Tasks share a thread, so a question does not end with
the next `read` of its thread, but when it is answered or nobody holds its message any more.
"""

from __future__ import annotations

from collections.abc import Callable

from yarpy.port.mailbox import Offer, Rendezvous
from yarpy.wire.message import Answer, Message


class TaskRendezvous(Rendezvous):
    """A plain port: each connection waits until its message was taken, and answered if it asks."""

    def __init__(self) -> None:
        super().__init__()
        self._asked: set[Offer] = set()  # questions that were read and not answered yet

    def _next(self, token: object) -> Message | None:
        assert isinstance(token, Offer)
        message = token.message
        answer = message.answer
        if answer is None:
            token.done.wake()
            return message

        def over() -> None:
            self._asked.discard(token)
            token.leave()

        self._asked.add(token)
        # The reader gets a copy, since the connection's thread holds on to the original. Once the
        # copy is garbage, nobody is left who could answer.
        copy = message.replaced(message.payload)
        copy.spelling, copy.answer = message.spelling, _Reply(answer, over)
        if self.closed:  # `close` may have looked before it was there
            self._forsake(message)
            over()
        return copy

    def close(self) -> None:
        super().close()
        for offer in tuple(self._asked):
            self._asked.discard(offer)
            self._forsake(offer.message)
            offer.leave()


class _Original:
    """Answers the question that a copy was made of."""

    def __init__(self, answer: Answer) -> None:
        self._answer = answer

    @property
    def yarp4(self) -> bool:
        return self._answer.by.yarp4

    @yarp4.setter
    def yarp4(self, yarp4: bool) -> None:
        self._answer.by.yarp4 = yarp4

    def reply(self, value: object) -> None:
        self._answer.give(value)


class _Reply(Answer):
    """The way back of one question; its connection goes on when it is used or forgotten."""

    __slots__ = ()

    def __init__(self, answer: Answer, then: Callable[[], None]) -> None:
        super().__init__(_Original(answer), then)

    def __del__(self) -> None:
        if self.then is not None:
            self.then()
