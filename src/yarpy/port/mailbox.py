"""Mailboxes: what a port does with messages between their arrival and somebody's reading.

Rules: `put` runs in the thread of the connection and may make it wait; `take` runs in the reader's.
Messages of dropped turns are counted on the link that brought them. After `interrupt` everything
that comes is dropped, and readers get PortClosed, until `resume`.
"""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable
from queue import Empty, SimpleQueue
from typing import ClassVar, Final, TypeAlias

from yarpy.errors import PortClosed, YarpError
from yarpy.link.inbound import Inbound
from yarpy.log import logger
from yarpy.wire.message import Message

log = logger("yarpy.port")

FIFO_BYTES: Final = 1 << 28  # what a strict reader may be behind before its senders have to wait
OVERHEAD: Final = 256  # bytes that a message takes besides its payload, as measured, rounded up
SAMPLE: Final = 32  # elements of a list by which its size is judged

_STOP: Final = object()


class Mailbox:
    """The common part: a queue of tokens that wakes readers, and its stop and go."""

    blocks: ClassVar[bool] = False  # a sender waits until its message was read

    def __init__(self) -> None:
        self.stopped = False
        self.drops = 0
        self._why = "the port was closed or interrupted while reading"
        self.held: dict[threading.Thread, Question] = {}  # questions of readers, by their thread
        self._ready: SimpleQueue[object] = SimpleQueue()
        # A message goes in, or the mailbox stops: what came in between would wait for ever.
        self._gate = threading.Lock()

    def put(self, link: Inbound, message: Message) -> None:
        """Take a message that came over `link`."""
        raise NotImplementedError

    def take(self, timeout: float | None = None) -> Message | None:
        """The next message; None when `timeout` seconds are over. Raises PortClosed."""
        try:
            token = self._ready.get(True, timeout)
        except (Empty, ValueError):
            return None
        if token is _STOP:
            if self.stopped:
                self._ready.put(_STOP)  # for the next reader
                raise PortClosed(self._why)
            return self.take(timeout)  # left over from an interrupt that was resumed
        return self._next(token)

    def poll(self) -> Message | None:
        """A message that is already there, or None."""
        if self._ready.empty():
            return None
        return self.take(0)

    def keep(self, link: Inbound, message: Message) -> None:
        """A question was read directly; here nobody is let take time to answer it."""
        link.leave(message)

    def settle(self) -> None:
        """This thread is done with the message it took last."""

    @property
    def waiting(self) -> int:
        """Messages that came and were not taken."""
        return 0 if self.stopped else self._ready.qsize()

    def interrupt(self) -> None:
        """Drop what waits and what comes; readers get PortClosed."""
        with self._gate:
            self.stopped = True
            self._clear()
            self._ready.put(_STOP)

    def resume(self) -> None:
        """Undo `interrupt`."""
        with self._gate:
            self._clear()
            self.stopped = False

    def surrender(self) -> list[tuple[Inbound, Message]]:
        """What waits here, for another mailbox."""
        return []

    def abandon(self, why: str) -> None:
        """Stop for ever, in a process where threads that had a lock may be missing."""
        self._gate = threading.Lock()
        self._ready = SimpleQueue()
        self._why = why
        self.stopped = True
        self._ready.put(_STOP)

    def _next(self, token: object) -> Message | None:
        raise NotImplementedError

    def _clear(self) -> None:
        while True:
            try:
                token = self._ready.get_nowait()
            except Empty:
                return
            if token is not _STOP:
                self._discard(token)

    def _discard(self, token: object) -> None:
        self.drops += 1

    def _drop(self, link: Inbound) -> None:
        """Count a drop; inside the gate, since several connections may."""
        self.drops += 1
        link.counter.drops += 1


class Latest(Mailbox):
    """Only the newest message is kept; an older one that nobody took is dropped and counted."""

    def __init__(self) -> None:
        super().__init__()
        self._item: tuple[Inbound, Message] | None = None  # changed inside the gate only

    def put(self, link: Inbound, message: Message) -> None:
        with self._gate:
            if self.stopped:
                self._drop(link)
                return
            older, self._item = self._item, (link, message)
            if older is None:
                self._ready.put(None)  # exactly one token while there is an item
            else:
                self._drop(older[0])

    def surrender(self) -> list[tuple[Inbound, Message]]:
        with self._gate:
            item, self._item = self._item, None
        return [item] if item else []

    def _next(self, token: object) -> Message | None:
        with self._gate:
            item, self._item = self._item, None
        return item[1] if item else None

    def _discard(self, token: object) -> None:
        item, self._item = self._item, None
        if item:
            self._drop(item[0])


