"""YARP: a publisher is a port with the topic's name, and a server is one that answers.

Rules: any program of YARP takes part, in C++ too: what it can understand is sent in its types
(`value/spelling.py`), and its questions are Bottles, `look 1.0`. A listener waits for a topic that
is not there yet, and finds one again that was restarted.
"""

from __future__ import annotations

import time
from collections import deque
from contextlib import suppress
from typing import Any

from yarpy.errors import DecodeError, LinkClosed, Timeout, UnknownName, YarpError
from yarpy.kits.wrap.follower import Follower
from yarpy.kits.wrap.middleware import Answer, Binding, Failure, Item, Received, question_of
from yarpy.kits.wrap.port_end import PortEnd
from yarpy.kits.wrap.value.native import SURE
from yarpy.kits.wrap.value.shape import ANY, Shape
from yarpy.kits.wrap.value.spelling import (
    answered,
    failure,
    failure_of,
    form_of,
    frame_of,
    question,
    received,
    text_of,
)
from yarpy.kits.wrap.value.tree import from_text
from yarpy.link.begin.handshake import asked_carrier
from yarpy.port.connection import ConnectionEvent
from yarpy.port.port import BufferedPort
from yarpy.port.rpc import RpcClient, RpcServer
from yarpy.qos import Qos
from yarpy.route import parse_carrier
from yarpy.wire.message import Message


class Yarp:
    """The middleware `yarp`: names by the name server, connections between ports."""

    name = "yarp"
    carrier = ""  # of listeners: as between any two ports, the fastest that both have

    def check(self, binding: Binding) -> None:
        binding.refuse(
            place="names lead to ports; the name server is configured, see docs/names.md"
        )
        binding.refuse_numbers()
        if not binding.topic.startswith("/"):
            raise ValueError(f'"{binding.topic}" is no name of a port: it begins with a slash')
        if binding.carrier:
            asked_carrier(parse_carrier(binding.carrier))

    def publisher(self, binding: Binding, shape: Shape) -> PortPublisher:
        port = BufferedPort(binding.topic, strict=binding.keep == "all")
        if binding.qos is not None:
            _give(port, binding.qos)
        return PortPublisher(port, binding, shape)

    def listener(self, binding: Binding, shape: Shape) -> PortListener:
        port = BufferedPort("", strict=binding.keep == "all")
        try:
            follower = Follower(port, binding.topic, binding.carrier or self.carrier, binding.qos)
        except YarpError:
            port.close()
            raise
        return PortListener(port, binding, shape, follower)

    def server(self, binding: Binding, name: str, answer: Answer) -> RpcServer:
        return RpcServer(binding.topic, PortServer(name, answer, binding))

    def client(self, binding: Binding, shape: Shape) -> PortClient:
        return PortClient(binding, shape, binding.carrier or self.carrier)


def _give(port: BufferedPort, qos: Qos) -> None:
    """Let every connection out of `port` have this priority."""

    def give(target: str = "") -> None:
        for connection in port.outputs:
            if target in ("", connection.target):
                connection.qos = qos

    def on_connection(event: ConnectionEvent) -> None:
        if event.created and not event.incoming:
            give(event.target)

    port.on_connection(on_connection)
    give()  # to those that came as soon as it had its name


class PortPublisher(PortEnd):
    """Writes to a port of its own."""

    def __init__(self, port: BufferedPort, binding: Binding, shape: Shape) -> None:
        super().__init__(port, binding)
        self._name = binding.encoding
        self._form = form_of(binding.encoding, shape)
        self._write = port.write

    def publish(self, item: Item) -> int:
        make = self._form
        value = make(item) if item.forms is None else item.form(self._name, make)
        return self._write(value, f"{item.count & 0x7FFFFFFF} {item.time:.6f}")


class PortListener(PortEnd):
    """Reads a port of its own, which follows the topic."""

    def __init__(
        self, port: BufferedPort, binding: Binding, shape: Shape, follower: Follower | None = None
    ) -> None:
        super().__init__(port, binding)
        self._shape = shape
        self._middleware = binding.middleware
        self._follower = follower

    def listen(self, timeout: float | None) -> Received:
        try:
            message = self.read(timeout)
        except Timeout as error:
            why = "" if self._follower is None else self._follower.why
            raise Timeout(f"{error}: {why}" if why else str(error)) from None
        return received(message, self._shape, self._middleware)

    def close(self) -> None:
        if self._follower is not None:
            self._follower.close()
        super().close()


class PortServer:
    """A handler for an RpcServer: decodes a message to arguments, and encodes the result."""

    def __init__(self, name: str, answer: Answer, binding: Binding) -> None:
        self._name = name
        self._answer = answer
        shape = ANY if binding.signature is None else binding.signature.result
        self._form = form_of(binding.encoding, shape)
        # What comes back whatever its value is spelled as it is.
        self._sure = shape.exact if binding.encoding == "native" and shape.exact in SURE else None

    def __call__(self, message: Message) -> Any:
        value = message.value
        words = value if isinstance(value, list) else [value]
        if words and words[0] == self._name:
            _, *args = words
            found = self._answer(args, {})
        else:
            found = self._answer(*self._arguments(message))
        if isinstance(found, Failure):
            return failure(found)
        plain = found.plain
        return plain if type(plain) is self._sure else self._form(found)

    def _arguments(self, message: Message) -> tuple[list[Any], dict[str, Any]]:
        """Those of a frame, or of a text of Wrapyfi."""
        found = frame_of(message)
        if found is not None:
            return question_of(found.value)
        text = text_of(message)
        if text is not None and text.startswith("["):
            return question_of(from_text(text))
        raise DecodeError(f'ask "{self._name}", and behind it the arguments')


class PortClient:
    """Asks a server; several questions at a time take several connections."""

    def __init__(self, binding: Binding, shape: Shape, carrier: str) -> None:
        self._binding = binding
        self._shape = shape
        self._exact = None if shape.exact is list else shape.exact  # failures are lists, too
        self._carrier = carrier
        self._idle: deque[RpcClient] = deque()  # whatever threads do, each of them is taken once
        self._closed = False

    def call(
        self, name: str, args: list[Any], kwargs: dict[str, Any], timeout: float | None
    ) -> Any:
        deadline = None if timeout is None else time.monotonic() + timeout
        try:
            client = self._idle.pop()
        except IndexError:
            client = self._dialled(deadline)
        try:
            left = None if deadline is None else max(deadline - time.monotonic(), 0.0)
            message = client.ask(question(name, args, kwargs), left)
        except BaseException:
            client.close()
            raise
        self._idle.append(client)
        if self._closed:
            self.close()
        if message is None:
            raise LinkClosed(f'"{self._binding.topic}" gave no answer')
        value = message.value
        if type(value) is self._exact:
            return value
        failed = failure_of(value)
        if failed is not None:
            raise failed.error()
        return answered(message, self._shape)

    def _dialled(self, deadline: float | None) -> RpcClient:
        """A connection to the server; with time left, one that is not there yet is waited for."""
        pause = 0.02
        while True:
            try:
                return RpcClient(self._binding.topic, carrier=self._carrier)
            except (UnknownName, LinkClosed):
                if deadline is None or time.monotonic() + pause > deadline:
                    raise
            time.sleep(pause)
            pause = min(2 * pause, 0.5)

    def close(self) -> None:
        self._closed = True
        with suppress(IndexError):
            while True:
                self._idle.pop().close()
