"""Connections between any two ports, from a program that has none."""

from __future__ import annotations

import socket
import threading
import time

import pytest
from support.lasted import lasted
from support.port import free_port
from support.wait import HANG, wait_until

import yarpy
from yarpy import network
from yarpy.errors import (
    AddressError,
    LinkClosed,
    LocalProtocolError,
    UnknownName,
    UnknownPlugin,
)
from yarpy.nameserver.local import LocalNames
from yarpy.port.port import Port

# ---------------------------------------------------------------------------------- asking


def _refuse(web: socket.socket) -> None:
    sock, _ = web.accept()
    sock.recv(100)
    sock.sendall(b"HTTP/1.1 400 Bad Request\r\n\r\n")
    sock.close()


def test_whether_a_port_lives(names: LocalNames) -> None:
    with Port("/in", names=names) as port:
        assert network.exists("/in", names=names)
        assert network.exists(f"/{port.address}", names=names)
        assert not network.exists("/none", names=names)
    names.register("/dead", "tcp", "127.0.0.1", free_port())
    assert not network.exists("/dead", names=names)
    with socket.create_server(("127.0.0.1", 0)) as web:
        names.register("/silent", "tcp", *web.getsockname())
        threading.Thread(target=_refuse, args=(web,), daemon=True).start()
        assert not network.exists("/silent", names=names)


# ---------------------------------------------------------------------------------- connecting

SPELLINGS = [
    # source, target, carrier, what the port says
    ("/out", "/in", None, "Added connection from /out to tcp://in"),
    ("/out", "/in", "fast_tcp", "Added connection from /out to fast_tcp://in"),
    ("/out", "udp://in", None, "Added connection from /out to udp://in"),
    ("udp://out", "/in", None, "Added connection from /out to udp://in"),
    ("/out", "/in", "tcp+peer_timeout.9", "Added connection from /out to tcp+peer_timeout.9://in"),
    ("/out", "udp://in", "fast_tcp", "Added connection from /out to fast_tcp://in"),
]


@pytest.mark.parametrize(("source", "target", "carrier", "line"), SPELLINGS)
def test_connect_and_disconnect(
    source: str, target: str, carrier: str | None, line: str, names: LocalNames
) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names) as in_:
        assert network.connect(source, target, carrier, names=names).reply == line
        assert len(out.outputs) == 1
        assert network.is_connected("/out", "/in", names=names)
        assert network.exists("/out", "/in", names=names)
        kind = out.outputs[0].carrier
        assert network.is_connected("/out", "/in", kind, names=names)
        assert not network.is_connected("/out", "/in", "mcast", names=names)
        assert in_.wait_for_inputs(timeout=HANG)
        out.write([1])
        assert in_.read(timeout=HANG).value == [1]
        assert network.disconnect("/out", "/in", names=names)
        assert not network.is_connected("/out", "/in", names=names)
        assert not network.disconnect("/out", "/in", names=names)


def test_connect_by_addresses(names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names) as in_:
        source, target = f"/{out.address}", f"/{in_.address}"
        network.connect(source, target, names=LocalNames())
        assert [o.target for o in out.outputs] == [f"/{in_.address}/"]
        assert network.is_connected(source, target, names=LocalNames())
        assert network.disconnect(source, target, names=LocalNames())
        assert out.outputs == []


def test_existing_connection_is_remade(names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names) as in_:
        network.connect("/out", "/in", names=names)
        network.connect("/out", "/in", "fast_tcp", names=names)
        assert [o.carrier for o in out.outputs] == ["fast_tcp"]
        wait_until(lambda: [i.carrier for i in in_.inputs] == ["fast_tcp"])


