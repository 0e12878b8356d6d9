"""Mailboxes: what a port does with messages between their arrival and somebody's reading.

Rules: `put` runs in the thread of the connection and may make it wait; `take` runs in the reader's.
Messages of dropped turns are counted on the link that brought them. After `interrupt` everything
that waits or comes is dropped, and readers get PortClosed, until `resume`; a question that is
dropped ends its connection.
"""

from __future__ import annotations

import sys
import threading
import time
import weakref
from collections.abc import Callable
from functools import partial
from queue import Empty
from typing import Any, ClassVar, Final, TypeAlias

from yarpy.errors import PortClosed, YarpError
from yarpy.link.receive.inbound import Inbound
from yarpy.log import log_failure, logger
from yarpy.monitors.base import FAILURES
from yarpy.platform.timed_queue import TimedQueue
from yarpy.scope import Waiter
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
        self.closed = False  # for good
        self.drops = 0
        self.notify: Callable[[], None] | None = None  # there is something to take, or an end
        self.why = "the port is closed or interrupted"  # what readers are told then
        self.held: dict[threading.Thread, Question] = {}  # questions of readers, by their thread
        self._ready: TimedQueue[object] = TimedQueue()
        self.empty = self._ready.empty  # whether readers would have to wait
        # A message goes in, or the mailbox stops: what came in between would wait for ever.
        # Signal handlers may call `interrupt` above a frame that is inside.
        self._gate = threading.RLock()
        self.taken = 0.0  # when a message was taken last (time.perf_counter)

    def attend(self, link: Inbound) -> None:
        """A connection begins, which will bring its messages here."""

    def put(self, link: Inbound, message: Message) -> None:
        """Take a message that came over `link`."""
        raise NotImplementedError

    def _offer(self, token: object) -> None:
        """Let readers take a token."""
        self._ready.put(token)
        if self.notify is not None:
            self.notify()

    def take(self, timeout: float | None = None) -> Message | None:
        """Return the next message; None when `timeout` seconds are over. Raises PortClosed.

        An exception out of a signal handler, at any time, leaves the message here, in its place.
        """
        got: list[object] = []
        timeout = None if timeout is None else max(0.0, timeout)
        try:
            while True:
                self._ready.take(got, timeout)
                if got[0] is not _STOP:
                    break
                if self.stopped:
                    self._ready.put(_STOP)  # for the next reader
                    raise PortClosed(self.why)
                got.clear()  # left over from an interrupt that was resumed
            self.taken = time.perf_counter()
            return self._next(got[0])
        except Empty:
            return None
        except PortClosed:
            raise
        except BaseException:
            if got:
                self._put_back(got[0])
            raise

    def _put_back(self, token: object) -> None:
        """Put what was taken in front of what waits."""
        with self._gate:
            tokens = [token]
            while not self._ready.empty():
                tokens.append(self._ready.get_nowait())
            for one in tokens:
                self._ready.put(one)

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
    def behind(self) -> bool:
        """Return whether a connection waits for the program to read."""
        return False

    @property
    def waiting(self) -> int:
        """Messages that came and were not taken."""
        return 0 if self.stopped else self._ready.qsize()

    def interrupt(self) -> None:
        """Drop what waits and what comes; readers get PortClosed."""
        with self._gate:
            self.stopped = True
            try:
                self._clear()
            finally:
                self._offer(_STOP)

    def close(self) -> None:
        """Interrupt it for good: questions that were read get no answer any more, either."""
        self.closed = True
        self.interrupt()

    def resume(self) -> None:
        """Undo `interrupt`."""
        with self._gate:
            self._clear()
            self.stopped = False

    def surrender(self) -> list[tuple[Inbound, Message]]:
        """Return the messages that wait here, for another mailbox."""
        return []

    def release(self) -> object:
        """Hand what the program wants to be called to its port, which keeps it from now on."""
        return None

    def abandon(self, why: str) -> None:
        """Stop for ever, in a process where threads that had a lock may be missing."""
        self._gate = threading.RLock()
        self._ready = TimedQueue()
        self.empty = self._ready.empty
        self.why = why
        self.stopped = True
        self._offer(_STOP)

    def _next(self, token: object) -> Message | None:
        raise NotImplementedError

    def _clear(self) -> None:
        got: list[object] = []
        try:
            while True:
                self._ready.take(got, 0.0)
                if got[0] is not _STOP:
                    self._discard(got[0])
                got.clear()
        except Empty:
            pass
        except BaseException:  # out of a signal handler: what is not in the mailbox is counted
            if got and got[0] is not _STOP:
                self._discard(got[0])
            raise

    def _discard(self, token: object) -> None:
        """Drop and count what a token stands for; a second time does nothing."""

    def _forsake(self, message: Message) -> None:
        """Give a question no answer, not an empty one, if this is stopped or closed."""
        if (self.stopped or self.closed) and message.answer is not None:
            message.answer.forsaken = True

    def _drop_once(self, token: Waiting | Offer) -> None:
        """As `_drop`, for a message that has waited. In here Python looks for no signals."""
        if not token.dropped:
            token.dropped = True
            self.drops += 1
            token.link.counter.drops += 1

    def _drop(self, link: Inbound) -> None:
        """Count a drop; inside the gate, since several connections may."""
        self.drops += 1
        link.counter.drops += 1


