"""ROS 1: topics of the types that hints stand for, by yarpy's own nodes. No ROS is needed.

    str int float bool                               std_msgs/String, Int64, Float64, Bool
    Annotated[np.ndarray, wrap.Image(...)]           sensor_msgs/Image; with jpeg=, CompressedImage
    yarpy.Image, PointCloud, a class of messages     their type
    everything else                                  std_msgs/String with JSON, as Wrapyfi has it

Rules: a place is a master, "ros://localhost:11311"; without one it is ROS_MASTER_URI's. One node
for each process and master. Which service a method is says `service/method.py`.
"""

from __future__ import annotations

import os
import time
from typing import Any, Final

from yarpy import fork
from yarpy.data.stamp import Stamp
from yarpy.errors import DecodeError, LocalProtocolError, Timeout
from yarpy.kits.wrap.middleware import Answer, Binding, Item, Received
from yarpy.kits.wrap.port_end import PortEnd
from yarpy.kits.wrap.value.array import Picture
from yarpy.kits.wrap.value.shape import Scalar, Shape, Wired
from yarpy.kits.wrap.value.tree import from_text, to_text
from yarpy.peers.ros.message.library import default_library
from yarpy.peers.ros.message.message import Message as RosMessage
from yarpy.peers.ros.node.node import Node
from yarpy.peers.ros.service.calls import ServiceFailed
from yarpy.peers.ros.service.method import Service, Types, error_of, handled, topic_and_type
from yarpy.port.port import MessagePort
from yarpy.wire.message import Message

_TYPES = {str: "std_msgs/String", int: "std_msgs/Int64", float: "std_msgs/Float64"}
_TYPES[bool] = "std_msgs/Bool"
_NATIVE = {"Image": "sensor_msgs/Image", "PointCloud": "sensor_msgs/PointCloud2"}

_nodes: dict[tuple[int, str], tuple[Node, list[object]]] = {}
_lock = fork.lock()  # of the nodes


class Ros:
    """The middleware `ros`."""

    name = "ros"

    def check(self, binding: Binding) -> None:
        binding.refuse(
            carrier="topics of ROS go over tcpros",
            qos="a topic's connections are made by ROS",
        )
        binding.refuse_numbers()
        if "~" in binding.topic and binding.signature is not None:
            Service(binding, TYPES)

    def publisher(self, binding: Binding, shape: Shape) -> RosPublisher:
        return RosPublisher(binding, shape)

    def listener(self, binding: Binding, shape: Shape) -> RosListener:
        return RosListener(binding, shape)

    def server(self, binding: Binding, name: str, answer: Answer) -> RosServer:
        return RosServer(binding, answer)

    def client(self, binding: Binding, shape: Shape) -> RosClient:
        return RosClient(binding)


TYPES: Final = Types(
    "[A-Za-z][A-Za-z0-9_]*", default_library, lambda library: library.catalogue.sources
)


def topic_of(binding: Binding) -> str:
    """The topic of messages. Raises LocalProtocolError for the name of a service."""
    topic, type_ = topic_and_type(binding.topic)
    if type_:
        raise LocalProtocolError(f'"{binding.topic}" is a service: it can be served and called')
    return topic


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
    """Return whether values of the shape travel as JSON in a String."""
    return type_of(shape) == "std_msgs/String" and not isinstance(shape, Scalar)


def _use(binding: Binding, user: object) -> Node:
    """The node of this process at a master; `user` needs it until `_leave`."""
    key = os.getpid(), binding.place
    with _lock:
        if key not in _nodes:
            master = f"http://{binding.place}/" if binding.place else None
            _nodes[key] = Node(f"/yarpy_wrap_{os.getpid()}", master=master), []
        node, users = _nodes[key]
        users.append(user)
        return node


