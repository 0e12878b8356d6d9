"""Places and their parameters, and groups."""

from __future__ import annotations

import pytest

from yarpy.data.bottle import Bottle
from yarpy.errors import LocalProtocolError
from yarpy.monitors.base import Group, Place, read_token
from yarpy.route import parse_carrier


def place(own: str = "", shared: str = "") -> Place:
    return Place("/a", "/b", "", False, parse_carrier(own).tokens, parse_carrier(shared).tokens)


@pytest.mark.parametrize(
    ("token", "key", "value"),
    [
        ("tc.2", "tc", "2"),
        ("file.my.lua", "file", "my.lua"),
        ("virtual", "virtual", ""),
        ("(ex (/a -10))", "ex", Bottle([Bottle(["/a", -10])])),
        ("((ex (/a -10)))", "ex", Bottle([Bottle(["/a", -10])])),
        ("()", "", Bottle()),
    ],
)
def test_token(token: str, key: str, value: object) -> None:
    assert read_token(token) == (key, value)


def test_own_parameters_come_before_shared_ones_and_the_last_counts() -> None:
    here = place("x+file.a+file.b", "x+file.c+type.dll+word")
    assert here.text("file") == "b"
    assert here.text("type") == "dll"
    assert here.text("none", "default") == "default"
    assert here.flag("word")
    assert not here.flag("none")
    assert not place("x+word.0").flag("word")


@pytest.mark.parametrize("text", ["x+n.many", "x+n", "x+n.11", "x+n.-1", "x+n.nan", "x+(n 1 2)"])
def test_number_says_what_it_takes(text: str) -> None:
    with pytest.raises(LocalProtocolError, match='"n" takes a number from 0 to 10'):
        place(text).number("n", 1, 0, 10)


def test_number() -> None:
    assert place("x+n.2.5").number("n", 1, 0, 10) == 2.5
    assert place("x").number("n", 7) == 7


class Bell:
    def __init__(self) -> None:
        self.rung = 0

    def trigger(self) -> None:
        self.rung += 1


def test_group_triggers_the_others_only() -> None:
    group, bells = Group(), [Bell(), Bell(), Bell()]
    for bell in bells:
        group.add(bell)
    group.add(object())  # one without a trigger
    group.trigger(bells[0])
    group.remove(bells[1])
    group.trigger(bells[2])
    assert [bell.rung for bell in bells] == [1, 1, 1]
