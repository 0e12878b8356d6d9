"""Zenoh: keys over routers, "zenoh://router:7447"; without a place what YARPY_ZENOH says.

Rules: a topic is a key without slashes at its ends, and payloads are those of
`wrap/value/payload.py`, as programs with Wrapyfi have it. Servers are queryables. One session for
each place and process.
"""

from __future__ import annotations

import threading
import time
from queue import SimpleQueue
from typing import Any

from yarpy.errors import LinkClosed, PortClosed, Timeout, UnknownName
from yarpy.kits.wrap.middleware import Answer, Binding, Failure, Item, Received, question_of
from yarpy.kits.wrap.receive_queue import ReceiveQueue
from yarpy.kits.wrap.value import payload
from yarpy.kits.wrap.value.shape import Shape
from yarpy.log import logger
from yarpy.peers.zenoh.library import CALLS, load
from yarpy.peers.zenoh.transport import SharedSession, share

_LONGEST = 3600.0  # seconds: of a question without a timeout
_DISCOVERY = 0.1  # seconds: until it is known who serves a key
_MOST_QUESTIONS = 100  # that wait for an answer

log = logger("yarpy.zenoh")


class Zenoh:
    """The middleware `zenoh`."""

    name = "zenoh"

    def check(self, binding: Binding) -> None:
        key_of(binding)
        binding.refuse(carrier="routers decide how", qos="its sessions have no threads of ours")

    def publisher(self, binding: Binding, shape: Shape) -> ZenohPublisher:
        return ZenohPublisher(binding)

    def listener(self, binding: Binding, shape: Shape) -> ZenohListener:
        return ZenohListener(binding, shape)

    def server(self, binding: Binding, name: str, answer: Answer) -> ZenohServer:
        return ZenohServer(binding, answer)

    def client(self, binding: Binding, shape: Shape) -> ZenohClient:
        return ZenohClient(binding, shape)


def key_of(binding: Binding) -> str:
    """The key expression of a topic. Raises ValueError for one that is none."""
    key = binding.topic.strip("/")
    if not key or "//" in key or any(letter in key for letter in "*$#?"):
        raise ValueError(f'"{binding.topic}" is no key of Zenoh: words with a slash between them')
    return key


class ZenohPublisher:
    def __init__(self, binding: Binding) -> None:
        zenoh = load()
        self.messages = 0
        self._encoding = binding.encoding
        self._shared: SharedSession = share(binding.place)
        control = (
            zenoh.CongestionControl.BLOCK if binding.reliable else zenoh.CongestionControl.DROP
        )
        self._key = key_of(binding)
        self._publisher: Any = self._shared.session.declare_publisher(
            self._key, congestion_control=control
        )

    def publish(self, item: Item) -> int:
        data = item.form(f"bytes {self._encoding}", lambda one: payload.joined(one, self._encoding))
        publisher = self._publisher
        if publisher is None:
            raise PortClosed(f'"{self._key}" was closed')
        publisher.put(data)
        self.messages += 1
        return 1

    def wait(self, timeout: float | None) -> bool:
        deadline = None if timeout is None else time.monotonic() + timeout
        while not self._publisher.matching_status.matching:
            if deadline is not None and time.monotonic() >= deadline:
                return False
            time.sleep(0.005)
        return True

    @property
    def stats(self) -> dict[str, Any]:
        publisher = self._publisher
        heard = publisher is not None and publisher.matching_status.matching
        return {"messages": self.messages, "heard": heard}

    def close(self) -> None:
        if self._publisher is not None:
            self._publisher.undeclare()
            self._publisher = None
            self._shared.close()


class ZenohListener:
    def __init__(self, binding: Binding, shape: Shape) -> None:
        from zenoh.handlers import Callback

        self.messages = 0
        self._binding = binding
        self._shape = shape
        self._queue = ReceiveQueue(binding.keep)
        self._shared: SharedSession | None = share(binding.place)

        def heard(sample: Any) -> None:
            self.messages += 1
            if not self._queue.closed:
                self._queue.put(Received(sample.payload.to_bytes()))

        self._subscriber: Any = self._shared.session.declare_subscriber(
            key_of(binding), Callback(heard, indirect=False)
        )

    def listen(self, timeout: float | None) -> Received:
        try:
            data = self._queue.take(timeout).value
        except Timeout:
            raise Timeout(
                f'nothing came from "{self._binding.topic}" within {timeout:.3g} s'
            ) from None
        found = payload.unpack(data, self._shape)
        found.middleware = self._binding.middleware
        return found

    @property
    def stats(self) -> dict[str, Any]:
        return {"messages": self.messages, "drops": self._queue.drops}

    def close(self) -> None:
        self._queue.close()
        if self._shared is not None:
            self._subscriber.undeclare()
            self._shared.close()
            self._shared = None


