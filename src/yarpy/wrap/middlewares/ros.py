"""ROS 1: topics of the types that hints stand for, by yarpy's own nodes. No ROS is needed.

    str int float bool                               std_msgs/String, Int64, Float64, Bool
    Annotated[np.ndarray, wrap.Image(...)]           sensor_msgs/Image; with jpeg=, CompressedImage
    yarpy.Image, PointCloud, a class of messages     their type
    everything else                                  std_msgs/String with JSON, as Wrapyfi has it

Rules: a place is a master, "ros://localhost:11311"; without one it is ROS_MASTER_URI's. One node
for each process and master. Services have types, which no hint gives: `serve` and `call`
are refused.
"""

from __future__ import annotations

import os
import threading
from typing import Any

from yarpy.data.stamp import Stamp
from yarpy.errors import DecodeError, LocalProtocolError, Timeout
from yarpy.idl.rosmsg.message import Message as RosMessage
from yarpy.ros.node import Node
from yarpy.wire.message import Message
from yarpy.wrap.array import Picture
from yarpy.wrap.middleware import Answer, Client, Item, Received, Server, Way
from yarpy.wrap.shape import Scalar, Shape, Wired
from yarpy.wrap.tree import from_text, to_text

_TYPES = {str: "std_msgs/String", int: "std_msgs/Int64", float: "std_msgs/Float64"}
_TYPES[bool] = "std_msgs/Bool"
_NATIVE = {"Image": "sensor_msgs/Image", "PointCloud": "sensor_msgs/PointCloud2"}

_nodes: dict[tuple[int, str], tuple[Node, list[object]]] = {}
_lock = threading.Lock()  # of the nodes


class Ros:
    """The middleware `ros`."""

    name = "ros"

    def check(self, way: Way) -> None:
        way.refuse(
            carrier="topics of ROS go over tcpros",
            qos="a topic's connections are made by ROS",
        )
        if way.keep not in ("latest", "all"):
            raise ValueError('a subscriber keeps "latest" or "all" of what comes')

    def publisher(self, way: Way, shape: Shape) -> RosPublisher:
        return RosPublisher(way, shape)

    def listener(self, way: Way, shape: Shape) -> RosListener:
        return RosListener(way, shape)

    def server(self, way: Way, name: str, answer: Answer) -> Server:
        raise _no_service(way)

    def client(self, way: Way, shape: Shape) -> Client:
        raise _no_service(way)


def _no_service(way: Way) -> LocalProtocolError:
    return LocalProtocolError(
        f'"{way.topic}": a service of ROS has a type, which no hint gives; use '
        "yarpy.ros.Node.service and call, or another middleware"
    )


def type_of(shape: Shape) -> Any:
    """The type of ROS that a hint stands for, as a name or a class."""
    if isinstance(shape, Scalar) and shape.kind in _TYPES:
        return _TYPES[shape.kind]
    if isinstance(shape, Picture):
        return "sensor_msgs/Image" if shape.image.jpeg is None else "sensor_msgs/CompressedImage"
    if isinstance(shape, Wired):
        if issubclass(shape.kind, RosMessage):
            return shape.kind
        return _NATIVE.get(shape.kind.__name__, "std_msgs/String")
    return "std_msgs/String"


def as_text(shape: Shape) -> bool:
    """Whether a String holds JSON."""
    return type_of(shape) == "std_msgs/String" and not isinstance(shape, Scalar)


def _use(way: Way, user: object) -> Node:
    """The node of this process at a master; `user` needs it until `_leave`."""
    key = os.getpid(), way.place
    with _lock:
        if key not in _nodes:
            master = f"http://{way.place}/" if way.place else None
            _nodes[key] = Node(f"/yarpy_wrap_{os.getpid()}", master=master), []
        node, users = _nodes[key]
        users.append(user)
        return node


def _leave(way: Way, user: object) -> None:
    key = os.getpid(), way.place
    with _lock:
        node, users = _nodes.get(key, (None, []))
        if user not in users:
            return
        users.remove(user)
        if not users:
            del _nodes[key]
    if not users and node is not None:
        node.close()


class RosPublisher:
    def __init__(self, way: Way, shape: Shape) -> None:
        self._way = way
        self._texts = as_text(shape)
        self._node = _use(way, self)
        try:
            self._port = self._node.publisher(way.topic, type_of(shape))
        except BaseException:
            _leave(way, self)
            raise

    def publish(self, item: Item) -> int:
        value = to_text(item.plain) if self._texts else item.plain
        return self._port.write(value, Stamp(item.count, item.time))

    def wait(self, timeout: float | None) -> bool:
        return self._port.wait_for_outputs(1, timeout)

    @property
    def stats(self) -> dict[str, Any]:
        return self._port.stats

    def close(self) -> None:
        self._port.close()
        _leave(self._way, self)


class RosListener:
    def __init__(self, way: Way, shape: Shape) -> None:
        self._way = way
        self._shape = shape
        self._kind = type_of(shape)
        self._texts = as_text(shape)
        self._node = _use(way, self)
        try:
            self._port = self._node.subscriber(way.topic, self._kind, newest=way.keep == "latest")
        except BaseException:
            _leave(way, self)
            raise

    def listen(self, timeout: float | None) -> Received:
        try:
            message = self._port.read(timeout)
        except Timeout:
            raise Timeout(f'nothing came from "{self._way.topic}" within {timeout:.3g} s') from None
        stamp = message.stamp
        count, time = (stamp.count, stamp.time) if stamp is not None else (None, None)
        value = self._value(message)
        return Received(value, count, time, message.source, self._way.middleware)

    def _value(self, message: Message) -> Any:
        shape = self._shape
        if self._texts:
            return shape.load(from_text(message.as_(str)))
        if isinstance(shape, Wired) and issubclass(shape.kind, RosMessage):
            found = getattr(message, "ros", None)
            if not isinstance(found, shape.kind):
                raise DecodeError(f"expected {shape.name}, got {message!r}")
            return found
        return shape.load(shape.read(message))

    @property
    def stats(self) -> dict[str, Any]:
        return self._port.stats

    def close(self) -> None:
        self._port.close()
        _leave(self._way, self)