def test_what_cannot_be_connected(names: LocalNames) -> None:
    with Port("/out", names=names) as out, Port("/in", names=names):
        with pytest.raises(UnknownName, match='"/none"'):
            network.connect("/none", "/in", names=names)
        with pytest.raises(UnknownName, match='"/none"'):
            network.connect("/out", "/none", names=names)
        with pytest.raises(UnknownPlugin, match='did you mean "tcp"'):
            network.connect("/out", "/in", "tpc", names=names)
        with pytest.raises(AddressError, match="blanks"):
            network.connect("/out put", "/in", names=names)
        with pytest.raises(AddressError, match="invalid destination"):
            network.connect("/out", "in", names=names)
        with pytest.raises(AddressError, match="invalid source"):
            network.connect("out", "/in", names=names)
        names.register("/dead", "tcp", "127.0.0.1", free_port())
        with pytest.raises(LinkClosed, match="Cannot connect to port /dead"):
            network.connect("/dead", "/in", names=names)
        with pytest.raises(LinkClosed, match="was refused: Cannot connect to"):
            network.connect("/out", "/dead", names=names)
        with pytest.raises(LocalProtocolError, match="need a name server"):
            network.connect("/out", "topic://news", names=names)
        assert out.outputs == []
        assert not network.is_connected("/none", "/in", names=names)


@pytest.mark.parametrize("carrier", ["quic", "tpc"])
def test_what_the_ends_can_do_is_for_them_to_say(carrier: str, names: LocalNames) -> None:
    """Who asks need not have the carrier; a refusal says so, since it may be a slip of the pen."""
    with Port("/out", names=names) as out, Port("/in", names=names):
        out.connect("/in")
        with pytest.raises(UnknownPlugin, match=f"refused: Cannot connect to {carrier}://in: no"):
            network.connect("/out", "/in", carrier, names=names)
        assert [link.carrier for link in out.outputs] == ["tcp"]  # the one that there is stays


def test_waiting_for_both_ports(names: LocalNames) -> None:
    ports: list[Port] = []

    def open_later() -> None:
        for name in ("/out", "/in"):
            time.sleep(0.1)
            ports.append(Port(name, names=names))

    opening = threading.Thread(target=open_later, daemon=True)
    opening.start()
    network.connect("/out", "/in", names=names, timeout=HANG)
    assert network.is_connected("/out", "/in", names=names)
    opening.join()  # a port is there before its constructor has ended
    for port in ports:
        port.close()
    started = time.monotonic()
    with pytest.raises(UnknownName):
        network.connect("/out", "/in", names=names, timeout=0.1)
    assert lasted(started) < 10


# ---------------------------------------------------------------------------------- waiting


def test_waiting_for_a_port_and_a_connection(names: LocalNames) -> None:
    assert not network.wait_for("/in", timeout=0.05, names=names)
    with Port("/out", names=names) as out:
        ports: list[Port] = []
        opening = threading.Timer(0.1, lambda: ports.append(Port("/in", names=names)))
        opening.start()
        assert network.wait_for("/in", timeout=HANG, names=names)
        assert not network.wait_for("/out", "/in", timeout=0.05, names=names)
        connecting = threading.Timer(0.1, out.connect, ("/in",))
        connecting.start()
        assert network.wait_for("/out", "/in", timeout=HANG, names=names)
        for timer in (opening, connecting):
            timer.join()
        ports[0].close()


# --------------------------------------------------------------------------- registered cameras


# ---------------------------------------------------------------------------------- with a server


def test_default_name_server_is_used() -> None:
    with yarpy.NameServer(), yarpy.Port("/out") as out, yarpy.Port("/in") as in_:
        assert yarpy.connect("/out", "/in").reply == "Added connection from /out to tcp://in"
        assert yarpy.exists("/in")
        assert yarpy.is_connected("/out", "/in")
        assert yarpy.wait_for("/in", timeout=HANG)
        out.write([1])
        assert in_.read(timeout=HANG).value == [1]
        assert yarpy.query("/in") == in_.contact
        assert yarpy.ping("/in")
        assert yarpy.admin("/in", "ver")
        assert yarpy.disconnect("/out", "/in")


def test_topics_are_asked_of_the_server() -> None:
    with yarpy.NameServer() as server, yarpy.Port("/out") as out, yarpy.Port("/in"):
        assert network.connect("/out", "topic://news").reply == "connection to topic added."
        network.connect("topic://news", "/in", "fast_tcp")
        assert out.wait_for_outputs(timeout=HANG)
        assert network.disconnect("/out", "topic://news")
        assert "news" not in network.ask_server(server.client, ["subscribe"]).to_text().replace(
            "topic://news", ""
        )
        assert len(out.outputs) == 1  # as in C++, what exists stays
