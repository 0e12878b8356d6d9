"""ZeroMQ: topics at a broker, as programs with Wrapyfi have it, "zeromq://host:5555". Needs pyzmq.

Rules: on this computer nobody has to start the broker (`broker.py`). A value is `topic, JSON`
or `topic, header, buffers`; what Wrapyfi sends is read as well. Servers are told apart by their
topics, by frames `TOPIC?, reply topic, number, question`; Wrapyfi's requests have no topics.
"""

from __future__ import annotations

import threading
from typing import Any

from yarpy.kits.wrap.middleware import Answer, Binding, Failure, Item, Received, question_of
from yarpy.kits.wrap.value import payload
from yarpy.kits.wrap.value.shape import Shape
from yarpy.peers.zmq.broker import keep_ready
from yarpy.peers.zmq.link import Answerer, Caller, In, Out, parse_place

_LOCAL = ("127.0.0.1", "localhost", "0.0.0.0")


class ZeroMq:
    """The middleware `zeromq`."""

    name = "zeromq"

    def check(self, binding: Binding) -> None:
        parse_place(binding.place)
        binding.refuse(
            carrier="ZeroMQ has its own, tcp",
            qos="its threads and sockets are ZeroMQ's own",
            reliable="publishers of ZeroMQ drop what a slow subscriber cannot take",
        )

    def publisher(self, binding: Binding, shape: Shape) -> ZmqPublisher:
        return ZmqPublisher(binding)

    def listener(self, binding: Binding, shape: Shape) -> ZmqListener:
        return ZmqListener(binding, shape)

    def server(self, binding: Binding, name: str, answer: Answer) -> Answerer:
        def answered(frames: list[bytes]) -> list[Any]:
            try:
                found = answer(*question_of(payload.of_parts(frames).value))
                if not isinstance(found, Failure):
                    return payload.parts(found, binding.encoding)
            except Exception as error:
                found = Failure.of(error)
            return [payload.failure(found)]

        pub, sub = addresses(binding)
        return Answerer(binding.topic, sub, pub, answered)

    def client(self, binding: Binding, shape: Shape) -> ZmqClient:
        return ZmqClient(binding, shape)


def addresses(binding: Binding) -> tuple[str, str]:
    """Return the addresses of the broker's XPUB and XSUB. On this computer there is one from now
    on."""
    host, number = parse_place(binding.place)
    if host in _LOCAL:
        keep_ready(host, number, number + 1)
    return f"tcp://{host}:{number}", f"tcp://{host}:{number + 1}"


class ZmqPublisher:
    def __init__(self, binding: Binding) -> None:
        self._encoding = binding.encoding
        self._out = Out(binding.topic, addresses(binding)[1])

    def publish(self, item: Item) -> int:
        parts = item.form(f"parts {self._encoding}", lambda one: payload.parts(one, self._encoding))
        return self._out.send(parts)

    def wait(self, timeout: float | None) -> bool:
        return self._out.wait(timeout)

    @property
    def stats(self) -> dict[str, Any]:
        return {"messages": self._out.messages, "heard": self._out.heard}

    def close(self) -> None:
        self._out.close()


class ZmqListener:
    def __init__(self, binding: Binding, shape: Shape) -> None:
        self._binding = binding
        self._shape = shape
        keep = binding.keep if isinstance(binding.keep, int) else 0
        self._in = In(binding.topic, addresses(binding)[0], binding.keep == "latest", keep)

    def listen(self, timeout: float | None) -> Received:
        found = payload.of_parts(self._in.receive(timeout), self._shape)
        found.middleware = self._binding.middleware
        return found

    @property
    def stats(self) -> dict[str, Any]:
        return {"messages": self._in.messages, "drops": self._in.drops}

    def close(self) -> None:
        self._in.close()


class ZmqClient:
    """Several questions at a time have a way to the broker each."""

    def __init__(self, binding: Binding, shape: Shape) -> None:
        self._binding = binding
        self._shape = shape
        self._addresses = addresses(binding)
        self._idle: list[Caller] = []
        self._lock = threading.RLock()  # of the list
        self._closed = False

    def call(
        self, name: str, args: list[Any], kwargs: dict[str, Any], timeout: float | None
    ) -> Any:
        with self._lock:
            caller = self._idle.pop() if self._idle else None
        if caller is None:
            pub, sub = self._addresses
            caller = Caller(self._binding.topic, sub, pub)
        try:
            frames = caller.ask(payload.question_parts(args, kwargs), timeout)
        except BaseException:
            caller.close()
            raise
        with self._lock:
            if not self._closed:
                self._idle.append(caller)
        if self._closed:
            caller.close()
        failed = payload.failure_of(frames[0]) if len(frames) == 1 else None
        if failed is not None:
            raise failed.error()
        return payload.of_parts(frames, self._shape).value

    def close(self) -> None:
        with self._lock:
            self._closed = True
            idle, self._idle = self._idle, []
        for caller in idle:
            caller.close()
