"""ROS 2: topics of the types that hints stand for, over its Zenoh router. No ROS is needed.

Rules: types are those of `ros`, as `std_msgs/msg/String`, and so are services. What the carrier
takes (`domain.7`, `qos.sensor`, docs/ros2.md) is said by `carrier=`.
"""

from __future__ import annotations

import os
import time
from typing import Any, Final

from yarpy.errors import LinkClosed, UnknownName, YarpError
from yarpy.kits.wrap.middleware import Answer, Binding
from yarpy.kits.wrap.value.shape import Shape
from yarpy.link.begin.handshake import find_carrier
from yarpy.peers.ros.middleware import Reader, Writer, topic_of, type_of
from yarpy.peers.ros.service.method import Service, Types, error_of, handled
from yarpy.peers.ros2.carrier import GONE
from yarpy.peers.ros2.message.library import default_library
from yarpy.port.port import BufferedPort
from yarpy.port.rpc import RpcClient, RpcServer
from yarpy.route import parse_carrier
from yarpy.wire.message import Message

_PAUSE: Final = 0.05  # seconds between two looks for a server


class Ros2:
    """The middleware `ros2`."""

    name = "ros2"

    def check(self, binding: Binding) -> None:
        binding.refuse(
            place="YARPY_ZENOH says where the router of ROS 2 is",
            qos="a topic's connections are made by ROS; say qos.NAME by carrier=",
        )
        binding.refuse_numbers()
        find_carrier(parse_carrier(_carrier(binding)))
        if "~" in binding.topic and binding.signature is not None:
            Service(binding, TYPES)

    def publisher(self, binding: Binding, shape: Shape) -> Ros2Publisher:
        return Ros2Publisher(binding, shape)

    def listener(self, binding: Binding, shape: Shape) -> Ros2Listener:
        return Ros2Listener(binding, shape)

    def server(self, binding: Binding, name: str, answer: Answer) -> Ros2Server:
        return Ros2Server(binding, answer)

    def client(self, binding: Binding, shape: Shape) -> Ros2Client:
        return Ros2Client(binding)


TYPES: Final = Types("[a-z](?:_?[a-z0-9])*", default_library, lambda library: library.sources)


def target_of(binding: Binding, shape: Shape) -> str:
    """The topic as something to connect to, with its type."""
    kind = type_of(shape)
    return _target(binding, topic_of(binding), kind if isinstance(kind, str) else kind._type, "msg")


def _carrier(binding: Binding) -> str:
    return "+".join(("ros2", *filter(None, binding.carrier.split("+"))))


def _target(binding: Binding, topic: str, name: str, kind: str) -> str:
    package, _, type_ = name.partition("/")
    full = name if "/" in type_ else f"{package}/{kind}/{type_}"
    carrier = _carrier(binding)
    if "node." not in carrier:
        carrier += f"+node.yarpy_wrap_{os.getpid()}"
    return f"{carrier}://{topic.strip('/')}~{full}"


class Ros2Publisher(Writer):
    def __init__(self, binding: Binding, shape: Shape) -> None:
        super().__init__(BufferedPort("", strict=binding.keep == "all"), binding, shape)
        try:
            self.port.connect(target_of(binding, shape))
        except YarpError:
            self.close()
            raise


class Ros2Listener(Reader):
    def __init__(self, binding: Binding, shape: Shape) -> None:
        super().__init__(BufferedPort("", strict=binding.keep == "all"), binding, shape)
        try:
            self.port.listen_to(target_of(binding, shape))
        except YarpError:
            self.close()
            raise


class Ros2Server:
    """A service; its method runs in the thread of the connection."""

    def __init__(self, binding: Binding, answer: Answer) -> None:
        service = Service(binding, TYPES)

        def told(message: Message) -> Any:
            return handled(service, getattr(message, "ros", None), answer)

        self._port = RpcServer("", told, register=False)
        try:
            self._port.listen_to(_target(binding, service.topic, service.kind.name, "srv"))
        except YarpError:
            self._port.close()
            raise

    def close(self) -> None:
        self._port.close()


class Ros2Client:
    def __init__(self, binding: Binding) -> None:
        self._service = Service(binding, TYPES)
        self._client = RpcClient()
        try:
            self._client.connect(
                _target(binding, self._service.topic, self._service.kind.name, "srv")
            )
        except YarpError:
            self._client.close()
            raise

    def call(
        self, name: str, args: list[Any], kwargs: dict[str, Any], timeout: float | None
    ) -> Any:
        service = self._service
        question = service.request(args, kwargs)
        deadline = None if timeout is None else time.monotonic() + timeout
        while True:
            left = None if deadline is None else max(deadline - time.monotonic(), 0.001)
            message = self._client.ask(question, left)
            found = getattr(message, "ros", None)
            if found is not None:
                return service.value(found)
            reason = message.value if message is not None else None
            if not isinstance(reason, list) or len(reason) < 2:
                raise LinkClosed(f'"{service.topic}" gave no answer')
            text = str(reason[1])
            if text.startswith(GONE):
                raise LinkClosed(text)
            if not text.startswith("nobody serves"):
                raise error_of(text)
            # As elsewhere: with a timeout it waits for a server that is not there yet.
            if deadline is None or time.monotonic() + _PAUSE >= deadline:
                raise UnknownName(text)
            time.sleep(_PAUSE)

    def close(self) -> None:
        self._client.close()
