"""Values out to several middlewares and in from several, by a middleware of the test's own."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from typing import Any

import pytest
from support.wait import HANG

import yarpy
from yarpy import registry, wrap
from yarpy.kits.wrap.flow import Inlets, Outlets
from yarpy.kits.wrap.method import Method, Output
from yarpy.kits.wrap.middleware import Binding, Received
from yarpy.kits.wrap.receive_queue import ReceiveQueue


class Air:
    """A middleware in which everything stays."""

    name = "air"
    topics: dict[str, ReceiveQueue] = {}
    sent: list[Any] = []
    heard = True

    def check(self, binding: Binding) -> None:
        pass

    def publisher(self, binding: Binding, shape: Any) -> Any:
        return Voice(binding)

    def listener(self, binding: Binding, shape: Any) -> Any:
        return Ear(
            self.topics.setdefault(binding.topic + binding.place, ReceiveQueue("all")), binding
        )


class Voice:
    stats = {"messages": 1}

    def __init__(self, binding: Binding) -> None:
        self.binding = binding

    def publish(self, item: Any) -> int:
        Air.sent.append((self.binding.topic, item.form("x", lambda item: [item.plain]), item))
        return 1

    def wait(self, timeout: float | None) -> bool:
        return Air.heard

    def close(self) -> None:
        pass


class Ear:
    stats = {"messages": 2}

    def __init__(self, queue: ReceiveQueue, binding: Binding) -> None:
        self.queue, self.binding = queue, binding

    def listen(self, timeout: float | None) -> Received:
        found = self.queue.take(timeout)
        found.middleware = self.binding.place
        return found

    def close(self) -> None:
        self.queue.close()


@pytest.fixture(autouse=True)
def air() -> Iterator[type[Air]]:
    registry.middlewares.add("air", Air)
    Air.topics, Air.sent, Air.heard = {}, [], True
    yield Air
    registry.middlewares.remove("air")


def look(self: Any) -> tuple[int, str]: ...


def method(*outputs: Output, **options: Any) -> Method:
    found = Method(look)
    for output in reversed(outputs):
        found.add(output)
    for name, value in options.items():
        setattr(found, name, value)
    return found


A, B = Output("/a", ("air",)), Output("/b", ("air://x", "air://y"))


def test_values_of_a_call_have_one_stamp_and_are_spelled_once() -> None:
    outlets = Outlets(method(A, B), [A, B])
    outlets.send((1, "x"))
    assert [(topic, form) for topic, form, _ in Air.sent] == [
        ("/a", [1]),
        ("/b", ["x"]),
        ("/b", ["x"]),
    ]
    assert Air.sent[1][1] is Air.sent[2][1]
    assert len({(item.count, item.time) for _, _, item in Air.sent}) == 1
    assert [one["middleware"] for one in outlets.stats] == ["air", "air://x", "air://y"]


def test_nothing_is_sent_of_what_is_not_whole() -> None:
    outlets = Outlets(method(A, B), [A, B])
    for wrong in ((1, 2), (1,), 3, ("x", "y")):
        with pytest.raises(TypeError):
            outlets.send(wrong)
    assert Air.sent == []


def test_first_value_waits_for_a_listener() -> None:
    outlets = Outlets(method(A, B, wait=0.01), [A, B])
    Air.heard = False
    with pytest.raises(yarpy.Timeout, match='nobody listens to "/a"'):
        outlets.send((1, "x"))
    Air.heard = True
    outlets.send((1, "x"))


def inlets(found: Method, *outputs: Output) -> Inlets:
    return Inlets(found, [(one, one.topic, shape) for one, shape in zip(outputs, found.shapes())])  # noqa: B905


def test_whichever_middleware_has_something() -> None:
    found = inlets(method(A, B), A, B)
    Air.topics["/a"].put(Received(1))
    Air.topics["/by"].put(Received("from y"))
    assert found.listen(HANG) == [1, "from y"]
    assert found.last[1].middleware == "y"
    found.close()


@pytest.mark.parametrize("missing", ["raise", "none", "last"])
def test_what_is_missing(missing: str) -> None:
    found = inlets(method(A, A, missing=missing), A, A)
    Air.topics["/a"].put(Received(1))
    Air.topics["/a"].put(Received(2))
    assert found.listen(HANG) == [1, 2]
    if missing == "raise":
        with pytest.raises(yarpy.Timeout):
            found.listen(0.01)
        with pytest.raises(yarpy.Timeout):
            asyncio.run(found.listen_async(0.01))
    else:
        expected = [None, None] if missing == "none" else [1, 2]
        assert found.listen(0.01) == expected
        assert asyncio.run(found.listen_async(0.01)) == expected
    found.close()


@pytest.mark.parametrize("in_loop", [False, True])
def test_values_of_the_same_call(in_loop: bool) -> None:
    one, two = Output("/a", ("air",)), Output("/c", ("air",))
    found = inlets(method(one, two, together=True), one, two)
    for count in (1, 2, 4):
        Air.topics["/a"].put(Received(count, count, float(count)))
    for count in (2, 3, 4):
        Air.topics["/c"].put(Received(str(count), count, float(count)))

    def listen() -> list[Any]:
        if in_loop:
            return asyncio.run(found.listen_async(HANG))
        return found.listen(HANG)

    assert listen() == [2, "2"]
    assert listen() == [4, "4"]
    with pytest.raises(yarpy.Timeout):
        found.listen(0.01)
    found.close()


def test_what_the_hint_does_not_say_names_the_method() -> None:
    class Arm:
        @wrap.on("/arm/joints", "air")
        def joints(self) -> int:
            return "x"  # type: ignore[return-value]

        @wrap.on("/arm/force", "air")
        @wrap.on("/arm/pose", "air")
        def both(self) -> tuple[int, int]:
            return 1, "x"  # type: ignore[return-value]

    arm = Arm()
    for method, name in ((arm.joints, "joints"), (arm.both, "both")):
        with wrap.publish(method), pytest.raises(TypeError, match=f"{name} returned .*got 'x'"):
            method()
