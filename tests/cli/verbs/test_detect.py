"""`yarpy detect`."""

from pathlib import Path

import pytest
from support.port import free_port

from yarpy.names.discovery import Responder


def test_the_configured_server(cli, server):
    said = cli.run("detect")
    assert said.returncode == 0
    assert f"Checking for name server at ip 127.0.0.1 port {server.port}\n" in said.stdout
    assert f"== FOUND\n== /root is available at ip 127.0.0.1 port {server.port}\n" in said.stdout


@pytest.fixture
def found(server, here, monkeypatch):
    """A server that is found by multicast only."""
    port = free_port()
    monkeypatch.delenv("YARPY_SERVER")
    monkeypatch.setenv("YARP_PORT_RANGE", str(port))
    responder = Responder(server.service.answer_multicast, port)
    try:
        responder.start()
    except OSError as error:
        pytest.skip(f"no multicast on this computer: {error}")
    yield server
    responder.close()


def test_by_multicast(found, here, tmp_path):
    said = here("detect")
    assert said.code == 0
    assert f"/root is available at ip 127.0.0.1 port {found.port}" in said.out
    assert "yarpy detect --write" in said.out
    assert not (tmp_path / "config").exists()

    said = here("detect", "--write")
    assert said.code == 0 and "== Address saved.\n" in said.out
    path = Path(tmp_path, "config/yarp.conf")
    assert path.read_text() == f"127.0.0.1 {found.port} yarp\n"
    assert here("where").code == 0


def test_nobody(lone):
    said = lone.run("detect")
    assert said.returncode == 1
    assert "try 3 of max 3\n" in said.stdout
    assert "== PROBLEM\n== No valid YARP name server was found.\n" in said.stdout


def test_no_multicast(here, monkeypatch):
    def refuse(*args, **options):
        raise OSError(19, "No such device")

    monkeypatch.delenv("YARPY_SERVER")
    monkeypatch.setattr("yarpy.names.discovery.search", refuse)
    said = here("detect")
    assert said.code == 1 and "== PROBLEM\n" in said.out
    assert said.err == "error: this computer has no multicast: No such device\n"
