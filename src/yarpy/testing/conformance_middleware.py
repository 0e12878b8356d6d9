"""MiddlewareConformance: what every middleware of the decorators must do, as tests to inherit.

    class TestMine(MiddlewareConformance):
        middleware = Pigeons
        place = "127.0.0.1:4711"            # what stands behind its name: pigeons://127.0.0.1:4711

Rules: the five methods of the contract (`kits/wrap/middleware.py`) between two ends in this
process, with plain asserts.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from typing import Any, ClassVar

from yarpy.errors import PortClosed, RemoteError, Timeout, YarpError
from yarpy.kits.wrap.middleware import (
    Binding,
    Client,
    Failure,
    Item,
    Listener,
    Middleware,
    Publisher,
)
from yarpy.kits.wrap.value.shape import ANY

COUNT = 20


class MiddlewareConformance:
    """Subclass it and set `middleware`.

    place: where it is. topic: of messages; service: of questions. values: what comes out as it went
    in. timeout: seconds in which two ends meet.
    """

    middleware: ClassVar[Callable[[], Middleware]]
    place: ClassVar[str] = ""
    topic: ClassVar[str] = "/suite/topic"
    service: ClassVar[str] = "/suite/service"
    values: ClassVar[Sequence[Any]] = ("text", {"angle": 45.5, "names": ["a", "b"]}, [1, 2.5, True])
    timeout: ClassVar[float] = 20.0

    def binding(self, topic: str = "", **options: Any) -> Binding:
        """Return one binding, as a decorator makes it."""
        made = type(self).middleware()
        return Binding(topic or self.topic, made.name, self.place, **options)

    def test_has_every_member(self) -> None:
        made = type(self).middleware()
        assert made.name
        for member in ("check", "publisher", "listener", "server", "client"):
            assert callable(getattr(made, member, None)), f"it has no {member}"
        made.check(self.binding())
        made.check(self.binding(self.service))

    def test_values_come_as_they_went(self) -> None:
        made = type(self).middleware()
        listener = made.listener(self.binding(keep="all"), ANY)
        publisher = made.publisher(self.binding(keep="all"), ANY)
        try:
            assert isinstance(publisher, Publisher) and isinstance(listener, Listener)
            for number, value in enumerate(self.values):
                item = Item(value, ANY, number, time.time())
                found = self._sent(publisher, item, listener)
                assert found.value == value, f"{value!r} arrived as {found.value!r}"
            assert isinstance(publisher.stats, dict) and isinstance(listener.stats, dict)
        finally:
            publisher.close()
            listener.close()

    def test_every_value_comes_in_order(self) -> None:
        made = type(self).middleware()
        listener = made.listener(self.binding(keep="all"), ANY)
        publisher = made.publisher(self.binding(keep="all", reliable=self._may_be_reliable()), ANY)
        try:
            self._sent(publisher, Item({"n": -1}, ANY), listener)
            for number in range(COUNT):
                publisher.publish(Item({"n": number}, ANY, number, 1.0))
            heard: list[int] = []
            while len(heard) < COUNT:
                number = listener.listen(self.timeout).value["n"]
                if number >= 0:  # the first one may have been sent more than once
                    heard.append(number)
            assert heard == [*range(COUNT)]
        finally:
            publisher.close()
            listener.close()

    def test_silence_is_a_timeout(self) -> None:
        made = type(self).middleware()
        listener = made.listener(self.binding("/suite/silent"), ANY)
        try:
            _raises(Timeout, lambda: listener.listen(0.05))
        finally:
            listener.close()

    def test_close_wakes_who_listens(self) -> None:
        made = type(self).middleware()
        listener = made.listener(self.binding("/suite/closing"), ANY)
        ended: list[BaseException] = []

        def listen() -> None:
            try:
                listener.listen(None)
            except BaseException as error:
                ended.append(error)

        thread = threading.Thread(target=listen, daemon=True)
        thread.start()
        time.sleep(0.1)
        listener.close()
        thread.join(self.timeout)
        assert not thread.is_alive(), "close() leaves listen() waiting"
        assert isinstance(ended[0], PortClosed), repr(ended)
        listener.close()  # twice does no harm

    def test_questions_are_answered(self) -> None:
        made = type(self).middleware()

        def answer(args: list[Any], kwargs: dict[str, Any]) -> Item | Failure:
            if args[0] == "fail":
                return Failure("ValueError", "too far")
            return Item({"args": args, "by": kwargs.get("by")})

        server = made.server(self.binding(self.service), "turn", answer)
        client = made.client(self.binding(self.service), ANY)
        try:
            assert isinstance(client, Client)
            found = client.call("turn", ["left", 2.5], {"by": 1}, self.timeout)
            assert found == {"args": ["left", 2.5], "by": 1}
            failed = _raises(RemoteError, lambda: client.call("turn", ["fail"], {}, self.timeout))
            assert "too far" in str(failed)
            assert client.call("turn", ["again"], {}, self.timeout)["args"] == ["again"]
        finally:
            client.close()
            server.close()

    def test_nobody_answers(self) -> None:
        made = type(self).middleware()
        client = made.client(self.binding("/suite/nobody"), ANY)
        try:
            begun = time.monotonic()
            _raises(YarpError, lambda: client.call("turn", [], {}, 0.3))
            assert time.monotonic() - begun < self.timeout
        finally:
            client.close()

    # -- inside -----------------------------------------------------------------------------------

    def _may_be_reliable(self) -> bool:
        try:
            type(self).middleware().check(self.binding(reliable=True))
        except ValueError:
            return False
        return True

    def _sent(self, publisher: Publisher, item: Item, listener: Listener) -> Any:
        """Return what a listener hears of a value: the first may come before it is listening."""
        publisher.wait(self.timeout)
        end = time.monotonic() + self.timeout
        while True:
            publisher.publish(item)
            try:
                found = listener.listen(0.5)
            except Timeout:
                if time.monotonic() > end:
                    raise
                continue
            if found.value == item.plain or time.monotonic() > end:
                return found


def _raises(kind: type[Exception], call: Callable[[], object]) -> Exception:
    try:
        found = call()
    except kind as error:
        return error
    raise AssertionError(f"{kind.__name__} was expected, and {found!r} came")
