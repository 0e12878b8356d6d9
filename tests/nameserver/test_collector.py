"""Names of dead ports go away; names of living, silent and foreign things stay."""

import os
import signal
import socket
import subprocess
import sys
import time

import pytest
from support.patience import patience
from support.port import free_port

import yarpy
from yarpy.nameserver import collector

CRASHER = """
import os, yarpy
port = yarpy.Port("/dead/port")
print("ready", flush=True)
os.kill(os.getpid(), 9)
"""


@pytest.fixture
def server(monkeypatch):
    monkeypatch.setattr(collector.Collector.__init__, "__defaults__", (0.1, 0.5))
    with yarpy.NameServer() as server:
        yield server


def gone(name, seconds=5.0):
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline:
        if yarpy.query(name) is None:
            return True
        time.sleep(0.05)
    return False


def test_a_killed_port_loses_its_name(server):
    environment = {**os.environ, **server.environment}
    process = subprocess.run(
        [sys.executable, "-c", CRASHER], env=environment, timeout=30, capture_output=True
    )
    assert process.returncode == -signal.SIGKILL
    assert gone("/dead/port")


def test_living_ports_keep_their_names(server):
    with yarpy.Port("/living"):
        time.sleep(1)
        assert yarpy.query("/living") is not None


def test_a_foreign_endpoint_keeps_its_name_though_nothing_listens(server):
    server.client.register("/camera", "mjpeg", "127.0.0.1", free_port())
    server.client.register("/other", "tcp", "127.0.0.1", free_port())
    time.sleep(1)
    assert yarpy.query("/camera") is not None
    assert yarpy.query("/other") is not None


def test_a_port_that_listens_keeps_its_name_though_its_process_is_not_seen(server):
    """As in a container: the process number means nothing here, the address does."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        client = server.client
        client.register("/boxed", "tcp", "127.0.0.1", listener.getsockname()[1])
        client.set("/boxed", "process", 2**22 + 1)
        time.sleep(1)
        assert yarpy.query("/boxed") is not None
    assert gone("/boxed")


def test_number_that_nobody_listens_on_comes_back(server):
    """Handed out to somebody who never came: ten thousand such would be all there are."""
    client = server.client
    client.register("/never/opened")
    assert gone("/never/opened")
    used = client.register("/foreign/but/there")
    with socket.create_server(("127.0.0.1", used.port)):
        time.sleep(1.5)
        assert yarpy.query("/foreign/but/there") is not None
    time.sleep(1)
    assert yarpy.query("/foreign/but/there") is not None, "it was there once"


def test_numbers_of_silent_hosts_come_back(server, monkeypatch):
    """One of each host is tried, or ten thousand names would take hours."""
    tried = []

    def connect(address, timeout):
        tried.append(address)
        raise TimeoutError

    monkeypatch.setattr(collector.socket, "create_connection", connect)
    with server.service.lock:
        for number in range(50):
            server.service.store.register(f"/far/{number}", peer="192.0.2.1")
    deadline = time.monotonic() + 10
    while any(c.name.startswith("/far/") for c in server.service.store.contacts()):
        assert time.monotonic() < deadline
        time.sleep(0.05)
    assert len([address for address in tried if address[0] == "192.0.2.1"]) < 5


def test_a_complaint_has_the_name_looked_at(server, monkeypatch):
    """A process that lives may have lost its port; who cannot reach it says so."""
    client = server.client
    client.register("/lost", "tcp", "127.0.0.1", free_port())
    client.set("/lost", "process", os.getpid())
    time.sleep(0.6)
    assert yarpy.query("/lost") is not None
    with yarpy.Port("/asker") as asker:
        for _ in range(2):
            with pytest.raises(yarpy.LinkClosed):
                asker.connect("/lost")
        assert gone("/lost")


def test_silent_ports_of_a_host_delay_no_other(server, monkeypatch):
    """Anybody may give thousands of names to a host that does not answer."""
    tried = []
    really = socket.create_connection

    def connect(address, *more):
        if not address[0].startswith("192.0.2."):
            return really(address, *more)
        tried.append(address[1])
        if address[1] < 1000:
            time.sleep(0.05)
            raise TimeoutError
        raise ConnectionRefusedError

    monkeypatch.setattr(collector.socket, "create_connection", connect)
    client = server.client
    for number in range(1, 31):
        client.register(f"/a/silent{number}", "tcp", "192.0.2.7", number)
        client.set(f"/a/silent{number}", "process", 1)
    client.register("/z/dead", "tcp", "192.0.2.7", 1001)
    client.set("/z/dead", "process", 1)
    client.register("/z/elsewhere", "tcp", "192.0.2.8", 1002)
    client.set("/z/elsewhere", "process", 1)
    assert gone("/z/elsewhere", patience(10.0))
    assert gone("/z/dead", patience(30.0))  # of the same host: those that were silent come later
    assert len(set(tried)) > 10
    assert len(client.list("/a")) == 30


def test_a_host_name_that_cannot_be_one_is_no_proof():
    """Nor does it end the collector, which would raise."""
    assert not collector._refuses(yarpy.Contact("tcp", "/x", "x" * 70, 10000))
