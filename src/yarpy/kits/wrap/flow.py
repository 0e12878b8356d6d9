"""Flow of values while a mode is active: out to several middlewares, and in from several.

Rules: the values of one call have one count and one time. They are checked before the first is
sent. A listener of one middleware reads it in the caller's thread; several, or an event loop, have
a thread each that reads ahead.
"""

from __future__ import annotations

import itertools
import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, Final

from yarpy.errors import Timeout
from yarpy.kits.wrap.method import Method, Missing, Output, middleware_of
from yarpy.kits.wrap.middleware import Item, Keep, Listener, Publisher, Received
from yarpy.kits.wrap.receive_queue import ReceiveQueue, pump
from yarpy.kits.wrap.value.shape import Shape

SET: Final = 64  # values of each topic that wait for those of the others


class Outlets:
    """Sends what a method returns."""

    def __init__(self, method: Method, outputs: Sequence[Output]) -> None:
        self._method = method
        self._shapes = method.shapes()
        self._publishers: list[list[Publisher]] = []
        self._names: list[list[str]] = []
        self._single = len(outputs) == 1
        self._count = itertools.count()
        self._waited = not method.wait
        self._source = outputs[0].topic
        try:
            for output, shape in zip(outputs, self._shapes, strict=True):
                row: list[Publisher] = []
                self._publishers.append(row)
                for binding in output.bindings(output.topic):
                    row.append(middleware_of(binding).publisher(binding, shape))
        except BaseException:
            self.close()
            raise
        self._topics = [(output.topic, output.middlewares) for output in outputs]
        if self._single and len(self._publishers[0]) == 1:
            self._send_now = self._to(self._publishers[0][0], self._shapes[0])
        else:
            self._send_now = self._send_several
        #: Sends what a call returned. Raises TypeError, ValueError for what cannot be sent.
        self.send = self._send_now if self._waited else self._send_patiently

    def _send_patiently(self, value: Any) -> None:
        if not self._waited:
            self._wait()
        self._send_now(value)

    def _to(self, publisher: Publisher, shape: Shape) -> Callable[[Any], None]:
        """Return the function that sends a single value to a single middleware: what is the same
        for each value is looked up once."""
        exact, dump, publish, source = shape.exact, shape.dump, publisher.publish, self._source
        number, now = self._count.__next__, time.time

        def send(value: Any) -> None:
            if type(value) is not exact:
                try:
                    value = dump(value)
                except TypeError as error:
                    raise self._wrong(error) from None
            publish(Item(value, shape, number(), now(), source))

        return send

    def _wrong(self, error: TypeError) -> TypeError:
        """The error for a method that returned something else than its hint says."""
        return TypeError(f"{self._method.qualname} returned another thing than its hint: {error}")

    def _send_several(self, value: Any) -> None:
        values = (value,) if self._single else value
        if not isinstance(values, (tuple, list)) or len(values) != len(self._shapes):
            raise TypeError(
                f"{self._method.qualname} returned {type(value).__name__}, and not a tuple of "
                f"{len(self._shapes)}, one value for each decorator"
            )
        count, now = next(self._count), round(time.time(), 6)  # what an envelope holds
        try:
            items = [
                Item(shape.dump(one), shape, count, now, self._source)
                for shape, one in zip(self._shapes, values, strict=True)
            ]
        except TypeError as error:
            raise self._wrong(error) from None
        for item, publishers in zip(items, self._publishers, strict=True):
            if len(publishers) > 1:
                item.forms = {}
            for publisher in publishers:
                publisher.publish(item)

    def _wait(self) -> None:
        deadline = time.monotonic() + self._method.wait
        for (topic, _), publishers in zip(self._topics, self._publishers, strict=True):
            for publisher in publishers:
                left = deadline - time.monotonic()
                if not publisher.wait(None if left == float("inf") else max(left, 0.0)):
                    raise Timeout(f'nobody listens to "{topic}" after {self._method.wait} s')
        self._waited = True

    @property
    def stats(self) -> list[dict[str, Any]]:
        return [
            {"topic": topic, "middleware": name, "direction": "out", **publisher.stats}
            for (topic, names), publishers in zip(self._topics, self._publishers, strict=True)
            for name, publisher in zip(names, publishers, strict=True)
        ]

    def close(self) -> None:
        for publishers in self._publishers:
            for publisher in publishers:
                publisher.close()


