"""Names of dead ports go away; names of living, silent and foreign things stay."""

import os
import socket
import subprocess
import sys
import time
from math import inf

import pytest
from support.port import free_port
from support.wait import HANG, wait_until

import yarpy
from yarpy.nameserver import collector

CRASHER = """
import os, yarpy
port = yarpy.Port("/dead/port")
print("ready", flush=True)
os.kill(os.getpid(), 9)
"""


@pytest.fixture
def rounds(monkeypatch):
    """Wait until the collector has looked often enough to remove what it would remove."""
    found = []
    look = collector.Collector.look

    def counted(self):
        look(self)
        found.append(self)

    def wait():
        before = len(found) + 1  # one may be under way
        wait_until(lambda: len(found) > before + collector.STRIKES)
        return found[-1]

    monkeypatch.setattr(collector.Collector, "look", counted)
    return wait


@pytest.fixture
def server(monkeypatch):
    monkeypatch.setattr(collector.Collector.__init__, "__defaults__", (0.02, 0.5))
    with yarpy.NameServer() as server:
        yield server


def wait_gone(name):
    wait_until(lambda: yarpy.query(name) is None, what=f"{name} is gone")


def test_a_killed_port_loses_its_name(server):
    environment = {**os.environ, **server.environment}
    process = subprocess.run(
        [sys.executable, "-c", CRASHER], env=environment, timeout=30, capture_output=True
    )
    assert abs(process.returncode) == 9  # on Windows it is no signal
    wait_gone("/dead/port")


def test_living_ports_keep_their_names(server, rounds):
    with yarpy.Port("/living"):
        rounds()
        assert yarpy.query("/living") is not None


def test_a_foreign_endpoint_keeps_its_name_though_nothing_listens(server, rounds):
    server.client.register("/camera", "mjpeg", "127.0.0.1", free_port())
    server.client.register("/other", "tcp", "127.0.0.1", free_port())
    rounds()
    assert yarpy.query("/camera") is not None
    assert yarpy.query("/other") is not None


def test_a_port_that_listens_keeps_its_name_though_its_process_is_not_seen(server, rounds):
    """As in a container: the process number means nothing here, the address does."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        client = server.client
        client.register("/boxed", "tcp", "127.0.0.1", listener.getsockname()[1])
        client.set("/boxed", "process", 2**22 + 1)
        rounds()
        assert yarpy.query("/boxed") is not None
    wait_gone("/boxed")


@pytest.mark.parametrize("text", ["\u00b2", "\u0664", "9" * 30, "9" * 5000, "-1", "x"])
def test_what_a_stranger_calls_a_process_does_not_end_the_watch(server, text):
    """Anybody may register a name and give it properties."""
    server.client.register("/odd", "tcp", "127.0.0.1", free_port())
    server.client.set("/odd", "process", text)
    environment = {**os.environ, **server.environment}
    subprocess.run([sys.executable, "-c", CRASHER], env=environment, timeout=60)
    wait_gone("/dead/port")
    assert server._serving._collector._thread.is_alive()


def test_a_round_that_fails_is_not_the_last(server, caplog, monkeypatch):
    look, tried = collector.Collector.look, []

    def once(self):
        tried.append(1)
        if len(tried) == 1:
            raise RuntimeError("oh")
        look(self)

    monkeypatch.setattr(collector.Collector, "look", once)
    wait_until(lambda: len(tried) > 2)
    assert "oh" in caplog.text


def test_number_that_nobody_listens_on_comes_back(server, rounds):
    """Handed out to somebody who never came: ten thousand such would be all there are."""
    client = server.client
    client.register("/never/opened")
    wait_gone("/never/opened")
    used = client.register("/foreign/but/there")
    with socket.create_server(("127.0.0.1", used.port)):
        watching = rounds()
        wait_until(lambda: inf in watching._lent.values(), what="seen to be taken up")
        assert yarpy.query("/foreign/but/there") is not None
    rounds()
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
    contacts = server.service.store.contacts
    wait_until(lambda: not any(one.name.startswith("/far/") for one in contacts()))
    assert len([address for address in tried if address[0] == "192.0.2.1"]) < 5


def test_who_comes_again_at_the_same_address_is_not_the_one_before(server, monkeypatch):
    """A port of C++ YARP registers, and listens a moment later."""
    number, looks = free_port(), []

    def again():
        server.client.register("/again", "tcp", "127.0.0.1", number)
        server.client.set("/again", "process", 2**22 + 1)

    def refuses(contact):
        looks.append(contact)
        again()
        return True

    again()
    monkeypatch.setattr(collector, "_refuses", refuses)
    wait_until(lambda: len(looks) > 5 or yarpy.query("/again") is None)
    assert yarpy.query("/again") is not None


def test_many_complaints_at_once_are_one_proof(monkeypatch):
    """Who waits for a port dials again and again, also before it listens."""
    monkeypatch.setattr(collector.Collector.__init__, "__defaults__", (2 * HANG, 2 * HANG))
    looks = []
    monkeypatch.setattr(collector, "_refuses", lambda contact: looks.append(contact) or True)
    with yarpy.NameServer() as server:
        server.client.register("/again", "tcp", "127.0.0.1", free_port())
        server.client.set("/again", "process", os.getpid())
        for number in range(1, 5):
            server.client.announce("/again", False)
            wait_until(lambda n=number: len(looks) >= n or yarpy.query("/again") is None)
        assert yarpy.query("/again") is not None


def test_a_complaint_has_the_name_looked_at(server, rounds):
    """A process that lives may have lost its port; who cannot reach it says so."""
    client = server.client
    client.register("/lost", "tcp", "127.0.0.1", free_port())
    client.set("/lost", "process", os.getpid())
    rounds()
    assert yarpy.query("/lost") is not None
    with yarpy.Port("/asker") as asker:
        with pytest.raises(yarpy.LinkClosed):
            asker.connect("/lost")
        with pytest.raises((yarpy.LinkClosed, yarpy.UnknownName)):  # a slow one
            asker.connect("/lost")
        wait_gone("/lost")


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
    wait_gone("/z/elsewhere")
    wait_gone("/z/dead")  # of the same host: those that were silent come later
    assert len(set(tried)) > 10
    assert len(client.list("/a")) == 30


def test_a_host_name_that_cannot_be_one_is_no_proof():
    """Nor does it end the collector, which would raise."""
    assert not collector._refuses(yarpy.Contact("tcp", "/x", "x" * 70, 10000))
