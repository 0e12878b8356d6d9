"""A name server that comes back is told the names of our ports; `look` waits for nobody."""

import socket
import threading
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

import pytest
from support.port import free_port
from support.tls import prepare
from support.wait import HANG, wait_until

import yarpy
from yarpy.link.begin import handshake, pending
from yarpy.port.keep import server_watch
from yarpy.port.keep.registration import Registration
from yarpy.port.keep.server_watch import ServerWatch


class Client(yarpy.YarpNameClient):
    """A name server that a test takes away and brings back."""

    def __init__(self) -> None:
        super().__init__("127.0.0.1", free_port())
        self.there = True
        self.known = {"/port"}
        self.hangs = threading.Event()
        self.dialled = 0
        self.said: list[str] = []
        self.other_ends: list[socket.socket] = []

    def connect(self) -> socket.socket:
        self.dialled += 1
        if not self.there:
            self.hangs.wait(HANG)
            raise yarpy.NoNameServer("away")
        ours, theirs = socket.socketpair()
        self.other_ends.append(theirs)
        return ours

    def go_away(self) -> None:
        self.there = False
        self.known.clear()
        while self.other_ends:
            self.other_ends.pop().close()

    def query(self, name: str):
        return yarpy.Contact("tcp", name, "127.0.0.1", 10002) if name in self.known else None

    def register(self, name: str, *rest: object, **more: object):
        self.said.append(f"register {name}")
        self.known.add(name)
        return yarpy.Contact("tcp", name, "127.0.0.1", 10002)


@pytest.fixture
def client() -> Iterator[Client]:
    client = Client()
    yield client
    client.hangs.set()
    client.go_away()


@pytest.fixture
def watch() -> Iterator[ServerWatch]:
    watch = ServerWatch()
    yield watch
    watch.forget()


def hub(client: Client) -> SimpleNamespace:
    """What is looked at of a port."""
    registration = SimpleNamespace(
        type="",
        registered=True,
        describe=lambda names: names.said.append("describe"),
        give_back=lambda: client.said.append("give back"),
        again=threading.RLock(),
    )
    contact = yarpy.Contact("tcp", "/port", "127.0.0.1", 10002)
    return SimpleNamespace(
        name="/port",
        names=client,
        life=SimpleNamespace(closing=False),
        contact=contact,
        port=10002,
        registration=registration,
    )


def settle(watch: ServerWatch, hubs: list[SimpleNamespace]) -> bool:
    """Look until nothing is being tried; whether a server is away."""
    watch.look(hubs)
    wait_until(lambda: not watch._attempts.under_way)
    return watch.look(hubs)


def test_it_is_told_the_names_when_it_is_back(client: Client, watch: ServerWatch) -> None:
    ports = [hub(client)]
    assert not settle(watch, ports)
    assert not client.said, "it is there, and knows"
    client.go_away()
    client.hangs.set()
    assert settle(watch, ports)
    client.there = True
    wait_until(lambda: not settle(watch, ports))
    assert client.said == ["register /port", "describe"]


def test_one_that_was_started_anew_before_the_first_look(
    client: Client, watch: ServerWatch, caplog: pytest.LogCaptureFixture
) -> None:
    """It went away and came back within the half second before the ports were watched."""
    client.known.clear()
    assert not settle(watch, [hub(client)])
    assert client.said == ["register /port", "describe"]
    assert not caplog.text, "nothing of it was seen"


def test_a_server_that_hangs_is_not_waited_for(client: Client, watch: ServerWatch) -> None:
    other = Client()
    ports = [hub(client), hub(other)]
    assert not settle(watch, ports)
    client.go_away()
    for _ in range(50):
        assert watch.look(ports)
    wait_until(lambda: client.dialled == 2)
    assert watch.look(ports) and client.dialled == 2, "one attempt at a time"
    other.go_away()
    other.there = True
    watch.look(ports)
    wait_until(lambda: "describe" in other.said)
    other.go_away()


