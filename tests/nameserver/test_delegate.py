"""Delegates: what a name server tells other systems of its ports, and asks them."""

import pytest
from support.guest import is_here
from support.wait import wait_until

import yarpy
from yarpy import registry
from yarpy.contact import Contact
from yarpy.nameserver.delegate import DelegateContext
from yarpy.shipped import SHIPPED


class Listener:
    """A delegate that remembers what it was told, and knows one name."""

    about = "somebody who listens"

    def __init__(self, place: str, context: DelegateContext) -> None:
        self.place = place
        self.context = context
        self.told: list[tuple[str, str]] = []
        self.closed = False

    def registered(self, name: str) -> None:
        self.told.append(("registered", name))

    def announced(self, name: str) -> None:
        self.told.append(("announced", name))

    def unregistered(self, name: str) -> None:
        self.told.append(("unregistered", name))

    def query(self, name: str) -> Contact | None:
        return Contact("tcp", name, "127.0.0.1", 4711) if name == "/elsewhere" else None

    def close(self) -> None:
        self.closed = True


@pytest.fixture
def plugged(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(registry.delegates._loaded, "listener", Listener)


def test_a_plug_in_hears_of_ports_and_is_asked(plugged: None) -> None:
    with yarpy.NameServer(beside={"listener": "over there"}) as server:
        (delegate,) = server.delegates
        assert isinstance(delegate, Listener)
        assert delegate.place == "over there" and delegate.context.name == "/root"
        with yarpy.Port("/p"):
            assert ("registered", "/p") in delegate.told
            wait_until(lambda: ("announced", "/p") in delegate.told)  # told behind the answer
        wait_until(lambda: delegate.told[-1] == ("unregistered", "/p"))
        found = server.client.query("/elsewhere")
        assert found is not None and found.port == 4711
        assert server.client.query("/nowhere") is None
    assert delegate.closed


def test_unknown_systems_are_refused() -> None:
    with pytest.raises(yarpy.UnknownPlugin, match="klingon"):
        yarpy.NameServer(beside={"klingon": ""})


def test_shipped_delegates_have_every_member() -> None:
    members = ("registered", "announced", "unregistered", "query", "close")
    for name, row in SHIPPED["delegates"].items():
        if not is_here(row):
            continue
        opened = registry.delegates.load(name)
        kind = opened.__annotations__["return"]
        found = getattr(__import__(opened.__module__, fromlist=[kind]), kind)
        assert [member for member in members if not hasattr(found, member)] == []
