"""`yarpy detect`."""

import socket
from pathlib import Path

import pytest
from support.multicast import needs_multicast
from support.port import free_port
from support.ros_graph import ros_graph
from support.wait import HANG

import yarpy
from yarpy.names import client
from yarpy.names.discovery import Responder


def test_the_configured_server(cli, server):
    said = cli.run("detect")
    assert said.returncode == 0
    assert f"Checking for name server at ip 127.0.0.1 port {server.port}\n" in said.stdout
    assert f"== FOUND\n== /root is available at ip 127.0.0.1 port {server.port}\n" in said.stdout


def test_what_listens_there_is_no_name_server_that_answers(here, names, monkeypatch):
    """Such as one that was stopped: it takes connections all the same."""
    monkeypatch.setattr(client.YarpNameClient.__init__, "__defaults__", (0.3,))  # seconds
    monkeypatch.setattr("yarpy.names.discovery.search", lambda *_, **__: None)
    with (
        socket.create_server(("127.0.0.1", 0)) as stopped,
        yarpy.BufferedPort("/detect/port", names=names) as port,
    ):
        for address, seconds, what in (
            (f"127.0.0.1:{stopped.getsockname()[1]}", 0.3, "a name server that was stopped (`fg`"),
            (port.address, HANG, "is an ordinary port"),
        ):
            monkeypatch.setattr("yarpy.names.client.WHO", seconds)
            monkeypatch.setenv("YARPY_SERVER", address)
            said = here("detect")
            assert said.code == 1 and "FOUND" not in said.out
            assert f"what listens at {address} " in said.err and what in said.err


@pytest.fixture
def found(server, here, monkeypatch):
    """A server that is found by multicast only."""
    needs_multicast()
    port = free_port()
    monkeypatch.delenv("YARPY_SERVER")
    monkeypatch.setenv("YARP_PORT_RANGE", str(port))
    responder = Responder(server.service.answer_multicast, port)
    responder.start()
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
    assert path.read_text(encoding="utf-8") == f"127.0.0.1 {found.port} yarp\n"
    assert here("where").code == 0


def test_a_file_that_holds_no_address_is_written_anew(found, here, tmp_path):
    path = Path(tmp_path, "config/yarp.conf")
    path.parent.mkdir()
    path.write_text("127.0.0.1 nine yarp\n", encoding="utf-8")
    said = here("detect", "--write")
    assert said.code == 0 and f'warning: {path}: "nine" is no port' in said.err
    assert path.read_text(encoding="utf-8") == f"127.0.0.1 {found.port} yarp\n"


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


@pytest.mark.peer("ros", "rosmaster")
def test_a_ros_master_is_stored_for_the_namespace(here, tmp_path, monkeypatch):
    for name in ("YARPY_SERVER", "YARP_NAMESPACE"):
        monkeypatch.delenv(name, raising=False)
    with ros_graph(tmp_path) as graph:
        monkeypatch.setenv("ROS_MASTER_URI", graph.uri)
        here("namespace", "/ros")
        said = here("detect", "--ros", "--write")
        assert said.code == 0
        assert f"Trying a ROS master, {graph.uri}\nReachable.  Writing.\n" in said.out
        assert f"/ros is now a ROS master, at http://127.0.0.1:{graph.port}/" in said.out
        assert here("where").code == 0
        listed = here("name", "list")
        assert listed.code == 0
        graph.master.call("registerPublisher", "/n", "/t", "a/B", "http://127.0.0.1:1/")
        graph.master.call(
            "registerService", "/n", "/s", "rosrpc://127.0.0.1:2", "http://127.0.0.1:1/"
        )
        listed = here("name", "list")
        for line in ('node "/n"', 'topic "/t"', 'service "/s"'):
            assert line in listed.out
        assert '"carrier": "rossrv"' in here("name", "list", "--json").out
        assert "port 2 type rossrv+service./s" in here("name", "query", "/s").out
        assert 'no port "/nobody" is registered' in here("name", "query", "/nobody").err
    assert here("where").code == 1


def test_no_ros_master(here, tmp_path, monkeypatch):
    monkeypatch.setenv("ROS_MASTER_URI", f"http://127.0.0.1:{free_port()}/")
    said = here("detect", "--ros")
    assert said.code == 1
    assert "Could not reach it." in said.out
    assert "roscore" in said.err
