"""MQTT in the frames of a WebSocket: paho at a port, a port at mosquitto's listener for such."""

from __future__ import annotations

import socket
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from support import tls
from support.access import allow
from support.broker import Broker
from support.paho_client import end
from support.port import free_port
from support.wait import HANG, wait_until

import yarpy
from yarpy.peers.mqtt import broker as mqtt_broker


class WebSocketBroker(Broker):
    """A broker with a second listener, for WebSockets, which its topics name."""

    def __init__(self, folder: Path, *settings: str) -> None:
        self.frames = free_port()
        listener = f"listener {self.frames} 127.0.0.1"
        super().__init__(folder, listener, "protocol websockets", *settings)

    def answers(self) -> bool:
        try:
            socket.create_connection(("127.0.0.1", self.frames), HANG).close()
        except OSError:
            return False
        return super().answers()

    def topic(self, name: str, added: str = "") -> str:
        return super().topic(name, added).replace(f":{self.port}/", f":{self.frames}/")


@pytest.fixture
def broker(tmp_path: Path) -> Iterator[Broker]:
    found = WebSocketBroker(tmp_path)
    yield found
    found.stop()


class Paho:
    """A client of paho, over a WebSocket, as long as it lasts."""

    def __init__(self, port: int, path: str = "/mqtt", version: int = 5) -> None:
        paho = pytest.importorskip("paho.mqtt.client", reason="needs paho-mqtt")
        self.heard: list[bytes] = []
        self.client: Any = paho.Client(
            paho.CallbackAPIVersion.VERSION2, transport="websockets", protocol=version
        )
        self.client.ws_set_options(path)
        self.client.on_message = lambda client, data, message: self.heard.append(message.payload)
        self._port = port

    def __enter__(self) -> Paho:
        self.client.connect("127.0.0.1", self._port, keepalive=2)
        self.client.loop_start()
        return self

    def __exit__(self, *_: object) -> None:
        end(self.client)


# -------------------------------------------------------------------------------- without a broker


@pytest.mark.parametrize("path", ["/mqtt", "/", "/?ws"])
@pytest.mark.parametrize("version", [4, 5])
def test_paho_reads_a_port(out: yarpy.Port, path: str, version: int) -> None:
    with Paho(out.contact.port, path, version) as peer:
        peer.client.subscribe("arm/#")
        assert out.wait_for_outputs(timeout=HANG)
        out.write([1])
        out.write(bytes(100_000))
        wait_until(lambda: peer.heard == [b"[1]", bytes(100_000)])
        link = out._hub.outputs.links[0]
        before = link.driver.bytes_in
        wait_until(lambda: link.driver.bytes_in >= before + 16)  # two pings, which are answered
        assert peer.client.is_connected()
    wait_until(lambda: not out.outputs)


@pytest.mark.parametrize("qos", [0, 1, 2])
def test_paho_writes_into_a_port(reader: yarpy.BufferedPort, qos: int) -> None:
    with Paho(reader.contact.port) as peer:
        for number in range(20):
            peer.client.publish("goal", f"[{number}]", qos=qos)
        peer.client.publish("goal", bytes(100_000), qos=qos)
        found = [reader.read(timeout=HANG).value for _ in range(20)]
        assert found == [yarpy.Bottle([number]) for number in range(20)]
        assert reader.read(timeout=HANG).as_(bytes) == bytes(100_000)


def test_a_page_of_another_site_is_refused(reader: yarpy.BufferedPort) -> None:
    said = (
        "GET /mqtt HTTP/1.1\r\nHost: 127.0.0.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Version: 13\r\n"
        "Sec-WebSocket-Protocol: mqtt\r\nOrigin: http://elsewhere.example\r\n\r\n"
    )
    with socket.create_connection(("127.0.0.1", reader.contact.port), HANG) as page:
        page.sendall(said.encode())
        assert page.recv(12) == b"HTTP/1.1 403"
    assert not reader.inputs