class Latest(Mailbox):
    """Only the newest message is kept; an older one that nobody took is counted as replaced."""

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
                self._offer(None)  # exactly one token while there is an item
            else:
                older[0].counter.replaced += 1

    def surrender(self) -> list[tuple[Inbound, Message]]:
        with self._gate:
            item, self._item = self._item, None
        return [item] if item else []

    def _next(self, token: object) -> Message | None:
        item = None
        try:
            with self._gate:
                item, self._item = self._item, None
            return item[1] if item else None
        except BaseException:  # out of a signal handler
            with self._gate:
                if self._item is None:
                    self._item = item
                elif item is not None:
                    self._drop(item[0])
            raise

    def _discard(self, token: object) -> None:
        item, self._item = self._item, None  # from here to the end Python looks for no signals
        if item:
            self.drops += 1
            item[0].counter.drops += 1


class Waiting:
    """A message that waits in a Fifo."""

    __slots__ = ("dropped", "link", "message", "size")

    def __init__(self, link: Inbound, message: Message, size: int) -> None:
        self.link = link
        self.message = message
        self.dropped = False
        self.size = size  # bytes that count for it; 0 once they do not any more


class Fifo(Mailbox):
    """Every message, in order. When a reader is too far behind, senders wait: nothing is lost."""

    def __init__(self, limit: int = FIFO_BYTES) -> None:
        super().__init__()
        self._limit = limit
        self._bytes = 0
        self._lock = threading.RLock()  # of the byte count
        self._room = threading.Condition(self._lock)  # lets senders wait

    def put(self, link: Inbound, message: Message) -> None:
        payload = message.payload
        size = OVERHEAD + (len(payload) if message.spelling != "object" else memory(payload))
        with self._lock:
            if self._bytes > self._limit:
                self._room.wait_for(lambda: self._bytes <= self._limit or self.stopped)
            self._bytes += size
        with self._gate:
            if not self.stopped:
                self._offer(Waiting(link, message, size))
                return
            self._drop(link)
        self._free(Waiting(link, message, size))

    @property
    def behind(self) -> bool:
        return self._bytes > self._limit

    def surrender(self) -> list[tuple[Inbound, Message]]:
        found = []
        with self._gate:
            while not self.stopped and not self._ready.empty():
                token = self._ready.get_nowait()
                assert isinstance(token, Waiting)
                found.append((token.link, token.message))
                self._free(token)
        return found

    def _next(self, token: object) -> Message | None:
        assert isinstance(token, Waiting)
        self._free(token)
        return token.message

    def _discard(self, token: object) -> None:
        assert isinstance(token, Waiting)
        self._free(token)
        self._drop_once(token)

    def _free(self, token: Waiting) -> None:
        with self._lock:
            full = self._bytes > self._limit
            self._bytes -= token.size
            token.size = 0  # at once: a reader that is interrupted here comes again
            if full:
                self._room.notify_all()

    def interrupt(self) -> None:
        super().interrupt()
        with self._lock:
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

    __slots__ = ("done", "dropped", "link", "message")

    def __init__(self, link: Inbound, message: Message) -> None:
        self.link = link
        self.message = message
        self.dropped = False
        self.done = Waiter()
        if message.answer is not None:
            message.answer.then = self.done.wake

    def leave(self) -> None:
        """The reader is done with it; the connection's thread closes the question."""
        self.done.wake()


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
                self._forsake(message)
                self._drop(link)
                return
            self._offer(offer)
        offer.done.wait()

    @property
    def behind(self) -> bool:
        return self.waiting > 0

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
        question = self.held.get(thread)
        if question is not None:
            question.leave()
            if self.held.get(thread) is question:  # not before: an exception may come in between
                self.held.pop(thread, None)

    def _next(self, token: object) -> Message | None:
        assert isinstance(token, Offer)
        if token.message.answer is None:
            token.done.wake()
        else:
            self.held[threading.current_thread()] = token
            if self.closed:  # `close` may have looked before it was there
                self._forsake(token.message)
                token.done.wake()
        return token.message

    def _put_back(self, token: object) -> None:
        self.held.pop(threading.current_thread(), None)
        super()._put_back(token)

    def _discard(self, token: object) -> None:
        assert isinstance(token, Offer)
        self._forsake(token.message)
        self._drop_once(token)
        token.done.wake()

    def close(self) -> None:
        super().close()
        for thread, question in tuple(self.held.items()):
            self._forsake(question.message)
            if isinstance(question, Offer):
                self._leave(thread)


