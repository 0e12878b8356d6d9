"""The server that commands talk to."""

import pytest

import yarpy
from yarpy.cli.service import server as chosen
from yarpy.names.default import DEFAULT


def test_the_first_of_several(server, monkeypatch):
    monkeypatch.setenv("YARPY_SERVER", f"{server.address},127.0.0.1:1")
    assert (chosen().host, chosen().port) == (server.host, server.port)


def test_names_without_a_server():
    local = yarpy.LocalNames()
    DEFAULT.push(local)
    try:
        with pytest.raises(yarpy.LocalProtocolError, match="yarpy server"):
            chosen()
    finally:
        DEFAULT.pop(local)
