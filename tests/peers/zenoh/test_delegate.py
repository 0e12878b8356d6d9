"""A name server beside names on Zenoh, for programs that know a name server alone."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from support.port import free_port
from support.wait import HANG, wait_until

import yarpy
from yarpy.errors import NoNameServer, YarpError
from yarpy.peers.zenoh import reachability as direct
from yarpy.peers.zenoh.names import ZenohNames
from yarpy.peers.zenoh.router import open_router
from yarpy.peers.zenoh.transport import close

pytest.importorskip("zenoh", reason='Zenoh: pip install "yarpy[zenoh]"')


@pytest.fixture
def where(monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    """A router."""
    for name in ("YARPY_ZENOH", "YARPY_TLS", "YARPY_BIND"):
        monkeypatch.delenv(name, raising=False)
    address = f"127.0.0.1:{free_port()}"
    router = open_router([address])
    yield address
    close(router)


@pytest.fixture
def server(where: str) -> Iterator[yarpy.NameServer]:
    with yarpy.NameServer(beside={"zenoh": where}) as found:
        yield found


@pytest.fixture
def names(where: str) -> Iterator[ZenohNames]:
    """Names of another program on Zenoh."""
    found = ZenohNames(where.replace("127.0.0.1", "localhost"))
    yield found
    found.close()


def talk(server: yarpy.NameServer, names: ZenohNames) -> None:
    """A port of each kind writes to one of the other, and asks it."""
    with (
        yarpy.BufferedPort("/classical", names=server.client) as classical,
        yarpy.RpcServer("/adder", lambda message: [sum(message.value)], names=server.client),
        yarpy.BufferedPort("/modern", names=names) as modern,
        yarpy.Port("/out", names=server.client) as out,
        yarpy.Port("/modern/out", names=names) as modern_out,
    ):
        wait_until(lambda: names.query("/adder") and names.query("/out"))
        wait_until(lambda: server.client.query("/modern"))
        out.connect("/modern")
        out.write("from the server's world")
        assert modern.read(timeout=HANG).value == "from the server's world"
        modern_out.connect("/classical")
        modern_out.write("from Zenoh")
        assert classical.read(timeout=HANG).value == "from Zenoh"
        with yarpy.RpcClient("/adder", names=names) as client:
            assert client.ask([1, 2], timeout=HANG).value == [3]
        found = [contact.name for contact in names.list()]
        assert found == ["/adder", "/classical", "/modern", "/modern/out", "/out"]
    wait_until(lambda: not names.list())
    assert server.client.query("/modern") is None


def test_ports_of_one_computer(server: yarpy.NameServer, names: ZenohNames) -> None:
    talk(server, names)


def test_ports_that_cannot_dial_each_other(
    server: yarpy.NameServer, names: ZenohNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(direct.Reachability, "to", lambda self, entry: entry.through)
    talk(server, names)


def test_the_newer_port_has_the_name(server: yarpy.NameServer, names: ZenohNames) -> None:
    server.client.register("/x", "tcp", "127.0.0.1", 1)
    wait_until(lambda: names.query("/x"))
    names.register("/x", "tcp", "127.0.0.1", 2)
    wait_until(lambda: server.client.query("/x").port == 2)  # type: ignore[union-attr]
    server.client.register("/x", "tcp", "127.0.0.1", 3)
    wait_until(lambda: not names._own)
    assert names.query("/x").port == 3  # type: ignore[union-attr]


def test_without_a_router_the_server_knows_its_own(where: str) -> None:
    with pytest.raises(NoNameServer, match="router"):
        yarpy.NameServer(beside={"zenoh": f"127.0.0.1:{free_port()}"})
    number = free_port()
    router = open_router([f"127.0.0.1:{number}"])
    with yarpy.NameServer(beside={"zenoh": f"127.0.0.1:{number}"}) as server:
        server.client.register("/x", "tcp", "127.0.0.1", 1)
        close(router)
        wait_until(lambda: server.client.query("/nobody") is None)
        assert server.client.query("/x")


def test_rules_hold_for_those_who_are_brought(
    where: str, names: ZenohNames, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The port sees a connection of this computer, which may do what strangers may not."""
    monkeypatch.setattr(direct.Reachability, "to", lambda self, entry: entry.through)
    rules = tmp_path / "access.toml"
    rules.write_text('[[allow]]\nwho = ["loopback"]\nmay = ["all"]\n')
    monkeypatch.setenv("YARPY_ACCESS", str(rules))
    with (
        yarpy.NameServer(beside={"zenoh": where}) as server,
        yarpy.BufferedPort("/classical", names=server.client) as classical,
        yarpy.Port("/stranger", names=names) as stranger,
    ):
        wait_until(lambda: names.query("/classical"))
        with pytest.raises(YarpError):
            stranger.connect("/classical")
    rules = tmp_path / "open.toml"  # programs read such a file once
    rules.write_text('[[allow]]\nwho = ["anyone"]\nmay = ["all"]\n')
    monkeypatch.setenv("YARPY_ACCESS", str(rules))
    with (
        yarpy.NameServer(beside={"zenoh": where}) as server,
        yarpy.BufferedPort("/classical", names=server.client) as classical,
        yarpy.Port("/stranger", names=names) as stranger,
    ):
        wait_until(lambda: names.query("/classical"))
        stranger.connect("/classical")
        stranger.write("let in")
        assert classical.read(timeout=HANG).value == "let in"
