"""Which service a method is, and its arguments and results as messages; no ROS is needed."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Annotated, Any, NamedTuple

import numpy as np
import pytest

import yarpy
from yarpy.kits import wrap
from yarpy.kits.wrap.method import Method
from yarpy.kits.wrap.middleware import Binding, Failure, Item
from yarpy.peers.ros.message.library import Library
from yarpy.peers.ros.service.method import Service, Types, error_of, handled, topic_and_type

Picture = Annotated[np.ndarray, wrap.Image("bgr")]


def types_() -> Types:
    """Those of a library of its own."""
    library = Library()
    return Types("[a-z](?:_?[a-z0-9])*", lambda: library, lambda one: one.catalogue.sources)


class Pair(NamedTuple):
    left: int
    right: str


@dataclass
class State:
    angle: float
    names: list[str]


def service(func: Any, topic: str = "/x", types: Types | None = None) -> Service:
    return Service(Binding(topic, "ros", signature=Method(func).called(False)), types or types_())


def crossed(func: Any, *args: Any, **kwargs: Any) -> Any:
    """What a client gets from a server, whose message is written and read in between."""
    there, method = service(func), Method(func)

    def answer(given: list[Any], named: dict[str, Any]) -> Item | Failure:
        positional, by_name = method.load(None, given, named)
        return Item(method.result.dump(func(*positional, **by_name)), method.result)

    asked = there.request(*method.dump(None, args, kwargs))
    asked = there.kind.Request.from_ros(bytearray(b"".join(asked.to_ros())))
    told = handled(there, asked, answer)
    if isinstance(told, list):
        raise error_of(told[1])
    return there.value(there.kind.Response.from_ros(bytearray(b"".join(told.to_ros()))))


def test_std_srvs() -> None:
    def stop() -> None: ...

    def trigger() -> tuple[bool, str]: ...

    def switch(data: bool) -> tuple[bool, str]: ...

    def other(on: bool) -> tuple[bool, str]: ...

    names = [service(one).kind.name for one in (stop, trigger, switch, other)]
    assert names[:3] == ["std_srvs/Empty", "std_srvs/Trigger", "std_srvs/SetBool"]
    assert names[3].startswith("yarpy_wrap/Other")


def test_types_that_are_made() -> None:
    types = types_()

    def see(
        word: str,
        n: int,
        xs: list[float],
        image: Picture,
        data: bytes,
        rest: dict,
        *,
        k: bool = True,
    ) -> State: ...

    kind = service(see, types=types).kind
    assert kind.definition.text == (
        "string word\nint64 n\nfloat64[] xs\nsensor_msgs/Image image\nuint8[] data\nstring rest\n"
        "bool k\n---\nfloat64 angle\nstring[] names\n"
    )
    assert re.fullmatch("yarpy_wrap/See[0-9A-F]{8}", kind.name)
    assert service(see, types=types).kind is kind

    def pair() -> Pair: ...

    assert service(pair).kind.definition.text == "---\nint64 result0\nstring result1\n"


def test_values() -> None:
    def all_(
        word: str, xs: list[int], image: Picture, data: bytes, rest: Any = None, *, k: float = 1.5
    ) -> dict:
        picture = image[0, 0].tolist()
        return {"all": [word, xs, picture, len(data), rest, k]}

    image = np.full((2, 3, 3), (1, 2, 3), "u1")
    found = crossed(all_, "a", [1, 2], image, b"xyz", rest=(1, None))
    assert found == {"all": ["a", [1, 2], [1, 2, 3], 3, (1, None), 1.5]}
    assert crossed(all_, "a", [], image, b"", k=2.5)["all"][-1] == 2.5

    def state(angle: float) -> State:
        return State(angle, ["x"])

    def pair(n: int) -> Pair:
        return Pair(n, "r")

    def nothing(n: int) -> None: ...

    def raw(n: int) -> bytes:
        return bytes(n)

    def cloud(n: int) -> yarpy.Image:
        return yarpy.Image(np.zeros((n, n), "u1"))

    assert crossed(state, 0.5) == State(0.5, ["x"]) and crossed(pair, 3) == Pair(3, "r")
    assert crossed(nothing, 1) is None and crossed(raw, 2) == b"\0\0"
    assert crossed(cloud, 4).array.shape == (4, 4)


def test_named_types() -> None:
    types = types_()
    types.add("arm/Move", "float32 x\nint32[] steps\n---\nbool done\nstring why\n")

    def move(steps: list[int], x: float) -> tuple[bool, str]: ...

    found = service(move, "/move~arm/srv/Move", types)
    assert found.topic == "/move"
    request = found.request([[1, 2], 0.5], {})
    assert request.x == 0.5 and list(request.steps) == [1, 2]
    assert found.arguments(request) == ([[1, 2], 0.5], {})

    def loose(x, steps): ...

    told = service(loose, "/move~arm/Move", types).response(Item((True, "so")))
    assert (told.done, told.why) == (True, "so")
    assert service(loose, "/move~arm/Move", types).value(told) == (True, "so")
    with pytest.raises(TypeError, match="returns int, and arm/Move answers with done, why"):
        service(loose, "/move~arm/Move", types).response(Item(7))


def wrong_name(y: float, steps: list[int]) -> tuple[bool, str]: ...


def wrong_type(x: str, steps: list[int]) -> tuple[bool, str]: ...


def wrong_list(x: float, steps: int) -> tuple[bool, str]: ...


def missing(x: float) -> tuple[bool, str]: ...


def wrong_result(x: float, steps: list[int]) -> str: ...


def wrong_results(x: float, steps: list[int]) -> tuple[str, bool]: ...


@pytest.mark.parametrize(
    ("func", "why"),
    [
        (wrong_name, 'the parameter "y": arm/Move has x, steps'),
        (wrong_type, 'the parameter "x": float32 in arm/Move, and its hint says str'),
        (wrong_list, 'the parameter "steps": int32\\[\\] in arm/Move, and its hint says int'),
        (missing, 'missing has no parameter "steps", and arm/Move has that field'),
        (wrong_result, "wrong_result returns str, and arm/Move answers with done, why"),
        (wrong_results, "done of arm/Move is bool, and what it returns is str"),
    ],
)
def test_hints_that_do_not_fit(func: Any, why: str) -> None:
    types = types_()
    types.add("arm/Move", "float32 x\nint32[] steps\n---\nbool done\nstring why\n")
    with pytest.raises(TypeError, match=why):
        service(func, "/move~arm/Move", types)


def test_methods_that_are_no_service() -> None:
    def many(*words: str) -> None: ...

    def named(maxSpeed: float) -> None: ...  # noqa: N803  that is the matter

    with pytest.raises(TypeError, match='the parameter "words": a service has a fixed number'):
        service(many)
    with pytest.raises(TypeError, match='the parameter "maxSpeed": no name of a field'):
        service(named)


def test_what_is_asked_wrongly_is_answered() -> None:
    def use(rest: dict) -> int: ...

    found = service(use)
    for text in ("{", '{"__wrapyfi__": ["numpy.ndarray", "AAAA"]}', "[" * 5000):
        told = handled(found, found.kind.Request(rest=text), lambda *_: Item(1))
        assert str(told[0]) == "fail" and "DecodeError" in told[1]


def test_failures() -> None:
    def fail(n: int) -> int:
        raise AssertionError

    found = service(fail)
    told = handled(found, found.kind.Request(n=1), lambda *_: Failure("ValueError", "a: b"))
    error = error_of(told[1])
    assert (error.type, error.text) == ("ValueError", "a: b")
    assert error_of("it is dark").type == "" and error_of("it is dark").text == "it is dark"
    assert topic_and_type("/a~b/srv/C") == ("/a", "b/C") and topic_and_type("/a") == ("/a", "")
