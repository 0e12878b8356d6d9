"""Calls: a node's connections to the services of others.

Rules: one connection for each service, kept for the next call, and dialled again once it has ended;
callers of the same service take turns. The time that a call may take covers all of it: the turn,
the question to the master, dialling, and the answer.
"""

from __future__ import annotations

import threading
import time
from typing import Any, Final

from yarpy.contact import Contact
from yarpy.data.value import Vocab
from yarpy.errors import LinkClosed, NoNameServer, RemoteProtocolError, Timeout, UnknownName
from yarpy.link.begin import handshake
from yarpy.link.ending import moment
from yarpy.link.send.outbound import Outbound
from yarpy.peers.ros.master import RosMaster
from yarpy.peers.ros.message.library import Service
from yarpy.peers.ros.message.message import Message as RosMessage
from yarpy.route import Declared, Route
from yarpy.wire.message import CALL, Packet

LOOK: Final = 0.25  # seconds between questions for a service that somebody waits for
SHORTEST: Final = 0.001  # seconds for what has no time left
ENOUGH: Final = 1.0  # seconds for a master to say whether there is a service


class ServiceFailed(RemoteProtocolError):
    """The server of a service failed; `reason` is what it says."""

    def __init__(self, name: str, reason: str) -> None:
        super().__init__(f"{name} failed: {reason}")
        self.reason = reason


class Calls:
    """The services that `node` calls."""

    def __init__(self, node: str, master: RosMaster) -> None:
        self._node = node
        self._master = master
        self._lines: dict[tuple[str, str], _Line] = {}
        self._closed = False
        self._lock = threading.RLock()  # services become known, and the node closes

    def call(self, name: str, kind: Service, question: RosMessage, timeout: float | None) -> Any:
        """The answer, as an object of the response type.

        Raises UnknownName, RemoteProtocolError, Timeout, LinkClosed, NoNameServer.
        """
        clock = _Clock(name, timeout)
        with self._lock:
            line = self._lines.setdefault((name, kind.md5sum), _Line())
        if not line.turn.acquire(timeout=-1 if timeout is None else timeout):
            raise clock.timeout("earlier calls have not ended")
        try:
            link = self._connected(line, name, kind, clock)
            reply = link.call(Packet(question, key=CALL), moment(clock.rest()))
        finally:
            line.turn.release()
        if reply is None:
            raise RemoteProtocolError(f"{name} gives no answer")
        if isinstance(found := getattr(reply, "ros", None), RosMessage):
            return found
        reason = reply.value
        text = str(reason[1]) if len(reason) > 1 else "it does not say why"
        if isinstance(reason[0], Vocab):
            raise ServiceFailed(name, text)
        raise RemoteProtocolError(f"{name} answers nothing that can be read")

    def _connected(self, line: _Line, name: str, kind: Service, clock: _Clock) -> Outbound:
        """A connection to a service: the one there is, if it lives."""
        if line.link is not None and not line.link.ended():
            return line.link
        try:
            where = self._master.service(name, min(clock.left(), self._master.timeout))
        except NoNameServer as error:
            if clock.over:
                raise clock.timeout("the ROS master did not answer") from error
            raise
        if where is None:
            raise UnknownName(
                f'nobody serves "{name}": is its program running? (`rosservice list`)'
            )
        declared = Declared(self._node, name, kind.name, kind)
        route = Route(self._node, name, f"rossrv+service.{name}", where.port, declared=declared)
        contact = Contact("rossrv", name, where.host, where.port)
        seconds = min(clock.left(), handshake.TIMEOUT)
        try:
            link = Outbound(*handshake.greet(contact, route, timeout=seconds))
        except Timeout as error:
            raise clock.timeout(f"{where.host}:{where.port} did not answer", seconds) from error
        with self._lock:
            line.link = link
            closed = self._closed
        if closed:
            link.close()
            raise LinkClosed(f"{self._node} was closed while it called {name}")
        return link

    def wait(self, name: str, timeout: float | None) -> bool:
        """Wait until somebody serves it; False if time is over. Raises NoNameServer."""
        clock = _Clock(name, timeout)
        while True:
            seconds = min(max(clock.left(), ENOUGH), self._master.timeout)
            if self._master.service(name, seconds) is not None:
                return True
            if clock.over:
                return False
            time.sleep(min(LOOK, clock.left()))

    def close(self) -> None:
        """Close the connections; calls that are under way end with LinkClosed. Idempotent."""
        with self._lock:
            self._closed = True
            lines = [line for line in self._lines.values() if line.link is not None]
        for line in lines:
            assert line.link is not None
            if line.turn.locked():
                line.link.driver.transport.interrupt()
            line.link.close()


class _Line:
    """The connection to a service."""

    def __init__(self) -> None:
        self.turn = threading.Lock()  # held while it is dialled and used, so that there is one
        self.link: Outbound | None = None


class _Clock:
    """The time that is left for a call of `name`."""

    def __init__(self, name: str, timeout: float | None) -> None:
        self._name = name
        self._timeout = timeout
        self._deadline = float("inf") if timeout is None else time.monotonic() + timeout

    @property
    def over(self) -> bool:
        return time.monotonic() >= self._deadline

    def left(self) -> float:
        """Seconds."""
        return max(self._deadline - time.monotonic(), SHORTEST)

    def rest(self) -> float | None:
        """Seconds; None for any number of them."""
        return None if self._timeout is None else self.left()

    def timeout(self, why: str, seconds: float | None = None) -> Timeout:
        """The error for a call that took too long."""
        limit = self._timeout if seconds is None else seconds
        return Timeout(f"{self._name} was not called within {limit:g} s: {why}")
