"""Services of ROS 2 over DDS: for a port, and for a node of a program.

    DdsServer, DdsClient       as transports of objects
    DdsAnswerer, DdsCaller     as `rmw.Answerer` and `rmw.Caller`

Rules: those of `pair`. ROS 2 has no way over DDS to say that a server failed: there is no answer
then, and our log says why.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any, Final

from yarpy.errors import DecodeError, LinkClosed, UnknownName, YarpError
from yarpy.limit import ROS2_QUESTIONS
from yarpy.log import logger
from yarpy.peers.ros2.carrier import GONE, Incoming, Outgoing
from yarpy.peers.ros2.dds.pair import Pair, ServiceSample, type_of
from yarpy.peers.ros2.dds.participant import POOL
from yarpy.peers.ros2.exchange import Question, Worker, answer_with, result_of
from yarpy.peers.ros2.name import Node
from yarpy.peers.ros2.qos import Qos
from yarpy.transports.inbox import Inbox

log = logger("yarpy.ros2")

TIMEOUT: Final = 2.0  # seconds for a server to be found
PAUSE: Final = 0.02  # seconds between two looks
MOST_ASKED: Final = 10_000  # questions without an answer; the oldest are given up


class DdsServer(Inbox):
    """Serves a service for a port."""

    def __init__(self, domain: int, port: str, node: Node, name: str, qos: Qos | None) -> None:
        super().__init__()
        self.port_name, self.node, self.name, self.qos = port, node, name, qos or Qos()
        self.kind: Any = None
        self._part = POOL.take(domain)
        self._pair: Pair | None = None
        self._closed = False

    def begin(self, type_: str) -> None:
        """Serve it. Raises UnknownType, DecodeError."""
        self.kind = type_of(self._part, self.name, type_)
        self._pair = Pair(self._part, self.node, self.name, self.kind, self.qos, True, self._heard)

    def settle(self, value: object) -> Any:
        """Return its type, which is always known."""
        return self.kind

    def _heard(self, sample: ServiceSample) -> None:
        if self.waiting >= ROS2_QUESTIONS:
            self.dropped += 1
            return
        self.put(Incoming(sample.body, sample.number, sample.time, sample), ROS2_QUESTIONS)

    def give(self, item: Outgoing) -> None:
        pair = self._pair
        if item.to is None or pair is None or self._over:
            return
        if item.failure:
            log.warning(
                "%s: a question to %s has no answer, and over DDS nobody is told why: %s",
                *(self.port_name, self.name, item.failure),
            )
            return
        pair.answer(item.to, b"".join(item.body))

    def ended(self) -> bool:
        return self._over

    def close(self) -> None:
        if self._closed:
            return
        self._closed = True
        self.interrupt()
        if self._pair is not None:
            self._pair.close()
        POOL.leave(self._part)


class DdsAnswerer(DdsServer):
    """A service that `handler(question)` answers, in the thread of a worker."""

    def __init__(
        self,
        node: Node,
        domain: int,
        name: str,
        type_: str,
        handler: Callable[[Question], None],
        worker: Worker,
        qos: Qos | None = None,
    ) -> None:
        super().__init__(domain, str(node), node, name, qos)
        self._handler, self._worker = handler, worker
        begun(self, type_)

    def put(self, item: Incoming, most: int) -> None:
        if not self._worker.put(self._answer, item):
            self.dropped += 1

    def _answer(self, item: Incoming) -> None:
        answer_with(self, self._handler, item, self.node)


class DdsCaller:
    """Asks a service."""

    def __init__(
        self, node: Node, domain: int, name: str, type_: str, qos: Qos | None = None
    ) -> None:
        self.node, self.name, self.qos, self.dropped = node, name, qos or Qos(), 0
        self.kind: Any = None
        self._part = POOL.take(domain)
        self._pair: Pair | None = None
        # With who served when it was asked: who comes later does not know of it.
        self._asked: dict[int, tuple[Future[bytes], frozenset[bytes]]] = {}
        self._count = 0
        self._lock = threading.Lock()
        self._closed = False
        begun(self, type_)

    def begin(self, type_: str) -> None:
        """Find the type, and be there. Raises UnknownName, UnknownType, DecodeError."""
        deadline = time.monotonic() + TIMEOUT
        while True:
            try:
                self.kind = type_of(self._part, self.name, type_)
                break
            except UnknownName:
                if time.monotonic() >= deadline:
                    raise
                time.sleep(PAUSE)
        self._pair = Pair(
            *(self._part, self.node, self.name, self.kind, self.qos, False),
            self._heard,
            self._look,
        )

    def ended(self) -> bool:
        return self._closed

    def is_served(self) -> bool:
        """Return whether somebody serves it as the type that we have."""
        return bool(self._servers())

    def _servers(self) -> frozenset[bytes]:
        pair = self._pair
        return frozenset() if pair is None or self._closed else pair.servers()

    def wait(self, timeout: float | None = None) -> bool:
        """Wait until somebody serves it; return False if time is over."""
        deadline = None if timeout is None else time.monotonic() + timeout
        while not self.is_served():
            if self._closed or (deadline is not None and time.monotonic() >= deadline):
                return False
            time.sleep(PAUSE)
        return True

    def ask(self, request: Any) -> Future[Any]:
        """Ask; the future has an object of the response type. It fails with UnknownName (nobody
        serves it), LinkClosed (the server goes meanwhile). Raises TypeError, ValueError or
        DecodeError for what is no request."""
        kind = self.kind
        request = kind.request(request)
        found: Future[Any] = Future()
        found.set_running_or_notify_cancel()

        def settle(answer: Future[bytes]) -> None:
            try:
                found.set_result(kind.Response.from_ros(answer.result()))
            except (YarpError, DecodeError) as error:
                found.set_exception(error)

        self.ask_bytes(b"".join(request.to_ros())).add_done_callback(settle)
        return found

    def ask_bytes(self, body: bytes) -> Future[bytes]:
        """As `ask`, with the bytes of a request; the future has those of the response."""
        found: Future[bytes] = Future()
        pair = self._pair
        given_up = None
        with self._lock:  # also while it looks who serves: `_look` has to find the question then
            servers = self._servers()
            if servers:
                self._count += 1
                self._asked[self._count] = found, servers
                if len(self._asked) > MOST_ASKED:
                    given_up = self._asked.pop(next(iter(self._asked)))
            number = self._count
        if pair is None or not servers:
            found.set_exception(UnknownName(pair.why_not() if pair else f"{self.name} is closed"))
            return found
        if given_up is not None:
            why = f"{self.name} answers nothing: this one is given up"
            given_up[0].set_exception(LinkClosed(why))
        pair.write(pair.who, number, body)
        return found

    def call(self, request: object, timeout: float | None = 10.0) -> Any:
        """As `ask`, and wait, first for a server. Raises Timeout, too."""
        self.wait(TIMEOUT if timeout is None else min(timeout, TIMEOUT))
        return result_of(self.ask(request), timeout, self.name)

    def _heard(self, sample: ServiceSample) -> None:
        assert self._pair is not None
        if sample.who != self._pair.who:
            return  # of somebody else's question
        with self._lock:
            asked = self._asked.pop(sample.number, None)
        if asked is not None:
            asked[0].set_result(sample.body)

    def _look(self) -> None:
        """Somebody has come or gone."""
        with self._lock:
            servers = self._servers() if self._asked else frozenset()
            lost = [number for number, asked in self._asked.items() if not asked[1] & servers]
            gone = [self._asked.pop(number)[0] for number in lost]
        for found in gone:
            found.set_exception(LinkClosed(f"{GONE} {self.name} went away during the call"))

    def _give_up(self, why: str) -> None:
        with self._lock:
            asked, self._asked = self._asked, {}
        for found, _ in asked.values():
            found.set_exception(LinkClosed(why))

    def close(self) -> None:
        """Idempotent."""
        if self._closed:
            return
        self._closed = True
        if self._pair is not None:
            self._pair.close()
        self._give_up(f"{self.name} is asked no longer")
        POOL.leave(self._part)


class DdsClient(Inbox):
    """Asks a service for a port."""

    def __init__(self, domain: int, port: str, node: Node, name: str, qos: Qos | None) -> None:
        super().__init__()
        self.name, self._of = name, (node, domain, name)
        self._qos = qos
        self._caller: DdsCaller | None = None
        self._latest: Future[bytes] | None = None

    def begin(self, type_: str) -> None:
        """Be there. Raises UnknownName, UnknownType, DecodeError."""
        self._caller = DdsCaller(*self._of, type_, self._qos)

    @property
    def kind(self) -> Any:
        """The service."""
        return None if self._caller is None else self._caller.kind

    def settle(self, value: object) -> Any:
        """Return its type, which is always known."""
        return self.kind

    def give(self, item: Outgoing) -> None:
        caller = self._caller
        assert caller is not None
        caller.wait(TIMEOUT)
        self._latest = asked = caller.ask_bytes(b"".join(item.body))

        def heard(answer: Future[bytes]) -> None:
            if answer is not self._latest or self._over:
                return
            error = answer.exception()
            if error is None:
                self.put(Incoming(answer.result()), 1)
            else:
                self.put(Incoming(b"", failure=str(error)), 1)

        asked.add_done_callback(heard)

    def ended(self) -> bool:
        return self._over

    def close(self) -> None:
        self.interrupt()
        if self._caller is not None:
            self._caller.close()


def begun(endpoint: Any, type_: str) -> None:
    """Let an endpoint join; close it if it cannot. Raises UnknownName, UnknownType, DecodeError."""
    try:
        endpoint.begin(type_)
    except BaseException:
        endpoint.close()
        raise