class Callback(Mailbox):
    """Calls a function with each message, in the thread of its connection.

    The function is kept by the port alone, as other callbacks are (`answer.callbacks`). An
    exception in it is logged with its traceback; the connection goes on. With `lock` calls of
    different connections come one at a time; with `type_` their messages are of that type.
    """

    def __init__(
        self, handler: Callable[[Message[Any]], object], lock: bool = False, type_: Any = None
    ) -> None:
        super().__init__()
        if not callable(handler):
            raise TypeError(
                f"a port calls a function of one argument with its messages, not {handler!r}"
            )
        try:
            self._handler = weakref.ref(handler)
        except TypeError:
            handler = partial(handler)
            self._handler = weakref.ref(handler)
        self._kept: Callable[[Message[Any]], object] | None = handler  # until a port takes it
        self._type = type_
        self._lock = threading.Lock() if lock else None  # the user asked for one call at a time

    def put(self, link: Inbound, message: Message) -> None:
        try:
            handler = self._handler()
            if self._type is not None:
                message.typed(self._type)
            if self.stopped or handler is None:
                pass
            elif self._lock is None:
                handler(message)
                return
            else:
                with self._lock:
                    if not self.stopped:  # while it waited for its turn
                        handler(message)
                        return
        except PortClosed:
            pass
        except YarpError as error:
            link.failure = str(error)
            log.warning("%s: message from %s: %s", link.owner.name, link.route.source, error)
        except FAILURES as error:
            link.failure = f"{type(error).__name__}: {error}"
            log_failure(log, error, "%s: the callback failed on %r", link.owner.name, message)
        self._forsake(message)
        with self._gate:
            self._drop(link)

    def release(self) -> object:
        kept, self._kept = self._kept, None
        return kept

    def take(self, timeout: float | None = None) -> Message | None:
        raise PortClosed("this port hands its messages to a callback; there is nothing to read")
