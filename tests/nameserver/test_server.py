"""NameServer as a program has it in hand: used, closed, dropped."""

from __future__ import annotations

import gc

import pytest
from support.wait import HANG, wait_until

import yarpy
from yarpy.nameserver.server import NameServer
from yarpy.transports.tcp import is_taken


def test_what_it_tells() -> None:
    told: list[str] = []
    with NameServer() as server:
        server.on_command = lambda command, host: told.append(command)
        assert server.client.query("/root") is not None
        assert (server.name, server.host) == ("/root", "127.0.0.1")
        assert server.address == f"{server.host}:{server.port}"
        assert server.environment == {"YARPY_SERVER": server.address}
        assert server.hub.name == "/root"
        assert server.delegates == []
        assert server.service.store.query("/root") is not None
        assert repr(server) == f"<NameServer /root at {server.address}>"
    assert told == ['query "/root"']


def test_one_that_is_dropped_is_closed_with_a_warning() -> None:
    server = NameServer()
    client, number = server.client, server.port
    with pytest.warns(ResourceWarning, match="was dropped without being closed: call close"):
        del server
        gc.collect()
    wait_until(lambda: not is_taken(number), HANG, "it listens still")
    with pytest.raises(yarpy.NoNameServer):
        client.query("/root")


def test_one_that_is_used_without_its_handle_is_kept() -> None:
    """Its own `with` has it."""
    with NameServer() as server:
        client = server.client
        del server
        gc.collect()
        assert client.query("/root") is not None
