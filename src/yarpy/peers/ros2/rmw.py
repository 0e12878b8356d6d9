"""The layer that carries the messages of a node, as ROS 2's own layer `rmw` does: Zenoh, or DDS.

Rules: `zenoh/rmw.py` and `dds/rmw.py` are the two there are, and name the classes of their
endpoints. What is given to a callback is given in the thread of a worker, or in one of the
endpoint's own.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from typing import Any, ClassVar, Protocol

from yarpy.peers.ros2.event import Events
from yarpy.peers.ros2.exchange import Question, Worker
from yarpy.peers.ros2.name import Node
from yarpy.peers.ros2.qos import Qos


class Held(Protocol):
    """Something of a node that ends with it."""

    def close(self) -> None:
        """Idempotent."""


class Endpoint(Held, Protocol):
    """Of a topic or service; `kind` is its type, `dropped` counts what was lost."""

    name: str
    kind: Any
    qos: Qos
    dropped: int


class Writer(Endpoint, Protocol):
    """Publishes a topic; `now` tells the time of headers without one."""

    events: Events
    now: Callable[[], float]

    @property
    def subscribers(self) -> int:
        """The number of subscriptions to the topic, with its type."""

    def write(self, value: object) -> None:
        """Send a value to all who subscribe. A header without a time gets the present one. Raises
        TypeError, ValueError, DecodeError for what is nothing of the type."""


class Reader(Endpoint, Protocol):
    """Subscribes to a topic."""

    events: Events


class Answerer(Endpoint, Protocol):
    """Serves a service."""


class Caller(Endpoint, Protocol):
    """Asks a service."""

    def is_served(self) -> bool:
        """Return whether somebody serves it as the type that we have."""

    def wait(self, timeout: float | None = None) -> bool:
        """Wait until somebody serves it; return False if time is over."""

    def ask(self, request: Any) -> Future[Any]:
        """Ask; the future has an object of the response type. It fails with UnknownName (nobody
        serves it), RemoteProtocolError (the server fails, and says why), LinkClosed (it goes
        meanwhile). Raises TypeError, ValueError or DecodeError for what is no request."""

    def call(self, request: object, timeout: float | None = 10.0) -> Any:
        """As `ask`, and wait. Raises Timeout, too."""


class Rmw:
    """Makes the endpoints of one node, of the four classes that a layer names. All raise
    AddressError, UnknownType, DecodeError."""

    writers: ClassVar[type[Any]]
    readers: ClassVar[type[Any]]
    answerers: ClassVar[type[Any]]
    callers: ClassVar[type[Any]]

    def __init__(self, node: Node, domain: int) -> None:
        self._of = (node, domain)

    def writer(self, name: str, type_: str, qos: Qos | None) -> Writer:
        made: Writer = self.writers(*self._of, name, type_, qos)
        return made

    def reader(
        self,
        name: str,
        type_: str,
        callback: Callable[[Any], object],
        worker: Worker,
        qos: Qos | None,
    ) -> Reader:
        made: Reader = self.readers(*self._of, name, type_, callback, worker, qos)
        return made

    def answerer(
        self,
        name: str,
        type_: str,
        handler: Callable[[Question], None],
        worker: Worker,
        qos: Qos | None,
    ) -> Answerer:
        made: Answerer = self.answerers(*self._of, name, type_, handler, worker, qos)
        return made

    def caller(self, name: str, type_: str, qos: Qos | None) -> Caller:
        made: Caller = self.callers(*self._of, name, type_, qos)
        return made

    def close(self) -> None:
        """Idempotent; the endpoints close themselves."""