def test_the_connection_is_replaced_before_the_server_lets_it_go(
    client: Client,
    watch: ServerWatch,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
) -> None:
    """A server of yarpy ends connections that say nothing, which is no sign of its death."""
    assert server_watch.RENEW < pending.TIMEOUT
    ports = [hub(client)]
    settle(watch, ports)
    monkeypatch.setattr(server_watch, "RENEW", 0.0)
    watch.look(ports)
    wait_until(lambda: not watch._attempts.under_way)
    assert client.dialled == 2
    first, _ = client.other_ends
    assert first.recv(1) == b"", "the first one was closed"
    assert not client.said
    assert not caplog.text


def test_a_connection_that_proved_its_key_is_replaced_sooner(client: Client) -> None:
    """The server waits for the rest of its greeting no longer than that."""
    assert server_watch.RENEW_PROVED < handshake.TIMEOUT
    watched = server_watch._Watched(client)
    watched.returned(client.connect())
    watched._since -= server_watch.RENEW_PROVED + 1
    assert not watched.is_old()
    client._prepare = lambda connection: None
    assert watched.is_old()
    watched.forget()


def test_over_tls(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """Its sockets cannot be looked at without reading: the connection is watched without it."""
    prepare(tmp_path, monkeypatch, "require")
    with yarpy.NameServer(0, "127.0.0.1") as server:
        client = yarpy.YarpNameClient("127.0.0.1", server.port)
        watched = server_watch._Watched(client)
        watched.returned(client.connect())
        assert watched.is_there() and watched.is_there()
    wait_until(lambda: not watched.is_there())
    watched.forget()
    assert watched.away
    assert "went away" in caplog.text


def test_what_no_port_uses_any_more_is_let_go(client: Client, watch: ServerWatch) -> None:
    settle(watch, [hub(client)])
    [theirs] = client.other_ends
    watch.look([])
    assert theirs.recv(1) == b"", "the connection was closed"
    closing = hub(client)
    closing.life.closing = True
    settle(watch, [closing])
    client.go_away()
    client.hangs.set()
    settle(watch, [closing])
    client.there = True
    wait_until(lambda: not settle(watch, [closing]))
    assert not client.said, "a port that closes is not registered again"


def test_a_server_reached_too_late_is_left(client: Client, watch: ServerWatch) -> None:
    """Nobody wants it any more when it answers."""
    ours, theirs = socket.socketpair()
    settle(watch, [hub(client)])
    [server] = watch._watched.values()
    watch.forget()
    assert not server.returned(ours)
    assert theirs.recv(1) == b""
    theirs.close()


def test_a_port_without_a_name_is_not_registered(watch, client):
    """It was, a second after it had asked for another one, and nobody took its name back."""
    nameless = hub(client)
    nameless.registration.registered = False
    client.known.clear()
    settle(watch, [nameless])
    assert client.said == []


def test_a_port_that_closes_while_it_is_registered_gives_the_name_back(watch, client):
    closing = hub(client)
    client.known.clear()

    def describe(names):
        names.said.append("describe")
        closing.life.closing = True

    closing.registration.describe = describe
    settle(watch, [closing])
    assert client.said == ["register /port", "describe", "give back"]


class Slow(Client):
    """One that takes its time for the first question."""

    def __init__(self) -> None:
        super().__init__()
        self.asked, self.answer = threading.Event(), threading.Event()

    def query(self, name: str):
        if not self.asked.is_set():
            self.asked.set()
            self.answer.wait(HANG)
        return super().query(name)

    def unregister(self, name: str) -> None:
        self.known.discard(name)


def test_a_name_that_was_given_back_is_not_told_again(watch: ServerWatch) -> None:
    """The program may end as soon as it was: nobody would take the name out again."""
    client = Slow()
    client.known.clear()
    port = hub(client)
    registration = Registration("/port", client, "", register=True)
    registration.port = port.port
    registration.describe = lambda names: None  # type: ignore[method-assign]
    port.registration = registration
    watch.look([port])
    assert client.asked.wait(HANG)
    port.life.closing = True

    def close() -> None:
        registration.give_back()
        client.said.append("given back")

    closer = threading.Thread(target=close)
    closer.start()
    closer.join(0.2)  # in which it must not come to its end
    client.answer.set()
    closer.join(HANG)
    wait_until(lambda: not watch._attempts.under_way)
    assert client.said[-1] == "given back" and not client.known
    client.go_away()
