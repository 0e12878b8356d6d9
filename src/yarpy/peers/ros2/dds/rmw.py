"""A node over DDS: the classes of its endpoints."""

from __future__ import annotations

from yarpy.peers.ros2.dds.library import load
from yarpy.peers.ros2.dds.participant import POOL
from yarpy.peers.ros2.dds.service import DdsAnswerer, DdsCaller
from yarpy.peers.ros2.dds.topic import DdsReader, DdsWriter
from yarpy.peers.ros2.name import Node
from yarpy.peers.ros2.rmw import Rmw


class DdsRmw(Rmw):
    """DDS for a node. Raises UnknownPlugin if the extra is not installed."""

    writers, readers, answerers, callers = DdsWriter, DdsReader, DdsAnswerer, DdsCaller

    def __init__(self, node: Node, domain: int) -> None:
        load()
        super().__init__(node, domain)
        self.part = POOL.take(domain)
        self._closed = False

    def close(self) -> None:
        """Give our part in the domain back. Idempotent; the endpoints close themselves."""
        if not self._closed:
            self._closed = True
            POOL.leave(self.part)
