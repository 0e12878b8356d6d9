"""The page of an application: what it tells, and what it does."""

import json
from collections.abc import Iterator
from typing import Any

import pytest

import yarpy
from yarpy.kits.launch.application.application import Module
from yarpy.kits.launch.page.owner import Owners
from yarpy.kits.launch.page.page import MOST, ApplicationPage

LINK = {"from": "/a", "to": "/b", "state": "connected"}


class Served:
    """A page over answers of this test."""

    def __init__(self, port: yarpy.Port) -> None:
        self.asked: list[dict[str, Any]] = []
        owners = Owners(dict, lambda name: 0)
        modules = [Module("talker", "talk", "/a"), Module("other", "o")]
        ApplicationPage(port, self._answer, owners, lambda: modules)
        self._site = port._program.on_page
        self._admin = port._program.on_admin

    def _answer(self, asked: dict[str, Any]) -> dict[str, Any]:
        self.asked.append(asked)
        if asked.get("name") == "nobody":
            raise yarpy.UnknownName("no program is called so")
        if asked["do"] == "status":
            return {"application": "demo", "programs": [], "connections": [LINK]}
        return {"lines": [[1, "talker", "hello"]]} if asked["do"] == "logs" else {"ok": True}

    def get(self, path: str, **fields: str) -> Any:
        page = self._site(path, fields)
        return json.loads(page.body) if page.kind == "application/json" else page.body

    def act(self, *words: str) -> list[Any]:
        class Message:
            def as_(self, kind: object) -> yarpy.Bottle:
                return yarpy.Bottle([*words])

        return self._admin(Message())


@pytest.fixture
def served(network: yarpy.LocalNames) -> Iterator[Served]:
    with yarpy.Port("/up/demo", names=network) as port:
        yield Served(port)


def test_files_are_there_and_load_nothing_from_elsewhere(served: Served) -> None:
    for path in ("/", "/up.js", "/up.css", "/up_list.js", "/dash_graph.js", "/dash_layout.js"):
        text = served.get(path)
        assert len(text) > 100 and "//" not in text.replace("https://", "//")[:0]
    assert "default-src 'none'" in served.get("/")


def test_the_application_and_whose_its_ports_are(served: Served) -> None:
    told = served.get("/application")
    assert told["application"] == "demo"
    assert told["ports"] == [["/a", "talker"], ["/b", ""]]


def test_lines(served: Served) -> None:
    assert served.get("/lines", name="talker", since="7", most="9999999")["lines"]
    assert served.asked[-1] == {"do": "logs", "name": "talker", "since": 7, "most": MOST}
    assert served.get("/lines", name="nobody", since="-1", most="x")["error"]
    assert served.asked[-1]["since"] == served.asked[-1]["most"] == 0


@pytest.mark.parametrize(
    ("words", "asked"),
    [
        (("start", "talker"), {"do": "start", "name": "talker"}),
        (("stop", "talker"), {"do": "stop", "name": "talker"}),
        (("restart", "talker"), {"do": "restart", "name": "talker"}),
        (("connect", "/a", "/b"), {"do": "connect", "from": "/a", "to": "/b"}),
        (("disconnect", "/a", "/b"), {"do": "disconnect", "from": "/a", "to": "/b"}),
        (("down",), {"do": "down"}),
    ],
)
def test_what_it_does(served: Served, words: tuple[str, ...], asked: dict[str, str]) -> None:
    assert served.act("up", *words) == [yarpy.Vocab("ok")]
    assert served.asked == [asked]


def test_what_it_does_not_do(served: Served) -> None:
    assert served.act("other", "down") is None
    assert served.act() is None
    for words in (("dance", "x"), ("start",), ("start", "a", "b"), ("kill", "a")):
        assert served.act("up", *words)[0] == yarpy.Vocab("fail")
    assert served.asked == []
    assert served.act("up", "start", "nobody")[1] == "no program is called so"
