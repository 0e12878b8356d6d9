"""dash_action: what is done by hand is done, and can be undone."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from support.system import NO_MARKS
from support.wait import wait_until

import yarpy
from yarpy.kits.views.dash_action import KEPT, Actions
from yarpy.network import qos


@pytest.fixture
def names() -> yarpy.LocalNames:
    return yarpy.LocalNames()


@pytest.fixture
def out(names: yarpy.LocalNames) -> Iterator[yarpy.Port]:
    with yarpy.Port("/out", names=names) as port, yarpy.BufferedPort("/in", names=names):
        yield port


def carriers(port: yarpy.Port) -> list[str]:
    return [str(link.carrier) for link in port.outputs]


def test_connecting_and_back(names: yarpy.LocalNames, out: yarpy.Port) -> None:
    actions = Actions(names)
    assert actions.undo_text == ""
    assert actions.act(["connect", "/out", "/in", "fast_tcp"]) == (
        "connected /out → /in over fast_tcp"
    )
    assert carriers(out) == ["fast_tcp"]
    assert actions.undo_text == "disconnect /out → /in"
    assert actions.act(["undo"]) == "undone: disconnect /out → /in"
    wait_until(lambda: not out.outputs)
    with pytest.raises(yarpy.YarpError, match="nothing to undo"):
        actions.act(["undo"])


def test_connecting_what_is_connected_is_another_carrier(
    names: yarpy.LocalNames, out: yarpy.Port
) -> None:
    actions = Actions(names)
    out.connect("/in", "tcp")
    actions.act(["connect", "/out", "/in", "fast_tcp"])
    assert carriers(out) == ["fast_tcp"]
    actions.act(["undo"])
    assert carriers(out) == ["tcp"]


def test_disconnecting_and_back(names: yarpy.LocalNames, out: yarpy.Port) -> None:
    actions = Actions(names)
    out.connect("/in", "fast_tcp")
    actions.act(["disconnect", "/out", "/in"])
    assert not out.outputs
    actions.act(["undo"])
    assert carriers(out) == ["fast_tcp"]


def test_another_carrier_and_back(names: yarpy.LocalNames, out: yarpy.Port) -> None:
    actions = Actions(names)
    out.connect("/in", "tcp")
    actions.act(["carrier", "/out", "/in", "fast_tcp"])
    assert carriers(out) == ["fast_tcp"]
    actions.act(["undo"])
    assert carriers(out) == ["tcp"]


def test_a_carrier_that_does_not_work_changes_nothing(
    names: yarpy.LocalNames, out: yarpy.Port
) -> None:
    actions = Actions(names)
    out.connect("/in", "tcp")
    with pytest.raises(yarpy.YarpError):
        actions.act(["carrier", "/out", "/in", "pigeon"])
    assert carriers(out) == ["tcp"]
    assert actions.undo_text == ""


@pytest.mark.skipif(bool(NO_MARKS), reason=NO_MARKS)
def test_a_priority_and_back(names: yarpy.LocalNames, out: yarpy.Port) -> None:
    actions = Actions(names)
    out.connect("/in", "tcp")
    actions.act(["priority", "/out", "/in", "", "HIGH"])
    assert out.outputs[0].qos.packets == "AF42"
    actions.act(["undo"])
    assert out.outputs[0].qos.packets == "CS0"


def test_a_deadline_and_back(names: yarpy.LocalNames, out: yarpy.Port) -> None:
    actions = Actions(names)
    out.connect("/in", "tcp")
    assert actions.act(["deadline", "/out", "/in", "20"]) == ("/out → /in has a deadline of 20 ms")
    assert qos.granted("/out", "/in", names)[1].deadline == 0.02
    actions.act(["undo"])
    assert not qos.granted("/out", "/in", names)[1].deadline


@pytest.mark.parametrize(
    "words",
    [
        [],
        ["dance"],
        ["connect", "/out"],
        ["connect", "/out", "/nobody", ""],
        ["connect", "/o ut", "/in", ""],
        ["disconnect", "/out", "/in"],
        ["priority", "/out", "/in", "", ""],
        ["priority", "/out", "/in", "100", ""],
        ["priority", "/out", "/in", "many", ""],
        ["priority", "/out", "/in", "", "URGENT"],
        ["deadline", "/out", "/in", "soon"],
        ["deadline", "/out", "/in", "-1"],
    ],
)
def test_what_cannot_be_done_says_so(
    names: yarpy.LocalNames, out: yarpy.Port, words: list[object]
) -> None:
    actions = Actions(names)
    with pytest.raises((yarpy.YarpError, ValueError)) as error:
        actions.act(words)
    assert str(error.value)
    assert actions.undo_text == ""


@pytest.mark.skipif(bool(NO_MARKS), reason=NO_MARKS)
@pytest.mark.parametrize(
    "act", [["carrier", "/out", "/in", "fast_tcp"], ["disconnect", "/out", "/in"]]
)
def test_priority_and_deadline_outlive_what_makes_a_connection_anew(
    act: list[object], names: yarpy.LocalNames, out: yarpy.Port
) -> None:
    actions = Actions(names)
    out.connect("/in", "tcp")
    actions.act(["priority", "/out", "/in", "", "HIGH"])
    actions.act(["deadline", "/out", "/in", "20"])
    actions.act(act)
    if act[0] == "carrier":
        sender, receiver = qos.granted("/out", "/in", names)
        assert (sender.packets, receiver.packets, receiver.deadline) == ("AF42", "AF42", 0.02)
    actions.act(["undo"])
    assert carriers(out) == ["tcp"]
    sender, receiver = qos.granted("/out", "/in", names)
    assert (sender.packets, receiver.packets, receiver.deadline) == ("AF42", "AF42", 0.02)


def test_only_so_much_is_remembered(names: yarpy.LocalNames, out: yarpy.Port) -> None:
    actions = Actions(names)
    for _ in range(KEPT):
        actions._remember("nothing", lambda: None)
    actions.act(["connect", "/out", "/in", ""])
    assert len(actions._undo) == KEPT
    assert actions.undo_text == "disconnect /out → /in"
