"""ROS 2: topics of the types that hints stand for, over its Zenoh router. No ROS is needed.

Rules: types are those of `ros`, as `std_msgs/msg/String`. What the carrier takes (`domain.7`,
`qos.sensor`, docs/ros2.md) is said by `carrier=`. Services have types of their own, which no hint
gives: `serve` and `call` are refused.
"""

from __future__ import annotations

import os
from typing import Any

from yarpy.data.stamp import Stamp
from yarpy.errors import LocalProtocolError, Timeout, YarpError
from yarpy.port.port import BufferedPort
from yarpy.wrap.middleware import Answer, Client, Item, Received, Server, Way
from yarpy.wrap.middlewares.ros import as_text, type_of
from yarpy.wrap.shape import Shape
from yarpy.wrap.tree import from_text, to_text


class Ros2:
    """The middleware `ros2`."""

    name = "ros2"

    def check(self, way: Way) -> None:
        way.refuse(
            place="YARPY_ZENOH says where the router of ROS 2 is",
            qos="a topic's connections are made by ROS; say qos.NAME by carrier=",
        )
        if way.keep not in ("latest", "all"):
            raise ValueError('a subscriber keeps "latest" or "all" of what comes')

    def publisher(self, way: Way, shape: Shape) -> Ros2Publisher:
        return Ros2Publisher(way, shape)

    def listener(self, way: Way, shape: Shape) -> Ros2Listener:
        return Ros2Listener(way, shape)

    def server(self, way: Way, name: str, answer: Answer) -> Server:
        raise _no_service(way)

    def client(self, way: Way, shape: Shape) -> Client:
        raise _no_service(way)


def _no_service(way: Way) -> LocalProtocolError:
    return LocalProtocolError(
        f'"{way.topic}": a service of ROS 2 has a type, which no hint gives; connect an RpcServer '
        "or an RpcClient to ros2://, or take another middleware"
    )


def target_of(way: Way, shape: Shape) -> str:
    """The topic as something to connect to, with its type."""
    kind = type_of(shape)
    name = kind if isinstance(kind, str) else kind._type
    package, _, type_ = name.partition("/")
    full = name if "/" in type_ else f"{package}/msg/{type_}"
    carrier = "+".join(("ros2", *filter(None, way.carrier.split("+"))))
    if "node." not in carrier:
        carrier += f"+node.yarpy_wrap_{os.getpid()}"
    return f"{carrier}://{way.topic.strip('/')}~{full}"


class Ros2Publisher:
    def __init__(self, way: Way, shape: Shape) -> None:
        self._texts = as_text(shape)
        self._port = BufferedPort("", strict=way.keep == "all")
        try:
            self._port.connect(target_of(way, shape))
        except YarpError:
            self._port.close()
            raise

    def publish(self, item: Item) -> int:
        value = to_text(item.plain) if self._texts else item.plain
        return self._port.write(value, Stamp(item.count, item.time))

    def wait(self, timeout: float | None) -> bool:
        """Only the topic can be waited for: it is there at once."""
        return self._port.wait_for_outputs(1, timeout)

    @property
    def stats(self) -> dict[str, Any]:
        return self._port.stats

    def close(self) -> None:
        self._port.close()


class Ros2Listener:
    def __init__(self, way: Way, shape: Shape) -> None:
        self._way = way
        self._shape = shape
        self._texts = as_text(shape)
        self._port = BufferedPort("", strict=way.keep == "all")
        try:
            self._port.listen_to(target_of(way, shape))
        except YarpError:
            self._port.close()
            raise

    def listen(self, timeout: float | None) -> Received:
        try:
            message = self._port.read(timeout)
        except Timeout:
            raise Timeout(f'nothing came from "{self._way.topic}" within {timeout:.3g} s') from None
        stamp, shape = message.stamp, self._shape
        count, time = (stamp.count, stamp.time) if stamp is not None else (None, None)
        plain = from_text(message.as_(str)) if self._texts else shape.read(message)
        return Received(shape.load(plain), count, time, message.source, self._way.middleware)

    @property
    def stats(self) -> dict[str, Any]:
        return self._port.stats

    def close(self) -> None:
        self._port.close()
