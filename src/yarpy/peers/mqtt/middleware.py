"""MQTT: the topics of a broker, "mqtt://broker:1883". No library is needed.

Rules: payloads are those of `wrap/value/payload.py`, topics stand at the broker as they are
written. A broker that goes away is dialled again until it is back. `reliable` is QoS 1; what else
the carrier takes (`retain`, `user.NAME+password.WORD`, `tls`) is said by `carrier=`. Questions need
MQTT 5.
"""

from __future__ import annotations

import time
from functools import partial
from typing import Any, TypeVar

from yarpy.contact import parse_contact
from yarpy.errors import LinkClosed, UnknownName, YarpError
from yarpy.kits.wrap.middleware import Answer, Binding, Failure, Item, Received, question_of
from yarpy.kits.wrap.port_end import PortEnd
from yarpy.kits.wrap.value import payload, spelling
from yarpy.kits.wrap.value.shape import Shape
from yarpy.link.begin.handshake import find_carrier
from yarpy.port.base import BasePort
from yarpy.port.port import BufferedPort
from yarpy.port.rpc import RpcClient, RpcServer
from yarpy.route import parse_carrier
from yarpy.wire.message import Message

_RETRY_INTERVAL = 0.1  # seconds between two tries to ask who has not subscribed yet


class Mqtt:
    """The middleware `mqtt`."""

    name = "mqtt"

    def check(self, binding: Binding) -> None:
        if not binding.place or "/" in binding.place:
            raise ValueError('mqtt needs a broker: "mqtt://HOST", or "mqtt://HOST:PORT"')
        find_carrier(parse_carrier(parse_contact(_target(binding)).carrier))
        binding.refuse_numbers()
        binding.refuse(qos="what leads to a broker has no thread and no priority of its own")

    def publisher(self, binding: Binding, shape: Shape) -> MqttPublisher:
        return MqttPublisher(binding)

    def listener(self, binding: Binding, shape: Shape) -> MqttListener:
        return MqttListener(binding, shape)

    def server(self, binding: Binding, name: str, answer: Answer) -> RpcServer:
        server = RpcServer("", MqttServer(answer, binding), register=False)
        return _connected(server, _target(binding, "sub", "rpc"))

    def client(self, binding: Binding, shape: Shape) -> MqttClient:
        return MqttClient(binding, shape)


def _target(binding: Binding, *words: str) -> str:
    """The topic as something to connect to."""
    added = [*words, *filter(None, binding.carrier.split("+"))]
    if binding.reliable and "rpc" not in words:
        added.append("qos.1")
    return f"{'+'.join(('mqtt', *added))}://{binding.place}/{binding.topic}"


P = TypeVar("P", bound=BasePort)


def _connected(port: P, target: str) -> P:
    try:
        port.connect(target)
    except YarpError:
        port.close()
        raise
    return port


class MqttPublisher(PortEnd):
    def __init__(self, binding: Binding) -> None:
        port = BufferedPort("", strict=binding.keep == "all")
        super().__init__(_connected(port, _target(binding)), binding)
        self._form = partial(payload.joined, encoding=binding.encoding)

    def publish(self, item: Item) -> int:
        return self.port.write(item.form(f"bytes {self.binding.encoding}", self._form))


class MqttListener(PortEnd):
    def __init__(self, binding: Binding, shape: Shape) -> None:
        port = BufferedPort("", strict=binding.keep == "all")
        super().__init__(_connected(port, _target(binding, "sub")), binding)
        self._shape = shape

    def listen(self, timeout: float | None) -> Received:
        found = payload.unpack(self.read(timeout).as_(bytes), self._shape)
        found.middleware = self.binding.middleware
        return found


class MqttServer:
    """A handler for an RpcServer: decodes a payload to arguments, and encodes the result."""

    def __init__(self, answer: Answer, binding: Binding) -> None:
        self._answer = answer
        self._encoding = binding.encoding

    def __call__(self, message: Message) -> bytes:
        found = self._answer(*question_of(payload.asked(message.as_(bytes))))
        if isinstance(found, Failure):
            return payload.failure(found)
        return payload.joined(found, self._encoding)


class MqttClient:
    def __init__(self, binding: Binding, shape: Shape) -> None:
        self._binding = binding
        self._shape = shape
        self._client = _connected(RpcClient(), _target(binding, "rpc"))

    def call(
        self, name: str, args: list[Any], kwargs: dict[str, Any], timeout: float | None
    ) -> Any:
        question = payload.question(args, kwargs)
        deadline = None if timeout is None else time.monotonic() + timeout
        while True:
            asked = time.monotonic()
            left = None if deadline is None else max(deadline - asked, 0.001)
            message = self._client.ask(question, left)
            if message is None:
                raise LinkClosed(f'"{self._binding.topic}" gave no answer')
            refused = spelling.failure_of(message.value) if message.spelling == "binary" else None
            if refused is None:
                break
            # By the broker: nobody has subscribed. As elsewhere, with a timeout that is waited for,
            # as long as there is time for another answer: without one nobody would know why.
            answered = time.monotonic()
            enough = _RETRY_INTERVAL + 2 * (answered - asked)
            if deadline is None or answered + enough >= deadline:
                raise UnknownName(refused.text)
            time.sleep(_RETRY_INTERVAL)
        data = message.as_(bytes)
        failed = payload.failure_of(data)
        if failed is not None:
            raise failed.error()
        return payload.unpack(data, self._shape).value

    def close(self) -> None:
        self._client.close()