def _leave(binding: Binding, user: object) -> None:
    key = os.getpid(), binding.place
    with _lock:
        node, users = _nodes.get(key, (None, []))
        if user not in users:
            return
        users.remove(user)
        if not users:
            del _nodes[key]
    if not users and node is not None:
        node.close()


class Writer(PortEnd):
    """Publishes to a topic of either ROS."""

    def __init__(self, port: MessagePort, binding: Binding, shape: Shape) -> None:
        super().__init__(port, binding)
        self._texts = as_text(shape)

    def publish(self, item: Item) -> int:
        value = to_text(item.plain) if self._texts else item.plain
        return self.port.write(value, Stamp(item.count & 0x7FFFFFFF, item.time))


class Reader(PortEnd):
    """Listens to a topic of either ROS."""

    def __init__(self, port: MessagePort, binding: Binding, shape: Shape) -> None:
        super().__init__(port, binding)
        self._shape = shape
        self._texts = as_text(shape)

    def listen(self, timeout: float | None) -> Received:
        message = self.read(timeout)
        stamp = message.stamp
        count, time = (stamp.count, stamp.time) if stamp is not None else (None, None)
        value = self._value(message)
        return Received(value, count, time, message.source, self.binding.middleware)

    def _value(self, message: Message) -> Any:
        shape = self._shape
        return shape.load(from_text(message.as_(str)) if self._texts else shape.read(message))


class RosPublisher(Writer):
    def __init__(self, binding: Binding, shape: Shape) -> None:
        node = _use(binding, self)
        try:
            super().__init__(node.publisher(topic_of(binding), type_of(shape)), binding, shape)
        except BaseException:
            _leave(binding, self)
            raise

    def close(self) -> None:
        super().close()
        _leave(self.binding, self)


class RosListener(Reader):
    def __init__(self, binding: Binding, shape: Shape) -> None:
        node = _use(binding, self)
        try:
            newest = binding.keep == "latest"
            port = node.subscriber(topic_of(binding), type_of(shape), newest=newest)
            super().__init__(port, binding, shape)
        except BaseException:
            _leave(binding, self)
            raise

    def _value(self, message: Message) -> Any:
        shape = self._shape
        if not (isinstance(shape, Wired) and issubclass(shape.kind, RosMessage)):
            return super()._value(message)
        found = getattr(message, "ros", None)
        if not isinstance(found, shape.kind):
            raise DecodeError(f"expected {shape.name}, got {message!r}")
        return found

    def close(self) -> None:
        super().close()
        _leave(self.binding, self)


class RosServer:
    """A service; its method runs in the thread of the connection."""

    def __init__(self, binding: Binding, answer: Answer) -> None:
        self._binding = binding
        service = Service(binding, TYPES)
        self._node = _use(binding, self)
        try:
            self._port = self._node.service(
                service.topic, service.kind, lambda asked: handled(service, asked, answer)
            )
        except BaseException:
            _leave(binding, self)
            raise

    def close(self) -> None:
        self._port.close()
        _leave(self._binding, self)


class RosClient:
    """Calls of a service take turns."""

    def __init__(self, binding: Binding) -> None:
        self._binding = binding
        self._service = Service(binding, TYPES)
        self._node = _use(binding, self)

    def call(
        self, name: str, args: list[Any], kwargs: dict[str, Any], timeout: float | None
    ) -> Any:
        service = self._service
        question = service.request(args, kwargs)
        begun = time.monotonic()
        # As elsewhere: with a timeout it waits for a server that is not there yet.
        if timeout is not None and not self._node.wait_for_service(service.topic, timeout):
            raise Timeout(f'nobody served "{service.topic}" within {timeout:.3g} s')
        left = None if timeout is None else max(timeout - (time.monotonic() - begun), 0.001)
        try:
            found = self._node.call(service.topic, service.kind, question, timeout=left)
        except ServiceFailed as error:
            raise error_of(error.reason) from error
        return service.value(found)

    def close(self) -> None:
        _leave(self._binding, self)
