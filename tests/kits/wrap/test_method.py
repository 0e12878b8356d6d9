"""Decorated methods: their hints and decorators, and errors that name what is wrong."""

from __future__ import annotations

import threading
from collections.abc import AsyncIterator, Iterator
from typing import Any

import numpy as np
import pytest

import yarpy
from yarpy.kits.wrap.method import Method, Output
from yarpy.kits.wrap.value.shape import ANY


def method(func: Any, *topics: str) -> Method:
    found = Method(func)
    for topic in reversed(topics):
        found.add(Output(topic))
    return found


def test_kinds() -> None:
    async def coroutine() -> int: ...
    def generator() -> Iterator[int]:
        yield 1

    async def both() -> AsyncIterator[int]:
        yield 1

    kinds = {func: Method(func).kind for func in (coroutine, generator, both)}
    assert [*kinds.values()] == ["coroutine", "generator", "async generator"]
    assert all(Method(func).result.name == "int" for func in kinds)


def test_parameter_that_cannot_be_sent_is_named() -> None:
    def look(self: Any, lock: threading.Thread) -> int: ...

    with pytest.raises(TypeError, match=r'look: the parameter "lock": threading.Thread cannot'):
        Method(look)

    def give() -> threading.Thread: ...

    with pytest.raises(TypeError, match=r"give: what it returns: threading.Thread cannot"):
        Method(give)


def test_several_decorators_are_for_the_elements_of_a_tuple() -> None:
    def look(self: Any) -> tuple[np.ndarray, dict]: ...

    assert [one.name for one in method(look, "/a", "/b").shapes()] == ["an array", "a dict"]
    assert method(look, "/a").shapes()[0].name == "a tuple of 2"
    with pytest.raises(TypeError, match="3 decorators"):
        method(look, "/a", "/b", "/c")

    def one(self: Any) -> int: ...

    with pytest.raises(TypeError, match="one element of a tuple"):
        method(one, "/a", "/b")

    def three(self: Any) -> tuple[int, int, int]: ...

    with pytest.raises(TypeError, match="returns 3 values and has 2"):
        method(three, "/a", "/b").shapes()

    def unsaid(self: Any): ...

    assert method(unsaid, "/a", "/b").shapes() == [ANY, ANY]


def test_what_the_middleware_cannot_do_is_an_error_of_the_decorator() -> None:
    def look() -> int: ...

    for wrong in ({"keep": 3}, {"middlewares": ("yarp://here",)}, {"topic": "a"}):
        with pytest.raises(ValueError) as caught:
            Method(look).add(Output(**({"topic": "/a"} | wrong)))
        assert any("look" in note for note in caught.value.__notes__)
    with pytest.raises(yarpy.UnknownPlugin, match='did you mean "yarp"'):
        Method(look).add(Output("/a", ("yarb",)))
    for wrong in ({"keep": "some"}, {"keep": 0}, {"encoding": "x"}, {"middlewares": ()}):
        with pytest.raises(ValueError):
            Output(**({"topic": "/a"} | wrong))
    with pytest.raises(yarpy.AddressError):
        Output("")


def test_names_that_are_defined_later() -> None:
    def look() -> Later: ...  # noqa: F821

    found = method(look, "/a")
    with pytest.raises(TypeError, match="Later"):
        found.shapes()


def test_arguments() -> None:
    def look(self: Any, a: int, *rest: float, b: str = "x", **more: bytes) -> int: ...

    found = method(look, "/a")
    me = object()
    assert found.dump(me, (1, 2), {"b": "y", "c": b"z"}) == ([1, 2.0], {"b": "y", "c": b"z"})
    assert found.load(me, [1, 2.5], {"c": b"z"}) == ([1, 2.5], {"c": b"z"})
    with pytest.raises(TypeError, match='the argument "a": expected int'):
        found.dump(me, ("x",), {})
    with pytest.raises(TypeError, match="missing"):
        found.dump(me, (), {})
    with pytest.raises(yarpy.DecodeError, match='the argument "a" of'):
        found.load(me, ["x"], {})


def test_arguments_in_their_order() -> None:
    def look(self: Any, a: int, b: float = 2.0) -> int: ...

    found = method(look, "/a")
    me = object()
    for args, kwargs in (((1, 3), {}), ((1,), {"b": 3}), ((), {"b": 3, "a": 1})):
        assert found.dump(me, args, kwargs) == ([1, 3.0], {})
        assert found.load(me, args, kwargs) == ([1, 3.0], {})
    assert found.dump(me, (1,), {}) == ([1], {})
    assert found.dump(None, (me, 1, 3), {}) == ([me, 1, 3.0], {})
    with pytest.raises(TypeError, match='the argument "b": expected'):
        found.dump(me, (1, "x"), {})
    with pytest.raises(yarpy.DecodeError, match='the argument "b" of'):
        found.load(me, [1, "x"], {})
    with pytest.raises(TypeError, match="too many positional arguments"):
        found.dump(me, (1, 2, 3), {})


def test_arguments_that_go_as_they_are() -> None:
    def look(self: Any, a: int, b: list[Any], c: Any) -> int: ...

    found = method(look, "/a")
    assert found.exact(bound=True) == (int, list, None)
    assert found.exact(bound=False) == (None, int, list, None)

    def ask(self: Any, *, a: int) -> int: ...

    # Without arguments in order it is not complete either.
    assert method(ask, "/a").exact(bound=True) != ()


def test_inputs_are_the_first_parameters() -> None:
    def mix(self: Any, a: int, b: str, gain: float = 1.0) -> tuple[int, str]: ...

    assert [one.name for one in method(mix, "/a", "/b").inputs(True)] == ["int", "str"]

    def all_(self: Any, *data: int) -> tuple[int, int]: ...

    assert [one.name for one in method(all_, "/a", "/b").inputs(True)] == ["int", "int"]

    def none(self: Any) -> int: ...

    with pytest.raises(TypeError, match="takes 0 arguments, and gets 1"):
        method(none, "/a").inputs(True)


def test_topics_of_an_object() -> None:
    class Eye:
        name = "left"

    def look(self: Any) -> int: ...

    found = method(look, "/{self.name}/image")
    assert found.placed(Eye(), {})[0].topic == "/left/image"
    changed = found.placed(Eye(), {"topic": "/x", "carrier": "udp", "middleware": "yarp"})[0]
    assert (changed.topic, changed.carrier, changed.middlewares) == ("/x", "udp", ("yarp",))
    with pytest.raises(yarpy.LocalProtocolError, match=r"write \{self.NAME\}"):
        method(look, "/{self.nothing}/image").placed(Eye(), {})
    with pytest.raises(ValueError):
        found.placed(Eye(), {"keep": 3})
