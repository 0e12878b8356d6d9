"""The four sides of every middleware: publisher, listener, server and client of each type.

A middleware is a `Medium`: how each type is spelled (`Form`), and what carries that. `offer` makes
the classes of it and registers them. What carries is opened by the first call that communicates:

    out(publisher)      wait(seconds) -> whether somebody listens; send(spelled); close()
    into(listener)      wait(seconds) -> whether somebody publishes; receive(timeout) -> what came;
                        close()
    serving(server)     take() -> (what came, answer), answer(spelled | Failure); close()
    asking(client)      wait(seconds) -> whether somebody serves; ask(spelled, timeout) -> what
                        came; close()

Rules: whatever waits raises Timeout, and PortClosed when it is closed meanwhile. A request is what
the form of NativeObject makes of `[args, kwargs]`. A request that cannot be read, and an answer
that cannot be spelled, are told to the client: nobody is left waiting.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar, Protocol

import yarpy
from wrapyfi.connect.clients import Client, Clients
from wrapyfi.connect.listeners import Listener, Listeners
from wrapyfi.connect.publishers import Publisher, Publishers
from wrapyfi.connect.servers import Server, Servers
from wrapyfi.middlewares._form import patience
from wrapyfi.utils.core_utils import SingletonOptimized
from yarpy.kits.wrap.middleware import Failure, question_of

#: what `Form.value` gives for a message that listeners are not told of
SKIP = object()
_LOOK = 0.2  # seconds between two looks whether something that waits was closed


class Form(Protocol):
    """How values of a type are spelled. `nothing` is what a listener gets that does not wait."""

    nothing: Any

    def __init__(self, options: dict[str, Any]) -> None: ...

    def spelled(self, obj: Any) -> Any:
        """Return what is sent; None for nothing. Raises TypeError, ValueError."""

    def value(self, came: Any) -> Any:
        """The value, or SKIP. Raises ValueError."""


@dataclass(frozen=True)
class Medium:
    """A middleware. Without `serving` and `asking` it has topics alone. Listeners of one that is
    `forgiving` tell the log what cannot be read, and wait for the next."""

    name: str
    topics: Mapping[str, Callable[[dict[str, Any]], Form]]
    out: Callable[[Any], Any]
    into: Callable[[Any], Any]
    answers: Mapping[str, Callable[[dict[str, Any]], Form]] = field(default_factory=dict)
    serving: Callable[[Any], Any] | None = None
    asking: Callable[[Any], Any] | None = None
    forgiving: bool = False


class Nothing(metaclass=SingletonOptimized):
    """The calls that start and stop a middleware by hand. There is nothing to do."""

    @classmethod
    def activate(cls, **kwargs: Any) -> Any:
        return cls()

    @staticmethod
    def deinit() -> None:
        return None


def _awaited(part: Any, wanted: Callable[[], bool], looks: int | None = None) -> bool:
    """Wait for somebody for so many looks, else as long as is allowed, while `wanted`. Raises
    PortClosed."""
    limit = patience() if looks is None or looks < 0 else looks * _LOOK
    deadline = None if limit is None else time.monotonic() + limit
    while wanted():
        left = _LOOK if deadline is None else min(deadline - time.monotonic(), _LOOK)
        if part.wait(max(left, 0.0)):
            return True
        if deadline is not None and time.monotonic() >= deadline:
            return False
    raise yarpy.PortClosed("this was closed")


class _Side:
    """One end, opened with its first use and closed for good, perhaps while it is being opened."""

    medium: ClassVar[Medium]
    kind: ClassVar[str]
    _opened: Any = None
    _closed = False

    def _open(self, make: Callable[[Any], Any]) -> Any:
        """Return what `make` has opened, now or before. Raises PortClosed."""
        if self._opened is None and not self._closed:
            self._opened = make(self)
        opened = self._opened
        if self._closed or opened is None:
            if opened is not None:
                opened.close()
            raise yarpy.PortClosed("this was closed")
        return opened

    def close(self) -> None:
        self._closed, self.established = True, False
        opened, self._opened = self._opened, None
        if opened is not None:
            opened.close()


class _Sending(_Side, Publisher):
    def __init__(
        self,
        name: str,
        out_topic: str,
        carrier: str = "",
        should_wait: bool = True,
        **options: Any,
    ) -> None:
        super().__init__(name, out_topic, carrier, should_wait, **options)
        self.options = options
        self.form = self.medium.topics[self.kind](options)

    def establish(self, repeats: int | None = None, **kwargs: Any) -> bool:
        self._open(self.medium.out)
        found = not self.should_wait or self.await_connection(repeats=repeats)
        if not found and (repeats is None or repeats < 0):
            raise yarpy.Timeout(f'nobody listens to "{self.out_topic}"')
        return self.check_establishment(found)

    def await_connection(self, *parts: Any, repeats: int | None = None, **named: Any) -> bool:
        """Wait until somebody listens: `repeats` times 0.2 s, else for WRAPYFI_TIMEOUT seconds, and
        not at all where nothing `should_wait`. What else the original takes changes nothing."""
        out = self._open(self.medium.out)
        looks = 0 if repeats is None and not self.should_wait else repeats
        return _awaited(out, lambda: not self._closed, looks)

    def publish(self, obj: Any) -> None:
        spelled = self.form.spelled(obj)
        if spelled is None:
            return
        if not self.established:
            self.establish()
        self._open(self.medium.out).send(spelled)


class _Taking(_Side, Listener):
    def __init__(
        self,
        name: str,
        in_topic: str,
        carrier: str = "",
        should_wait: bool = True,
        **options: Any,
    ) -> None:
        super().__init__(name, in_topic, carrier, should_wait, **options)
        self.options = options
        self.form = self.medium.topics[self.kind](options)

    def establish(self, repeats: int | None = None, **kwargs: Any) -> bool:
        self._patience = patience() if self.should_wait else 0.0
        found = self.await_connection(repeats=repeats)
        if not found and self.should_wait and (repeats is None or repeats < 0):
            raise yarpy.Timeout(f'nobody publishes "{self.in_topic}"')
        return self.check_establishment(found)

    def await_connection(self, *parts: Any, repeats: int | None = None, **named: Any) -> bool:
        """Wait until somebody publishes, as a publisher waits until somebody listens."""
        into = self._open(self.medium.into)
        looks = 0 if repeats is None and not self.should_wait else repeats
        return _awaited(into, lambda: not self._closed, looks)

    def listen(self) -> Any:
        if not self.established and not self.establish():
            return self.form.nothing
        while True:
            try:
                came = self._open(self.medium.into).receive(self._patience)
            except yarpy.Timeout:
                if self.should_wait:
                    raise
                return self.form.nothing
            value = self._value(came)
            if value is not SKIP:
                return value

    def _value(self, came: Any) -> Any:
        try:
            return self.form.value(came)
        except (ValueError, TypeError, LookupError) as error:
            if not self.medium.forgiving:
                raise
            logging.error("[wrapyfi] %s: what came cannot be read: %s", self.in_topic, error)
            return SKIP


class _Serving(_Side, Server):
    def __init__(
        self,
        name: str,
        out_topic: str,
        carrier: str = "",
        out_topic_connect: str | None = None,
        **options: Any,
    ) -> None:
        super().__init__(name, out_topic, carrier, out_topic_connect, **options)
        self.options = options
        self.form = self.medium.answers[self.kind](options)
        self._request = self.medium.topics["NativeObject"](options)
        self._answer: Callable[[Any], None] | None = None

    def establish(self, *args: Any, **kwargs: Any) -> bool:
        assert self.medium.serving is not None
        self._open(self.medium.serving)
        return self.check_establishment(True)

    def await_request(self, *args: Any, **kwargs: Any) -> tuple[list[Any], dict[str, Any]]:
        if not self.established:
            self.establish()
        while True:
            assert self.medium.serving is not None
            came, answer = self._open(self.medium.serving).take()
            try:
                found = question_of(self._request.value(came))
            except Exception as error:
                logging.error("[wrapyfi] a request that cannot be read: %s", error)
                answer(Failure.of(error))
                continue
            self._answer = answer
            return found

    def reply(self, obj: Any) -> None:
        answer, self._answer = self._answer, None
        if answer is None:
            return
        if isinstance(obj, Exception):
            answer(Failure.of(obj))
            return
        try:
            spelled = self.form.spelled(obj)
        except Exception as error:
            answer(Failure.of(error))
            raise
        answer(spelled)

    def close(self) -> None:
        self.reply(yarpy.PortClosed("the server was closed"))
        super().close()


class _Asking(_Side, Client):
    def __init__(self, name: str, in_topic: str, carrier: str = "", **options: Any) -> None:
        super().__init__(name, in_topic, carrier, **options)
        self.options = options
        self.form = self.medium.answers[self.kind](options)
        self._request = self.medium.topics["NativeObject"](options)

    def establish(self, *args: Any, **kwargs: Any) -> bool:
        self._patience = patience()
        assert self.medium.asking is not None
        self._open(self.medium.asking)
        return self.check_establishment(True)

    def request(self, *args: Any, **kwargs: Any) -> Any:
        spelled = self._request.spelled([args, kwargs])
        if not self.established:
            self.establish()
        assert self.medium.asking is not None
        client = self._open(self.medium.asking)
        if not (client.wait(0.0) or _awaited(client, lambda: not self._closed)):
            raise yarpy.Timeout(f'nobody serves "{self.in_topic}"')
        return self.form.value(client.ask(spelled, self._patience))


class _NoProperties:
    """Properties, where there are none."""

    nothing: Any = None

    def __init__(self, options: dict[str, Any]) -> None:
        raise NotImplementedError("Properties are parameters of ROS: only ros has them")

    def spelled(self, obj: Any) -> Any: ...

    def value(self, came: Any) -> Any: ...


#: how names of classes begin, where it is not the middleware's own name
SPELLED = {"yarp": "Yarp", "zeromq": "ZeroMQ", "ros": "ROS", "ros2": "ROS2", "mqtt": "Mqtt"}
SPELLED |= {"zenoh": "Zenoh", "websocket": "WebSocket"}


def offer(medium: Medium) -> None:
    """Make the classes of a middleware, one for each side and type, and register them."""
    topics = {"Properties": _NoProperties, **medium.topics}
    medium = replace(medium, topics=topics)
    sides: list[tuple[Any, Any, str, Any]] = [
        (Publishers, _Sending, "Publisher", topics),
        (Listeners, _Taking, "Listener", topics),
        (Servers, _Serving, "Server", medium.answers),
        (Clients, _Asking, "Client", medium.answers),
    ]
    start = SPELLED.get(medium.name, medium.name.title())
    for registry, side, word, forms in sides:
        if not forms:
            continue
        base = type(f"{start}{word}", (side,), {"medium": medium})
        for kind in forms:
            name = f"{start}{kind.removeprefix(start)}{word}"
            registry.register(kind, medium.name)(type(name, (base,), {"kind": kind}))
