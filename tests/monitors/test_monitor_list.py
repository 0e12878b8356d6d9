"""Series: the numbered parameters of C++ YARP 4, and messages that pass one after the other."""

from __future__ import annotations

import pytest

from yarpy.data.bottle import Bottle, Property
from yarpy.monitors.base import DROP, Place
from yarpy.monitors.monitor_list import Series, places
from yarpy.route import parse_carrier
from yarpy.wire.message import DATA, Message


def place(tokens: str) -> Place:
    parts = parse_carrier(f"x+{tokens}").tokens
    return Place("/a", "/b", "", False, parts, parts)


@pytest.mark.parametrize(
    ("tokens", "files"),
    [
        ("file.a+type.dll", ["a dll"]),
        ("file.a+period_ms.5+type.dll+file1.b+type1.lua", ["a dll", "b lua"]),
        ("file1.b+type1.dll+file.a+type.dll", ["a dll", "b dll"]),
        ("file.a+file1.b+file2.c+type2.lua", ["a ", "b ", "c lua"]),
        ("file.a+file2.c", ["a "]),
    ],
)
def test_places(tokens: str, files: list[str]) -> None:
    assert [f"{one.text('file')} {one.text('type')}" for one in places(place(tokens))] == files


def test_other_parameters_are_everybodys_and_numbered_ones_are_not() -> None:
    first, second = places(place("file.a+context.x+delay_ms.7+file1.b+constraint1.e"))
    assert (first.text("delay_ms"), second.text("delay_ms")) == ("7", "7")
    assert (first.text("context"), second.text("context")) == ("x", "")
    assert (first.text("constraint"), second.text("constraint")) == ("", "e")


class Word:
    def __init__(self, word: str) -> None:
        self.word, self.rung, self.closed = word, 0, False

    def accept(self, message: Message) -> bool:
        return bool(message.value[0] != f"no {self.word}")

    def update(self, message: Message) -> object:
        return [*message.value, self.word]

    update_reply = update

    def trigger(self) -> None:
        self.rung += 1

    def configure(self, parameters: Property) -> None:
        self.word = parameters.get(self.word, self.word)

    def parameters(self) -> dict[str, object]:
        return {self.word: self.rung}

    state = parameters

    def close(self) -> None:
        self.closed = True


def test_one_after_the_other() -> None:
    words: list[object] = [Word("a"), object(), Word("b")]
    series = Series(words, place(""))

    def update(value: str) -> object:
        made = series.update(Message(DATA, Bottle([value]).to_bytes()))
        return made.value if isinstance(made, Message) else made

    assert update("hi") == ["hi", "a", "b"]
    assert [update("no a"), update("no b")] == [DROP, DROP]
    reply = series.update_reply(Message(DATA, Bottle(["yes"]).to_bytes()))
    assert isinstance(reply, Message)
    assert reply.value == ["yes", "a", "b"]
    series.trigger()
    assert series.parameters() == {"a": 1, "b": 1}
    assert series.state() == {"a": 1, "b": 1}
    series.configure(Property(a="c"))
    assert update("hi") == ["hi", "c", "b"]
    series.close()
    assert all(one.closed for one in words if isinstance(one, Word))
