"""Services of ROS 2 for a program: who answers them, and who asks, without a port of YARP.

    Answerer     a service whose questions are answered in a worker's thread, now or later
    Caller       asks a service, as many questions at a time as there are

Rules: those of `exchange`. What an answerer raises is told to who asked.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any

from yarpy.errors import DecodeError, LinkClosed, RemoteProtocolError, UnknownName
from yarpy.log import logger
from yarpy.peers.ros2 import kind as kinds
from yarpy.peers.ros2.carrier import Incoming, Outgoing
from yarpy.peers.ros2.exchange import SLICE, Question, Worker, answer_with, result_of
from yarpy.peers.ros2.key import Key
from yarpy.peers.ros2.name import Node
from yarpy.peers.ros2.qos import Qos
from yarpy.peers.ros2.token import CLIENT, SERVER
from yarpy.peers.ros2.zenoh.attachment import attachment
from yarpy.peers.ros2.zenoh.endpoint import Endpoint, Server, answer_of
from yarpy.peers.ros2.zenoh.participant import take_part
from yarpy.peers.ros2.zenoh.querier import Querier

log = logger("yarpy.ros2")


class Answerer(Server):
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
        super().__init__(take_part(domain), str(node), node, name, qos)
        self._handler = handler
        self._worker = worker
        begun(self, type_)

    def join(self, key: Key, kind: Any) -> None:
        self.kind = kind  # something may come at once
        super().join(key, kind)

    def put(self, item: Incoming, most: int) -> None:
        if not self._worker.put(self._answer, item):
            self.dropped += 1
            self.give(Outgoing(None, (), to=item.asked, failure="too many questions are waiting"))

    def _answer(self, item: Incoming) -> None:
        answer_with(self, self._handler, item, self.node)


class Caller(Endpoint):
    """Asks a service."""

    role = CLIENT
    peers = (SERVER,)
    what = kinds.SERVICE

    def __init__(
        self, node: Node, domain: int, name: str, type_: str, qos: Qos | None = None
    ) -> None:
        super().__init__(take_part(domain), str(node), node, name, qos)
        self._count = 0
        self._counts = threading.Lock()  # callers are of any thread
        begun(self, type_)

    def join(self, key: Key, kind: Any) -> None:
        self._querier = Querier(self.participant.session, key)
        self._handles.append(self._querier)

    def is_served(self) -> bool:
        """Return whether somebody serves it as the type that we have."""
        servers = self.participant.graph.endpoints(self.name, SERVER)
        return any(server.key == self.key for server in servers)

    def wait(self, timeout: float | None = None) -> bool:
        """Wait until somebody serves it; return False if time is over."""
        deadline = None if timeout is None else time.monotonic() + timeout
        while not self.is_served():
            left = SLICE if deadline is None else min(SLICE, deadline - time.monotonic())
            if left <= 0 or self.ended():
                return False
            self.participant.graph.wait_change(left)
        return True

    def ask(self, request: Any) -> Future[Any]:
        """Ask; the future has an object of the response type. It fails with UnknownName (nobody
        serves it), RemoteProtocolError (the server fails, and says why), LinkClosed (it goes
        meanwhile). Raises TypeError, ValueError or DecodeError for what is no request."""
        kind, key, name = self.kind, self.key, self.name
        assert key is not None
        request = kind.request(request)
        found: Future[Any] = Future()
        found.set_running_or_notify_cancel()
        served = self.is_served()

        def settle(came: Incoming | None) -> None:
            if found.done():
                return
            if came is None and served:
                found.set_exception(LinkClosed(f"who serves {name} went away during the call"))
            elif came is None:
                found.set_exception(UnknownName(f"nobody serves {name} as {kinds.shown(key)}"))
            elif came.failure:
                found.set_exception(RemoteProtocolError(came.failure))
            else:
                try:
                    found.set_result(kind.Response.from_ros(came.body))
                except DecodeError as error:
                    found.set_exception(error)

        with self._counts:
            self._count += 1
            number = self._count
        self._querier.get(
            lambda reply: settle(answer_of(reply)),
            lambda: settle(None),
            b"".join(request.to_ros()),
            attachment(number, time.time_ns(), self._gid),
            served,
        )
        return found

    def call(self, request: object, timeout: float | None = 10.0) -> Any:
        """As `ask`, and wait. Raises Timeout, too."""
        return result_of(self.ask(request), timeout, self.name)


def begun(endpoint: Endpoint, type_: str) -> None:
    """Let an endpoint join the graph; close it if it cannot. Raises UnknownType, DecodeError."""
    try:
        endpoint.begin(type_, False, 0.0)
    except BaseException:
        endpoint.close()
        raise
