"""What commands of a name server need, and what it answers to who may not give them."""

from __future__ import annotations

import json
import urllib.error
import urllib.request
from collections.abc import Iterator
from pathlib import Path

import pytest
from support.access import allow

import yarpy
from yarpy.data.bottle import Bottle
from yarpy.nameserver.command import READING, NameService
from yarpy.nameserver.right import needed
from yarpy.nameserver.store import NameStore
from yarpy.nameserver.topology import Topology


@pytest.mark.parametrize(
    ("command", "expected"),
    [
        ("query /a", []),
        ("list", []),
        ("NAME_SERVER list", []),
        ("bot list /a", []),
        ("get /a ips", []),
        ("nonsense /a", []),
        ("", []),
        ("register /a", [("register", "/a")]),
        ("bot register /a tcp 127.0.0.1 5", [("register", "/a")]),
        ("NAME_SERVER bot register /a", [("register", "/a")]),
        ("register", [("register", "...")]),
        ("register ...", [("register", "...")]),
        ("register =x", [("register", "...")]),
        ("register 5", [("register", "...")]),
        ("unregister /a", [("register", "/a")]),
        ("announce /a", [("register", "/a")]),
        ("announce /a 0", []),
        ("announce /a 1", [("register", "/a")]),
        ("set /a ips 1 2", [("register", "/a")]),
        ("set /a owns /b /c", [("register", "/a"), ("register", "/b"), ("register", "/c")]),
        ("subscribe /a", []),
        ("subscribe /a /b", [("administer", "")]),
        ("unsubscribe /a /b", [("administer", "")]),
        ("topic", []),
        ("topic /a", [("administer", "")]),
        ("untopic /a", [("administer", "")]),
        ("type yarp /a", []),
        ("type yarp /a x", [("administer", "")]),
        ("gc", [("administer", "")]),
        ("register /a (format json)", [("register", "/a")]),
    ],
)
def test_commands(command: str, expected: list[tuple[str, str]]) -> None:
    assert needed(Bottle.from_text(command)) == expected


def test_every_command_asks_or_needs_a_right() -> None:
    """A command that is new has to be thought of here."""
    known = {*READING, "register", "unregister", "set", "announce", "subscribe", "unsubscribe"}
    known |= {"topic", "untopic", "type", "gc", "NAME_SERVER", "bot"}
    assert NameService(NameStore(), Topology(lambda: 0.0)).verbs == known


@pytest.fixture
def server(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[yarpy.NameServer]:
    """A server where this computer may register names below /guest alone."""
    allow(tmp_path, monkeypatch, "register read", ports="/guest/*")
    with yarpy.NameServer() as server:
        yield server


def test_names_that_may_be_registered(server: yarpy.NameServer) -> None:
    client = server.client
    assert client.register("/guest/a", "tcp", "127.0.0.1", 5).port == 5
    assert client.set("/guest/a", "note", "x") == ["x"]
    client.unregister("/guest/a")
    for name in ("/arm", "..."):
        with pytest.raises(yarpy.AddressError, match=f'"{name}" is not registered.*Access refused'):
            client.register(name, "tcp", "127.0.0.1", 5)
    for change in (
        lambda: client.unregister("/root"),
        lambda: client.set("/root", "ips", "10.0.0.1"),
        lambda: client.set("/guest/a", "owns", "/root"),
        lambda: client.announce("/root"),
        lambda: client.request(["subscribe", "/a", "/b"]),
        lambda: client.command("gc"),
    ):
        with pytest.raises(yarpy.AccessRefused, match="Access refused: this computer may not"):
            change()
    assert client.query("/root") is not None
    assert [contact.name for contact in client.list()] == ["/root", "fallback"]
    client.announce("/root", False)  # a complaint, which is looked into
    with pytest.raises(yarpy.AddressError, match="Access refused"):
        yarpy.Port("/arm")
    with yarpy.Port("/guest/b") as port:
        assert client.query("/guest/b") is not None
        assert port.name == "/guest/b"
    assert client.query("/guest/b") is None


def test_browsers_get_403(server: yarpy.NameServer) -> None:
    def status(question: str) -> tuple[int, str]:
        try:
            with urllib.request.urlopen(f"http://{server.address}/?req={question}") as answer:
                return answer.status, answer.read().decode()
        except urllib.error.HTTPError as error:
            with error:
                return error.code, error.read().decode()

    assert status("register+/arm")[0] == 403
    assert "Access refused" in status("unregister+/root")[1]
    code, text = status("query+/root")
    assert (code, json.loads(text)["name"]) == (200, "/root")


def test_strangers_are_told_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    allow(tmp_path, monkeypatch, "register read", who="192.0.2.1")
    with yarpy.NameServer() as server:
        for question in (
            lambda: server.client.query("/root"),
            lambda: server.client.list(),
            lambda: server.client.get("/root", "ips"),
        ):
            with pytest.raises(yarpy.AccessRefused, match="Access refused"):
                question()