class Inlet:
    """Listens to one value, on one middleware or on several at once."""

    def __init__(self, output: Output, topic: str, shape: Shape, together: bool = False) -> None:
        self.topic = topic
        self.names = output.middlewares
        self.last: Received | None = None
        self._keep: Keep = SET if together else output.keep
        if together:  # the newest of one is rarely that of the others
            output = replace(output, keep="all")
        self._listeners: list[Listener] = []
        self._queue: ReceiveQueue | None = None
        self._lock = threading.Lock()  # of the decision to read ahead
        try:
            for binding in output.bindings(topic):
                self._listeners.append(middleware_of(binding).listener(binding, shape))
        except BaseException:
            self.close()
            raise
        if together or len(self._listeners) > 1:
            self.read_ahead()

    def read_ahead(self) -> ReceiveQueue:
        """From now on threads read, and what came waits in a queue."""
        with self._lock:
            if self._queue is None:
                self._queue = ReceiveQueue(self._keep)
                for listener in self._listeners:
                    pump(listener, self._queue, self.topic)
            return self._queue

    def listen(self, timeout: float | None) -> Received:
        queue = self._queue
        try:
            found = self._listeners[0].listen(timeout) if queue is None else queue.take(timeout)
        except Timeout as error:
            raise self._late(error) from None
        self.last = found
        return found

    async def listen_async(self, timeout: float | None) -> Received:
        try:
            self.last = await self.read_ahead().take_async(timeout)
        except Timeout as error:
            raise self._late(error) from None
        return self.last

    def _late(self, error: Timeout) -> Timeout:
        """Return the error for a topic from which nothing came, which names it."""
        return error if self._queue is None else Timeout(f'"{self.topic}": {error}')

    @property
    def stats(self) -> list[dict[str, Any]]:
        return [
            {"topic": self.topic, "middleware": name, "direction": "in", **listener.stats}
            for name, listener in zip(self.names, self._listeners, strict=True)
        ]

    def close(self) -> None:
        if self._queue is not None:
            self._queue.close()
        for listener in self._listeners:
            listener.close()


class Inlets:
    """Listens to all that a method would have returned, or is to be given."""

    def __init__(self, method: Method, places: Sequence[tuple[Output, str, Shape]]) -> None:
        self._method = method
        self._inlets: list[Inlet] = []
        self._together = method.together and len(places) > 1
        try:
            for output, topic, shape in places:
                self._inlets.append(Inlet(output, topic, shape, self._together))
        except BaseException:
            self.close()
            raise

    @property
    def last(self) -> list[Received | None]:
        """Return the last value from each topic, None if there is none yet."""
        return [inlet.last for inlet in self._inlets]

    def listen(self, timeout: float | None) -> list[Any]:
        """One value from each topic. Raises Timeout, unless `missing` says otherwise."""
        clock = _Clock(timeout)
        if not self._together:
            return [self._one(inlet, clock.left) for inlet in self._inlets]
        try:
            found = [inlet.listen(clock.left) for inlet in self._inlets]
            while (late := _late(found)) is not None:
                found[late] = self._inlets[late].listen(clock.left)
        except Timeout:
            return self._missed()
        return [one.value for one in found]

    async def listen_async(self, timeout: float | None) -> list[Any]:
        """The same in an event loop."""
        clock = _Clock(timeout)
        if not self._together:
            values = []
            for inlet in self._inlets:
                try:
                    values.append((await inlet.listen_async(clock.left)).value)
                except Timeout:
                    values.append(self._instead(inlet))
            return values
        try:
            found = [await inlet.listen_async(clock.left) for inlet in self._inlets]
            while (late := _late(found)) is not None:
                found[late] = await self._inlets[late].listen_async(clock.left)
        except Timeout:
            return self._missed()
        return [one.value for one in found]

    def listen_to_one(self, timeout: float | None) -> Any:
        """As `listen` where there is one topic: its value."""
        try:
            return self._inlets[0].listen(timeout).value
        except Timeout:
            return self._instead(self._inlets[0])

    def _one(self, inlet: Inlet, timeout: float | None) -> Any:
        try:
            return inlet.listen(timeout).value
        except Timeout:
            return self._instead(inlet)

    def _instead(self, inlet: Inlet) -> Any:
        """Return the value in place of one that has not come; call it where Timeout was caught."""
        missing: Missing = self._method.missing
        if missing == "raise" or (missing == "last" and inlet.last is None):
            raise
        return None if missing == "none" or inlet.last is None else inlet.last.value

    def _missed(self) -> list[Any]:
        return [self._instead(inlet) for inlet in self._inlets]

    @property
    def stats(self) -> list[dict[str, Any]]:
        return [one for inlet in self._inlets for one in inlet.stats]

    def close(self) -> None:
        for inlet in self._inlets:
            inlet.close()


def _late(found: Sequence[Received]) -> int | None:
    """Return the index of a value that is of an earlier call than the others; None if all are of
    one."""
    times = [one.time or 0.0 for one in found]  # counts begin again with a program
    newest = max(times)
    return next((index for index, time_ in enumerate(times) if time_ != newest), None)


class _Clock:
    """The time that is left of a timeout."""

    def __init__(self, timeout: float | None) -> None:
        self._deadline = None if timeout is None else time.monotonic() + timeout

    @property
    def left(self) -> float | None:
        return None if self._deadline is None else max(self._deadline - time.monotonic(), 0.0)