class Fifo(Mailbox):
    """Every message, in order. When a reader is too far behind, senders wait: nothing is lost."""

    def __init__(self, limit: int = FIFO_BYTES) -> None:
        super().__init__()
        self._limit = limit
        self._bytes = 0
        self._room = threading.Condition()  # guards the byte count, and lets senders wait

    def put(self, link: Inbound, message: Message) -> None:
        payload = message.payload
        size = OVERHEAD + (len(payload) if message.spelling != "object" else memory(payload))
        with self._room:
            if self._bytes > self._limit:
                self._room.wait_for(lambda: self._bytes <= self._limit or self.stopped)
            self._bytes += size
        with self._gate:
            if not self.stopped:
                self._ready.put((size, link, message))
                return
            self._drop(link)
        self._free(size)

    def surrender(self) -> list[tuple[Inbound, Message]]:
        found = []
        with self._gate:
            while not self.stopped and not self._ready.empty():
                token = self._ready.get_nowait()
                assert isinstance(token, tuple)
                found.append(token[1:])
                self._free(token[0])
        return found

    def _next(self, token: object) -> Message | None:
        assert isinstance(token, tuple)
        self._free(token[0])
        message: Message = token[2]
        return message

    def _discard(self, token: object) -> None:
        assert isinstance(token, tuple)
        self._free(token[0])
        self._drop(token[1])

    def _free(self, size: int) -> None:
        with self._room:
            full = self._bytes > self._limit
            self._bytes -= size
            if full:
                self._room.notify_all()

    def interrupt(self) -> None:
        super().interrupt()
        with self._room:
            self._room.notify_all()


def memory(value: object, depth: int = 3) -> int:
    """About how many bytes an object takes that came as it is, over the carrier local."""
    size = max(sys.getsizeof(value, 0), int(getattr(value, "nbytes", 0)))
    if isinstance(value, list | tuple):
        some = value[:SAMPLE] if depth else ()
        if some:
            size += sum(memory(one, depth - 1) for one in some) * len(value) // len(some)
    elif hasattr(value, "to_wire"):
        size += sum(memoryview(block).nbytes for block in value.to_wire())
    return size


class Offer:
    """A message whose connection waits until the reader is done with it."""

    __slots__ = ("done", "link", "message")

    def __init__(self, link: Inbound, message: Message) -> None:
        self.link = link
        self.message = message
        self.done = threading.Event()
        if message.answer is not None:
            message.answer.then = self.done.set

    def leave(self) -> None:
        """The reader is done with it; the connection's thread closes the question."""
        self.done.set()


class Read:
    """A question that a reader took from the socket itself, and is not done with."""

    __slots__ = ("link", "message")

    def __init__(self, link: Inbound, message: Message) -> None:
        self.link = link
        self.message = message

    def leave(self) -> None:
        """The reader is done with it."""
        self.link.leave(self.message)


Question: TypeAlias = Offer | Read


class Rendezvous(Mailbox):
    """A plain port: each connection waits until its message was taken, and answered if it asks.

    Several threads may read, and answer side by side: each is done with its own messages only.
    `held` is changed by single dictionary operations only: by the thread itself, and by whichever
    thread finds it gone.
    """

    blocks = True

    def put(self, link: Inbound, message: Message) -> None:
        offer = Offer(link, message)
        with self._gate:
            if self.stopped:
                self._drop(link)
                return
            self._ready.put(offer)
        offer.done.wait()

    def keep(self, link: Inbound, message: Message) -> None:
        self.held[threading.current_thread()] = Read(link, message)

    def settle(self) -> None:
        """This thread is done with the message it took last; unanswered questions get no answer,
        nor do those of threads that have ended."""
        own = threading.current_thread()
        for thread in tuple(self.held):
            if thread is own or not thread.is_alive():
                self._leave(thread)

    def _leave(self, thread: threading.Thread) -> None:
        question = self.held.pop(thread, None)
        if question is not None:
            question.leave()

    def _next(self, token: object) -> Message | None:
        assert isinstance(token, Offer)
        if token.message.answer is None:
            token.done.set()
        else:
            self.held[threading.current_thread()] = token
            if self.stopped:
                token.done.set()  # `interrupt` may have looked before it was there
        return token.message

    def _discard(self, token: object) -> None:
        assert isinstance(token, Offer)
        self._drop(token.link)
        token.done.set()

    def interrupt(self) -> None:
        super().interrupt()
        for thread, question in tuple(self.held.items()):
            if isinstance(question, Offer):
                self._leave(thread)


class Callback(Mailbox):
    """Calls a function with each message, in the thread of its connection.

    An exception in the function is logged with its traceback; the connection goes on. With `lock`
    calls of different connections come one at a time.
    """

    def __init__(self, handler: Callable[[Message], None], lock: bool = False) -> None:
        super().__init__()
        self._handler = handler
        self._lock = threading.Lock() if lock else None  # the user asked for one call at a time

    def put(self, link: Inbound, message: Message) -> None:
        if not (self.stopped or self._fails(link, message)):
            return
        with self._gate:
            self._drop(link)

    def _fails(self, link: Inbound, message: Message) -> bool:
        """Call the function; whether it failed."""
        try:
            if self._lock is None:
                self._handler(message)
            else:
                with self._lock:
                    self._handler(message)
        except PortClosed:
            return True
        except YarpError as error:
            link.failure = str(error)
            log.warning("%s: message from %s: %s", link.owner.name, link.route.source, error)
            return True
        except Exception as error:
            link.failure = f"{type(error).__name__}: {error}"
            log.exception("%s: the callback failed on %r", link.owner.name, message)
            return True
        return False

    def take(self, timeout: float | None = None) -> Message | None:
        raise PortClosed("this port hands its messages to a callback; there is nothing to read")
