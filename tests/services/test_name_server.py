"""NameServer: who comes too early, numbers that are taken."""

from __future__ import annotations

import socket
import threading
import time

import pytest
from support.port import free_block

import yarpy
from yarpy.services.name_server import NameServer


def test_who_comes_before_it_is_open_waits(monkeypatch: pytest.MonkeyPatch) -> None:
    """Clients of a restarted server knock until it listens, which is before it knows anything."""
    number = free_block(10)
    listens = threading.Event()
    register = NameServer._register_self

    def slowly(server: NameServer) -> None:
        listens.set()
        time.sleep(0.2)
        register(server)

    monkeypatch.setattr(NameServer, "_register_self", slowly)
    servers: list[NameServer] = []
    starting = threading.Thread(target=lambda: servers.append(NameServer(number)))
    starting.start()
    try:
        assert listens.wait(5)
        with socket.create_connection(("127.0.0.1", number), 5) as client:
            client.sendall(b"NAME_SERVER query /root\n")
            assert client.recv(1000).startswith(b"registration name /root ip 127.0.0.1 port ")
    finally:
        starting.join(5)
        servers[0].close()


def test_numbers_that_strangers_have_are_not_lent() -> None:
    """Ports that outlived an earlier server still listen; C++ ports do not register again."""
    number = free_block(10)
    with socket.socket() as stranger:
        stranger.bind(("", number + 2))
        stranger.listen()
        with NameServer(number), yarpy.Port("/new") as port:
            assert port.contact.port == number + 3
