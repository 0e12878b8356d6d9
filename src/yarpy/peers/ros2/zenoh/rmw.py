"""A node over Zenoh: the classes of its endpoints."""

from __future__ import annotations

from yarpy.peers.ros2.rmw import Rmw
from yarpy.peers.ros2.zenoh.service import Answerer, Caller
from yarpy.peers.ros2.zenoh.topic import Reader, Writer


class ZenohRmw(Rmw):
    """Zenoh for a node. Its endpoints raise UnknownPlugin (the extra is not installed), LinkClosed
    (no router), too."""

    writers, readers, answerers, callers = Writer, Reader, Answerer, Caller
