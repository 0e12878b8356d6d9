"""Topics of ROS 2 for a program, without a port of YARP: who writes, and who hears.

Rules: what is written is an object of the type, or what may become one (a list or dict of fields,
an Image, a Vector, text); what comes is an object. What is none of the type is dropped, and
counted.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any

from yarpy.errors import DecodeError
from yarpy.log import logger
from yarpy.peers.ros2.body import encode_body
from yarpy.peers.ros2.carrier import Incoming, Outgoing
from yarpy.peers.ros2.exchange import Worker
from yarpy.peers.ros2.key import Key
from yarpy.peers.ros2.name import Node
from yarpy.peers.ros2.qos import Qos
from yarpy.peers.ros2.zenoh.endpoint import Publisher
from yarpy.peers.ros2.zenoh.participant import take_part
from yarpy.peers.ros2.zenoh.service import begun
from yarpy.peers.ros2.zenoh.subscriber import Subscriber
from yarpy.wire.message import Packet

log = logger("yarpy.ros2")


class Writer(Publisher):
    """Publishes a topic; `now` tells the time of headers without one."""

    now: Callable[[], float] = staticmethod(time.time)

    def __init__(
        self, node: Node, domain: int, name: str, type_: str, qos: Qos | None = None
    ) -> None:
        super().__init__(take_part(domain), str(node), node, name, qos)
        # What is being published cannot be taken back; a signal handler may do so in the middle.
        self._writing = threading.RLock()
        begun(self, type_)

    @property
    def subscribers(self) -> int:
        """The number of subscriptions to the topic, with its type."""
        seen = self.participant.graph.endpoints(self.name, *self.peers)
        return sum(token.key == self.key for token in seen)

    def write(self, value: object) -> None:
        """Send a value to all who subscribe; it waits for nobody. A header without a time gets the
        present one. Raises TypeError, ValueError, DecodeError for what is nothing of the type."""
        body = encode_body(Packet(value), self.kind, self.now)
        try:
            with self._writing:
                if not self.ended():
                    self.give(Outgoing(self.kind, body))
        except Exception:
            if not self.ended():  # it was closed meanwhile
                raise

    def close(self) -> None:
        """Idempotent."""
        with self._writing:
            super().close()


class Reader(Subscriber):
    """Calls `callback` with each message, in the thread of a worker."""

    waits = False

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
        super().__init__(take_part(domain), str(node), node, name, qos)
        self._callback = callback
        self._worker = worker
        begun(self, type_)

    def join(self, key: Key, kind: Any) -> None:
        self.kind = kind  # something may come at once
        super().join(key, kind)

    def put(self, item: Incoming, most: int) -> None:
        if not self._worker.put(self._hear, item):
            self.dropped += 1

    def _hear(self, item: Incoming) -> None:
        try:
            value = self.kind.from_ros(item.body)
        except DecodeError as error:
            self.dropped += 1
            log.warning("%s: a message of %s is lost: %s", self.port_name, self.name, error)
            return
        self._callback(value)
