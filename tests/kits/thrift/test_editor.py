"""Editors: the messages that C++ writes, those that people type, and what a wrong one changes."""

from typing import Any

import pytest
from support.thrift import reply

from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.errors import RemoteProtocolError, Timeout
from yarpy.kits.thrift.editor import RemoteEditor
from yarpy.kits.thrift.library import loads
from yarpy.wire.message import CALL, Message

MADE = loads(
    "struct Point { 1: i32 x, 2: i32 y }\n"
    "struct Settings { 1: i32 id, 2: string name, 3: Point pt, 4: list<i32> ints, 5: double from }"
    ' (yarp.editor = "true")',
    "settings",
)


def test_messages_are_those_of_cpp() -> None:
    assert MADE.Settings.Editor.patch(id=5).hex() == (
        "0001000002000000" "04000000050000007061746368" "0001000003000000" "0400000003000000736574"
        "04000000020000006964" "0100000005000000"
    )  # fmt: skip
    group = MADE.Settings.Editor.patch(name="x", ints=[1, 2], pt=MADE.Point(1, 2), id=6)
    assert Bottle.from_bytes(group).to_text() == (
        "patch (set id 6) (set name x) (set pt (1 2)) (set ints (1 2))"
    )


@pytest.mark.parametrize(
    "line",
    [
        "patch (set id 6) (set name x) (set pt (1 2)) (set ints (1 2)) (set from 1)",
        "set id 6 name x pt (1 2) ints (1 2) from 1.0",
        "[set] id 6 [name] x pt (1 2) ints (1 2) from 1.0",
        "foo ints (1 2) id 6 name x pt (1 2) from 1.0",
    ],
)
def test_fields_are_set(line: str) -> None:
    editor = MADE.Settings.Editor()
    assert reply(editor, line) == "[ok]"
    value = editor.value
    assert (value.id, value.name, value.pt, value.ints.tolist()) == (
        6,
        "x",
        MADE.Point(1, 2),
        [1, 2],
    )
    assert value.from_ == 1.0
    assert reply(editor, Bottle.from_text(line).to_bytes()) == bytes.fromhex(
        "0001000001000000090000006f6b0000"
    )


@pytest.mark.parametrize(
    ("line", "error"),
    [
        ("patch (set id 6) (set id x)", "Settings.id: expected an integer (i32), got 'x'"),
        ("patch (set id 6) (set size 1)", "Settings has no field 'size'; it has id, name, pt"),
        ("patch (set id)", "lists of three"),
        ("patch id 6", "lists of three"),
        ("set id 6 name", "Settings.name is missing"),
        ("set id 6 pt 1 2", "Settings.pt: expected a list for Point, got 1"),
        ("set id 6 pt (1 2 3)", "Point has 2 elements, here are 3"),
        ("5 id 6", "the first word: expected a string, got 5"),
    ],
)
def test_what_is_wrong_changes_nothing(line: str, error: str) -> None:
    editor = MADE.Settings.Editor()
    answer = reply(editor, line)
    assert answer.startswith("[fail]") and error in answer.replace('\\"', '"')
    assert editor.value == MADE.Settings()


def test_help() -> None:
    editor = MADE.Settings.Editor()
    assert reply(editor, "help") == '[many] ("*** Available fields:" id name pt ints from)'
    assert reply(editor, "help ints") == '[many] ("list<i32> ints")'
    assert reply(editor, "help size") == '[many] ("Field not found")'
    assert "send `help`" in reply(editor, "")


def test_hooks_are_called_around() -> None:
    seen: list[Any] = []

    class Watched(MADE.Settings.Editor):  # type: ignore[misc, name-defined]
        def will_set_id(self, value: int) -> None:
            seen.append(("will", self.value.id, value))

        def did_set_id(self, value: int) -> None:
            seen.append(("did", self.value.id, value))

    value = MADE.Settings(id=1)
    reply(Watched(value), "set id 2")
    assert seen == [("will", 1, 2), ("did", 2, 2)] and value.id == 2


class Port:
    def __init__(self, *answers: Any) -> None:
        self.answers = [*answers]
        self.asked: list[Any] = []

    def ask(self, question: Any, timeout: float | None) -> Message:
        self.asked.append(Bottle.from_bytes(question.data).to_text())
        answer = self.answers.pop(0)
        if isinstance(answer, Exception):
            raise answer
        return Message(CALL, Bottle(answer).to_bytes())

    def close(self) -> None:
        self.asked.append("closed")


def test_remote_editors() -> None:
    port = Port([Vocab("ok")], [Vocab("fail"), "no"], [Vocab("fail")], Timeout("late"))
    with RemoteEditor(MADE.Settings.Editor, port, 1.0) as editor:
        editor.set(from_=2.5)
        with pytest.raises(RemoteProtocolError, match="refuses to set id: no"):
            editor.set(id=1)
        with pytest.raises(RemoteProtocolError, match=r"refuses to set id, name$"):
            editor.set(id=1, name="x")
        with pytest.raises(Timeout, match=r"set id: no answer within 1\.0 s"):
            editor.set(id=1)
        with pytest.raises(TypeError, match=r"Settings\.pt: expected a Point, got a list"):
            editor.set(pt=[1, 2])
        with pytest.raises(TypeError, match="Settings has no field 'size'"):
            editor.set(size=1)
    assert port.asked[0] == "patch (set from 2.5)" and port.asked[-1] == "closed"
