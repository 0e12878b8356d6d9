"""Topics over DDS for a node of a program: who writes, and who hears.

Rules: those of `endpoint`. A subscription has a thread of its own, which calls.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any, Final

from yarpy.errors import DecodeError
from yarpy.log import log_failure, logger
from yarpy.monitors.base import FAILURES
from yarpy.peers.ros2.body import encode_body
from yarpy.peers.ros2.carrier import Incoming, Outgoing
from yarpy.peers.ros2.dds.endpoint import DdsPublisher, DdsSubscriber
from yarpy.peers.ros2.dds.service import begun
from yarpy.peers.ros2.exchange import Worker
from yarpy.peers.ros2.name import Node
from yarpy.peers.ros2.qos import Qos
from yarpy.peers.ros2.token import PUBLISHER, SUBSCRIBER
from yarpy.wire.message import Packet

log = logger("yarpy.ros2")

CLOSING: Final = 5.0  # seconds for the thread to end


class DdsWriter(DdsPublisher):
    """Publishes a topic; `now` tells the time of headers without one."""

    now: Callable[[], float] = staticmethod(time.time)

    def __init__(
        self, node: Node, domain: int, name: str, type_: str, qos: Qos | None = None
    ) -> None:
        super().__init__(domain, str(node), node, name, qos, PUBLISHER)
        # One writer may take over from another; a signal handler may close in the middle.
        self._writing = threading.RLock()
        begun(self, type_)

    @property
    def subscribers(self) -> int:
        """The number of subscriptions to the topic, with its type."""
        with self._writing:  # no writer ends meanwhile
            if self._over:
                return 0
            writers = [each for each in (self._entity, self._next) if each is not None]
            return len({one for each in writers for one in each.get_matched_subscriptions()})

    def write(self, value: object) -> None:
        """Send a value to all who subscribe. A header without a time gets the present one. Raises
        TypeError, ValueError, DecodeError for what is nothing of the type."""
        body = encode_body(Packet(value), self.kind, self.now)
        with self._writing:
            try:
                if not self._over:
                    self.give(Outgoing(self.kind, body))
            except Exception:
                if not self._over:
                    raise

    def close(self) -> None:
        """Idempotent."""
        with self._writing:
            super().close()


class DdsReader(DdsSubscriber):
    """Calls `callback` with each message, in a thread of its own."""

    def __init__(
        self,
        node: Node,
        domain: int,
        name: str,
        type_: str,
        callback: Callable[[Any], object],
        worker: Worker,
        qos: Qos | None = None,
    ) -> None:
        super().__init__(domain, str(node), node, name, qos, SUBSCRIBER)
        self._callback = callback
        self._thread = threading.Thread(target=self._run, name=f"yarpy topic {name}", daemon=True)
        begun(self, type_)
        self._thread.start()

    def _run(self) -> None:
        self.receive()  # the endpoint itself
        while True:
            try:
                found = self.receive()
            except BrokenPipeError as error:
                if not self._over:
                    log.warning("%s: %s", self.port_name, error)
                return
            if found is None:
                return
            item = found[0]
            assert isinstance(item, Incoming)
            try:
                value = self.kind.from_ros(item.body)
            except DecodeError as error:
                self.dropped += 1
                log.warning("%s: a message of %s is lost: %s", self.port_name, self.name, error)
                continue
            try:
                self._callback(value)
            except FAILURES as error:
                log_failure(log, error, "%s: the callback of %s failed", self.node, self.name)

    def close(self) -> None:
        """Idempotent."""
        self.interrupt()
        if self._thread.is_alive() and self._thread is not threading.current_thread():
            self._thread.join(CLOSING)
        super().close()
