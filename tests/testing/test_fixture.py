"""The pytest fixtures: imported by name, they give each test names of its own."""

from __future__ import annotations

from yarpy.names.default import DEFAULT
from yarpy.nameserver.local import LocalNames
from yarpy.nameserver.server import NameServer
from yarpy.network import query
from yarpy.port.port import Port
from yarpy.testing.fixture import name_server, names

__all__ = ["name_server", "names"]


def test_names(names: LocalNames) -> None:
    assert DEFAULT.current() is names
    with Port("/same"):
        assert [contact.name for contact in names.list()] == ["/same"]


def test_names_of_another_test(names: LocalNames) -> None:
    assert list(names.list()) == []


def test_name_server(name_server: NameServer) -> None:
    assert DEFAULT.current() is name_server.client
    with Port("/same"):
        assert query("/same") is not None
