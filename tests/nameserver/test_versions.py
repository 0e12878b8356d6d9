"""Asking ports that register which YARP they are of."""

from __future__ import annotations

import threading

import pytest
from support.port import free_port
from support.wait import HANG, wait_until
from support.yarp4 import administer_as_yarp4

import yarpy
from yarpy import facts
from yarpy.contact import Contact
from yarpy.nameserver import versions
from yarpy.nameserver.local import LocalNames
from yarpy.nameserver.server import NameServer
from yarpy.nameserver.versions import Versions
from yarpy.port.answer import spelling


@pytest.fixture
def names() -> LocalNames:
    return LocalNames()


def here(port: yarpy.Port) -> Contact:
    contact = port.contact
    return Contact("tcp", port.name, contact.host, contact.port)


def register_as_cpp(server: NameServer, name: str, port: int) -> Contact:
    """Say what a port of C++ says, in its order."""
    contact = server.client.register(name, "tcp", "127.0.0.1", port)
    for key, value in (("offers", "tcp"), ("accepts", "tcp"), ("ips", "127.0.0.1")):
        server.client.set(name, key, value)
    server.client.set(name, "process", 4711)
    return contact


def test_what_is_of_yarp_4_is_found(names: LocalNames, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(versions, "TIMEOUT", HANG)
    found: list[Contact] = []
    asking = Versions(found.append)
    with yarpy.Port("/new", names=names) as new, yarpy.Port("/old", names=names) as old:
        contacts = [here(one) for one in (new, old)]
        with monkeypatch.context() as patch:
            administer_as_yarp4(patch)
            asking.ask(contacts[0])
            wait_until(lambda: found)
        asking.ask(contacts[1])
        asking.ask(Contact("tcp", "/another", "127.0.0.1", contacts[0].port))
        wait_until(asking._queue.empty)
        asking.close()
        assert asking._thread is not None
        asking._thread.join(HANG)
        assert not asking._thread.is_alive() and found == contacts[:1]
    waiting = asking._queue.qsize()
    asking.ask(contacts[0])  # behind the end
    assert asking._queue.qsize() == waiting


def test_one_that_listens_a_moment_later(
    names: LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    tries: list[float] = []
    there = threading.Event()
    introduce = versions.probe.introduce

    def tried(*given: object) -> object:
        tries.append(0.0)
        if len(tries) == 2:
            there.set()
        return introduce(*given)  # type: ignore[arg-type]

    monkeypatch.setattr(versions.probe, "introduce", tried)
    monkeypatch.setattr(versions, "PAUSES", (0.01,) * 3000)
    administer_as_yarp4(monkeypatch)
    found: list[Contact] = []
    asking = Versions(found.append)
    number = free_port()
    contact = Contact("tcp", "/later", "127.0.0.1", number)
    asking.ask(contact)
    assert there.wait(HANG)
    with yarpy.Port("/later", names=names, tcp_port=number):
        wait_until(lambda: found == [contact])
    asking.close()


def test_a_flood_of_names_is_not_asked() -> None:
    asking = Versions(lambda contact: None)
    asking._thread = threading.current_thread()  # it has one, which is busy
    for number in range(versions.MOST + 10):
        asking.ask(Contact("tcp", f"/{number}", "127.0.0.1", 1))
    assert asking._queue.qsize() == versions.MOST
    asking.close()


def test_the_name_server_knows_it(monkeypatch: pytest.MonkeyPatch) -> None:
    with NameServer() as server, yarpy.Port("/other", register=False) as port:
        administer_as_yarp4(monkeypatch)
        register_as_cpp(server, "/other", here(port).port)
        wait_until(lambda: server.client.get("/other", spelling.PROPERTY) == [spelling.YARP4])
        server.client.register("/other", "tcp", "127.0.0.1", 1)
        assert server.client.get("/other", spelling.PROPERTY) == []  # it may be another one


@pytest.mark.parametrize("system", ["linux", "darwin", "win32"])
def test_ports_of_yarpy_are_not_asked(monkeypatch: pytest.MonkeyPatch, system: str) -> None:
    monkeypatch.setattr(facts, "SYSTEM", (system, "nt" if system == "win32" else "posix"))
    asked: list[Contact] = []
    monkeypatch.setattr(Versions, "ask", lambda self, contact: asked.append(contact))
    with NameServer() as server:
        with yarpy.Port("/in", names=server.client):
            assert server.client.get("/in", "process")
        register_as_cpp(server, "/out", 4711)
        assert [one.name for one in asked] == ["/out"]