class ZenohServer:
    """Answers questions, one after the other, in a thread of its own."""

    def __init__(self, binding: Binding, answer: Answer) -> None:
        from zenoh.handlers import Callback

        self._key = key_of(binding)
        self._answer = answer
        self._encoding = binding.encoding
        self._waiting: SimpleQueue[Any] = SimpleQueue()
        self._shared: SharedSession | None = share(binding.place)
        self._queryable: Any = self._shared.session.declare_queryable(
            self._key, Callback(self._heard, indirect=False)
        )
        # Zenoh has threads for this, too, but they would keep the program from ending.
        name = f"yarpy wrap {binding.topic}"
        threading.Thread(target=self._serve, name=name, daemon=True).start()

    def _heard(self, query: Any) -> None:
        if self._waiting.qsize() >= _MOST_QUESTIONS:
            query.reply_err(b"too many questions are waiting")
        else:
            self._waiting.put(query)

    def _serve(self) -> None:
        while (query := self._waiting.get()) is not None:
            try:
                self._asked(query)
            except Exception as error:  # the session was closed
                log.debug("%s: an answer could not be sent: %s", self._key, error)
            del query  # which tells the asker that there is no more

    def _asked(self, query: Any) -> None:
        try:
            data = query.payload.to_bytes() if query.payload is not None else b"[[], {}]"
            found = self._answer(*question_of(payload.asked(data)))
            if isinstance(found, Failure):
                said = payload.failure(found)
            else:
                said = payload.joined(found, self._encoding)
        except Exception as error:
            said = payload.failure(Failure.of(error))
        with CALLS:
            query.reply(self._key, said)

    def close(self) -> None:
        if self._shared is not None:
            self._queryable.undeclare()
            self._waiting.put(None)
            self._shared.close()
            self._shared = None


class ZenohClient:
    """Asks a queryable. Whether there is one says what it means when no answer comes."""

    def __init__(self, binding: Binding, shape: Shape) -> None:
        self._binding = binding
        self._shape = shape
        self._shared: SharedSession | None = share(binding.place)
        self._querier: Any = self._shared.session.declare_querier(key_of(binding))

    def call(
        self, name: str, args: list[Any], kwargs: dict[str, Any], timeout: float | None
    ) -> Any:
        topic = self._binding.topic
        question = payload.question(args, kwargs)
        deadline = None if timeout is None else time.monotonic() + timeout
        while True:
            served = self._is_served(deadline)
            data, late = self._ask(question, deadline)
            if data is not None:
                failed = payload.failure_of(data)
                if failed is not None:
                    raise failed.error()
                return payload.unpack(data, self._shape).value
            over = deadline is not None and time.monotonic() >= deadline
            if late and not served:  # on a busy computer the library is late to tell of nobody, too
                served = self._is_served(deadline)
            if served and (late or over):
                raise Timeout(f'"{topic}" did not answer within {timeout or 0:.3g} s')
            if served:
                raise LinkClosed(f'who serves "{topic}" went away during the call')
            # As elsewhere: with a timeout it waits for a server that is not there yet.
            if late or deadline is None or over:
                raise UnknownName(f'nobody serves "{topic}"')

    def _is_served(self, deadline: float | None) -> bool:
        """Return whether anybody serves the key; waits a moment, for the routers need one to
        tell."""
        end = time.monotonic() + _DISCOVERY
        if deadline is not None:
            end = min(end, deadline)
        while (querier := self._querier) is not None:
            if querier.matching_status.matching:
                return True
            if time.monotonic() >= end:
                return False
            time.sleep(0.005)
        raise self._closed()

    def _ask(self, question: bytes, deadline: float | None) -> tuple[bytes | None, bool]:
        """The answer, if there is one; and whether it did not come in time."""
        shared = self._shared
        if shared is None:
            raise self._closed()
        left = _LONGEST if deadline is None else max(deadline - time.monotonic(), 0.001)
        late = False
        for reply in shared.session.get(key_of(self._binding), payload=question, timeout=left):
            if reply.ok is not None:
                return reply.ok.payload.to_bytes(), False
            late = True  # the library says so itself
        return None, late

    def _closed(self) -> LinkClosed:
        return LinkClosed(f'"{self._binding.topic}" was closed here')

    def close(self) -> None:
        self._querier = None  # it undeclares itself
        if self._shared is not None:
            self._shared.close()
            self._shared = None