def test_rules_of_access_hold(
    names: yarpy.LocalNames, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    allow(tmp_path, monkeypatch, "administer")
    with yarpy.BufferedPort("/in", names=names) as port:
        peer, refused = Paho(port.contact.port), list[str]()
        peer.client.on_connect = lambda client, data, flags, why, more: refused.append(str(why))
        with peer:
            wait_until(lambda: refused)
        assert refused[0] == "Not authorized"


def test_paho_comes_in_tls(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, reader: yarpy.BufferedPort
) -> None:
    folder = tls.prepare(tmp_path, monkeypatch)
    peer = Paho(reader.contact.port)
    peer.client.tls_set(str(folder / "ca.pem"))
    with peer:
        peer.client.publish("goal", "[1]", qos=1)
        assert reader.read(timeout=HANG).value == yarpy.Bottle([1])


# ----------------------------------------------------------------------------------- with a broker


@pytest.mark.peer("mosquitto")
@pytest.mark.parametrize("added", ["", "+qos.1", "+qos.2", "+v5+qos.1"])
def test_ports_meet_at_a_broker(
    broker: Broker, out: yarpy.Port, reader: yarpy.BufferedPort, added: str
) -> None:
    reader.connect(broker.topic("robot/#", f"+sub+ws{added}"))
    out.connect(broker.topic("robot/arm", f"+ws.%2Fmqtt{added}"))
    for number in range(100):
        out.write([number, "text"])
    out.write(bytes(20_000))
    found = [reader.read(timeout=HANG).value for _ in range(100)]
    assert found == [yarpy.Bottle([number, "text"]) for number in range(100)]
    assert reader.read(timeout=HANG).as_(bytes) == bytes(20_000)


@pytest.mark.peer("mosquitto")
def test_questions_go_through_a_broker(broker: Broker, names: yarpy.LocalNames) -> None:
    with (
        yarpy.RpcServer("/adder", lambda message: sum(message.value), names=names) as server,
        yarpy.RpcClient(name="/asker", names=names) as client,
    ):
        server.connect(broker.topic("ask", "+sub+rpc+ws"))
        client.connect(broker.topic("ask", "+rpc+ws"))
        assert [client.ask([number, 1], timeout=HANG).value for number in range(3)] == [1, 2, 3]


@pytest.mark.peer("mosquitto")
def test_a_silent_port_stays_connected(
    broker: Broker, out: yarpy.Port, reader: yarpy.BufferedPort, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(mqtt_broker, "KEEP_ALIVE", 2)  # the broker hangs up after 3 s
    often = replace(mqtt_broker.Client.limits, ping_interval=0.5)
    monkeypatch.setattr(mqtt_broker.Client, "limits", often)
    reader.connect(broker.topic("x", "+sub+ws"))
    out.connect(broker.topic("x", "+ws"))
    links = (*out._hub.outputs.links, *reader._hub.inputs.links)
    before = [link.driver.bytes_in for link in links]
    for link, had in zip(links, before, strict=True):  # four seconds, on a machine with time
        wait_until(lambda: link.driver.bytes_in >= had + 32)  # noqa: B023
    assert (*out._hub.outputs.links, *reader._hub.inputs.links) == links


@pytest.mark.peer("mosquitto")
def test_a_broker_in_tls(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    out: yarpy.Port,
    reader: yarpy.BufferedPort,
) -> None:
    folder = tls.prepare(tmp_path, monkeypatch)
    for file in folder.iterdir():
        file.chmod(0o644)  # mosquitto leaves root's rights behind
    parts = {"cafile": "ca", "certfile": "cert", "keyfile": "key"}
    settings = (f"{word} {folder / name}.pem" for word, name in parts.items())
    broker = WebSocketBroker(folder, "user root", *settings)
    try:
        reader.connect(broker.topic("x", "+sub+tls+ws"))
        out.connect(broker.topic("x", "+tls+ws"))
        out.write([1])
        assert reader.read(timeout=HANG).value == yarpy.Bottle([1])
    finally:
        broker.stop()
