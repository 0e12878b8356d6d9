"""The parts that nodes of ROS 2 need whatever carries their messages.

    Worker       a thread that takes what comes for several endpoints, one after the other, or some
    Question     what a service is asked, with the way back

Rules: an answer is an object of the response type, or a list or dict of its fields. Futures are
those of `concurrent.futures`.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Future
from queue import Empty, Full, Queue
from typing import Any, Final, Protocol

from yarpy.errors import DecodeError, Timeout
from yarpy.limit import ROS2_QUESTIONS
from yarpy.log import log_failure, logger
from yarpy.monitors.base import FAILURES
from yarpy.peers.ros.message.message import Message
from yarpy.peers.ros2.carrier import Incoming, Outgoing

log = logger("yarpy.ros2")

SLICE: Final = 0.2  # seconds of each wait, after which the end is looked for


class Serving(Protocol):
    """An endpoint that gives answers."""

    kind: Any
    name: str
    dropped: int

    def give(self, item: Outgoing) -> None: ...

    def ended(self) -> bool: ...


class Worker:
    """Takes what comes, one item after the other, until `close`; with more threads, as many side by
    side. `name` is that of all of them. Raises ValueError for less than one."""

    def __init__(self, name: str, threads: int = 1) -> None:
        if threads < 1:
            raise ValueError(f"{threads} threads answer nothing: say 1 or more")
        self._name = name
        self._queue: Queue[tuple[Callable[[Any], None], Any]] = Queue(ROS2_QUESTIONS)
        self._over = False
        self.threads = [
            threading.Thread(target=self._run, name=name, daemon=True) for _ in range(threads)
        ]
        for thread in self.threads:
            thread.start()

    def put(self, act: Callable[[Any], None], item: Any) -> bool:
        """Let `act(item)` be called; return False if too much waits already."""
        try:
            self._queue.put_nowait((act, item))
        except Full:
            return False
        return not self._over

    def _run(self) -> None:
        while not self._over:
            try:
                act, item = self._queue.get(timeout=SLICE)
            except Empty:
                continue
            try:
                act(item)
            except FAILURES as error:
                log_failure(log, error, "%s: a callback failed", self._name)

    def close(self) -> None:
        """Let the threads end. Idempotent."""
        self._over = True


class Question:
    """Of a service: `request`, an object of its type, and the way back, which `answer` and `fail`
    take, once, in any thread."""

    def __init__(self, server: Serving, request: Any, asked: Any) -> None:
        self.request = request
        self._server = server
        self._asked = asked

    def answer(self, value: Any) -> None:
        """Answer it. Raises TypeError, ValueError, DecodeError for what is no response."""
        kind = self._server.kind
        if not isinstance(value, Message):
            value = kind.Response.from_bottle(value)
        self._give(Outgoing(kind, value.to_ros(), to=self._taken()))

    def fail(self, why: str) -> None:
        """Tell who asked that there is no answer."""
        self._give(Outgoing(self._server.kind, (), to=self._taken(), failure=why or "it failed"))

    def _taken(self) -> Any:
        asked, self._asked = self._asked, None
        return asked

    def _give(self, item: Outgoing) -> None:
        if item.to is not None and not self._server.ended():
            self._server.give(item)


def answer_with(
    server: Serving, handler: Callable[[Question], None], item: Incoming, node: object
) -> None:
    """Let `handler` answer a question that came; what it raises is told to who asked."""
    question = Question(server, None, item.asked)
    try:
        question.request = server.kind.Request.from_ros(item.body)
        handler(question)
    except DecodeError as error:
        server.dropped += 1
        question.fail(str(error))
    except FAILURES as error:
        log_failure(log, error, "%s: the handler of %s failed", node, server.name)
        question.fail(f"{type(error).__name__}: {error}")


def result_of(future: Future[Any], timeout: float | None, name: str) -> Any:
    """Return what a future has within so many seconds. Raises Timeout, and what it failed with."""
    try:
        return future.result(timeout)
    except TimeoutError as error:
        if future.done():
            raise
        raise Timeout(f"{name} did not answer within {timeout} s") from error
