"""Which scripts may run: the words of the setting, what the network may name."""

from __future__ import annotations

from pathlib import Path

import pytest

from yarpy.errors import LocalProtocolError
from yarpy.monitors.base import Place
from yarpy.monitors.script.permission import granted, look_for


def place(foreign: bool) -> Place:
    def look(name, contexts):  # type: ignore[no-untyped-def]
        yield Path(name)
        for context in contexts:
            yield Path("/base/contexts") / context / name
            yield Path("/base") / name

    return Place("/out", "/in", look=look, foreign=foreign)


@pytest.mark.parametrize(
    ("text", "found"),
    [("", ()), ("network", ("network",)), ("system, network", ("network", "system"))],
)
def test_words(monkeypatch: pytest.MonkeyPatch, text: str, found: tuple[str, ...]) -> None:
    monkeypatch.setenv("YARPY_SCRIPTS", text)
    assert tuple(word for word in ("network", "system") if granted(word)) == found


def test_program_looks_everywhere(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("YARPY_SCRIPTS", raising=False)
    assert next(look_for(place(False), "/a/../b.py", "app")) == Path("/a/../b.py")


def test_network_looks_into_contexts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("YARPY_SCRIPTS", "network")
    assert [*look_for(place(True), "b.py", "app")] == [Path("/base/contexts/app/b.py")]
    for file, context in (("../b", "app"), ("b", "a/b"), ("b", ""), ("b", ".."), ("a\\b", "app")):
        with pytest.raises(LocalProtocolError, match="not a path"):
            look_for(place(True), file, context)
    monkeypatch.delenv("YARPY_SCRIPTS")
    with pytest.raises(LocalProtocolError, match="YARPY_SCRIPTS=network"):
        look_for(place(True), "b.py", "app")


@pytest.mark.parametrize(
    ("argv", "command"),
    [
        (["/home/lab/robot.py", "--secret"], "YARPY_SCRIPTS=network python robot.py ..."),
        (["/usr/bin/yarpy", "server"], "YARPY_SCRIPTS=network yarpy ..."),
        (["-c"], "YARPY_SCRIPTS=network PROGRAM ..."),
        ([], "YARPY_SCRIPTS=network PROGRAM ..."),
    ],
)
def test_the_refusal_names_what_the_owner_types(
    argv: list[str], command: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("YARPY_SCRIPTS", raising=False)
    monkeypatch.setattr("sys.argv", argv)
    with pytest.raises(LocalProtocolError) as caught:
        look_for(Place("/a", "/b", foreign=True), "x.lua", "demo")
    assert f"`{command}`" in str(caught.value)
