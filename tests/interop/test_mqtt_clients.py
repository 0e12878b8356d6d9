"""Ports, mosquitto's broker and its clients, and paho: a port is a client, and is dialled."""

from __future__ import annotations

import subprocess
import threading
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
from support.process import Process
from support.wait import HANG, wait_until

import yarpy
from yarpy.peers.mqtt import broker as mqtt_broker

pytestmark = pytest.mark.peer("mosquitto")


@pytest.fixture
def broker(tmp_path: Path) -> Iterator[Broker]:
    found = Broker(tmp_path)
    yield found
    found.stop()


def run(program: str, port: int, *words: str) -> subprocess.CompletedProcess[str]:
    """A client of mosquitto, to its end."""
    command = [program, "-h", "127.0.0.1", "-p", str(port), *words]
    return subprocess.run(command, capture_output=True, text=True, timeout=2 * HANG)


# ----------------------------------------------------------------------------------- with a broker


def test_ports_meet_at_a_broker(
    broker: Broker, out: yarpy.Port, reader: yarpy.BufferedPort
) -> None:
    reader.connect(broker.topic("robot/#", "+sub"))
    out.connect(broker.topic("robot/arm"))
    for number in range(100):
        out.write([number, "text"])
    found = [reader.read(timeout=HANG).value for _ in range(100)]
    assert found == [yarpy.Bottle([number, "text"]) for number in range(100)]
    assert out.disconnect(broker.topic("robot/arm"))
    assert reader.disconnect(broker.topic("robot/#", "+sub"))
    wait_until(lambda: not reader.inputs)


@pytest.mark.parametrize("added", ["", "+sub", "+qos.1"])
def test_listening_to_a_topic_subscribes(
    broker: Broker, out: yarpy.Port, reader: yarpy.BufferedPort, added: str
) -> None:
    reader.listen_to(broker.topic("q/#", added))
    out.connect(broker.topic("q/a"))
    out.write([1])
    assert reader.read(timeout=HANG).value == yarpy.Bottle([1])


def test_clients_of_the_broker_see_a_port(
    broker: Broker, out: yarpy.Port, reader: yarpy.BufferedPort
) -> None:
    out.connect(broker.topic("state", "+qos.1+retain"))
    out.write({"angle": 45.0})
    assert out.flush(timeout=HANG)  # the broker has it
    said = run("mosquitto_sub", broker.port, "-t", "state", "-C", "1", "-v")
    assert said.stdout == 'state {"angle": 45.0}\n'
    reader.connect(broker.topic("goal", "+sub+qos.1"))
    run("mosquitto_pub", broker.port, "-t", "goal", "-q", "1", "-m", "[1, 2]")
    run("mosquitto_pub", broker.port, "-t", "goal", "-q", "0", "-m", "stop")
    assert reader.read(timeout=HANG).value == yarpy.Bottle([1, 2])
    assert reader.read(timeout=HANG).value == "stop"


def test_yarps_own_spelling_goes_through_a_broker(
    broker: Broker, out: yarpy.Port, reader: yarpy.BufferedPort
) -> None:
    reader.connect(broker.topic("raw", "+sub+raw"))
    out.connect(broker.topic("raw", "+raw"))
    value = yarpy.Bottle([1, yarpy.Vocab("set"), b"\0", bytes(100_000)])
    out.write(value)
    assert reader.read(timeout=HANG).value == value


def test_questions_go_through_a_broker(broker: Broker, names: yarpy.LocalNames) -> None:
    with yarpy.RpcClient(name="/asker", names=names) as client:
        client.connect(broker.topic("ask", "+rpc"))
        refusal = client.ask([1], timeout=HANG).value
        assert refusal == yarpy.Bottle(
            [yarpy.Vocab("fail"), "nobody has subscribed to ask at the broker"]
        )
        with yarpy.RpcServer("/adder", lambda message: sum(message.value), names=names) as server:
            server.connect(broker.topic("ask", "+sub+rpc"))
            for number in range(5):
                assert client.ask([number, 1], timeout=HANG).value == number + 1
            said = run("mosquitto_rr", broker.port, "-t", "ask", "-e", "mine", "-m", "[20, 1]")
            assert said.stdout == "21\n"


def test_a_broker_that_vanishes_is_dialled_again(
    broker: Broker, out: yarpy.Port, reader: yarpy.BufferedPort
) -> None:
    reader.connect(broker.topic("x", "+sub"))
    out.connect(broker.topic("x", "+qos.1"))
    out.write([1])
    assert reader.read(timeout=HANG).value == yarpy.Bottle([1])
    broker.stop()
    wait_until(lambda: not out.outputs and not reader.inputs)
    out.write("nobody hears this")
    broker.start()
    wait_until(lambda: out.outputs and reader.inputs)
    out.write([2])
    assert reader.read(timeout=HANG).value == yarpy.Bottle([2])


@pytest.mark.parametrize("added", ["", "+v5"])
def test_a_silent_port_stays_connected(
    broker: Broker,
    out: yarpy.Port,
    reader: yarpy.BufferedPort,
    added: str,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(mqtt_broker, "KEEP_ALIVE", 2)  # the broker hangs up after 3 s
    often = replace(mqtt_broker.Client.limits, ping_interval=0.5)
    monkeypatch.setattr(mqtt_broker.Client, "limits", often)
    reader.connect(broker.topic("x", f"+sub{added}"))
    out.connect(broker.topic("x", added))
    links = (*out._hub.outputs.links, *reader._hub.inputs.links)
    before = [link.driver.bytes_in for link in links]
    for link, had in zip(links, before, strict=True):  # four seconds, on a machine with time
        wait_until(lambda: link.driver.bytes_in >= had + 16)  # noqa: B023
    assert (*out._hub.outputs.links, *reader._hub.inputs.links) == links
    out.write([1])
    assert reader.read(timeout=HANG).value == yarpy.Bottle([1])


def test_a_broker_in_tls_with_passwords(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    out: yarpy.Port,
    reader: yarpy.BufferedPort,
) -> None:
    folder = tls.prepare(tmp_path, monkeypatch)
    for file in folder.iterdir():
        file.chmod(0o644)  # mosquitto leaves root's rights behind
    words = folder / "words"
    subprocess.run(["mosquitto_passwd", "-b", "-c", words, "me", "a+b"], check=True)
    broker = Broker(
        folder,
        "user root",
        "allow_anonymous false",
        f"password_file {words}",
        f"cafile {folder / 'ca.pem'}",
        f"certfile {folder / 'cert.pem'}",
        f"keyfile {folder / 'key.pem'}",
    )
    try:
        for login in ("", "+user.me+password.wrong"):
            with pytest.raises(yarpy.YarpError, match=r"\+user"):
                out.connect(broker.topic("x", f"+tls{login}"))
        with pytest.raises(yarpy.YarpError):
            out.connect(broker.topic("x", "+user.me+password.a%2Bb"))  # without TLS
        reader.connect(broker.topic("x", "+sub+tls+user.me+password.a%2Bb"))
        link = out.connect(broker.topic("x", "+tls+user.me+password.a%2Bb"))
        assert "a%2Bb" not in repr(link)
        out.write([1])
        assert reader.read(timeout=HANG).value == yarpy.Bottle([1])
    finally:
        broker.stop()


def test_targets_that_lead_nowhere_are_explained(broker: Broker, out: yarpy.Port) -> None:
    for target, why in (
        (f"mqtt://127.0.0.1:{broker.port}", "mqtt://HOST:PORT/TOPIC"),
        ("mqtt://127.0.0.1", "mqtt://HOST/TOPIC"),
        (broker.topic("a", "+bla"), r"no \"\+bla\""),
        (broker.topic("a/#"), "one topic"),
        (broker.topic("a", "+qos.3"), "QoS 0, 1 and 2"),
        ("mqtt://127.0.0.1:1/a", "nobody answers"),
    ):
        with pytest.raises(yarpy.YarpError, match=why):
            out.connect(target)
    assert not out.outputs


def test_programs_of_others_connect_them(broker: Broker) -> None:
    with yarpy.NameServer(free_port()) as server:
        names = server.client
        with (
            yarpy.Port("/out", names=names) as out,
            yarpy.BufferedPort("/in", strict=True, names=names) as inlet,
        ):
            yarpy.connect(broker.topic("way"), "/in", names=names)
            yarpy.connect("/out", broker.topic("way"), names=names)
            out.write([3])
            assert inlet.read(timeout=HANG).value == yarpy.Bottle([3])
            assert yarpy.disconnect("/out", broker.topic("way"), names=names)
            assert not out.outputs
            assert yarpy.disconnect(broker.topic("way"), "/in", names=names)
            wait_until(lambda: not inlet.inputs)


# -------------------------------------------------------------------------------- without a broker


@pytest.mark.parametrize("version", ["mqttv311", "mqttv5"])
def test_mosquitto_sub_reads_a_port(out: yarpy.Port, version: str) -> None:
    words = ["-V", version, "-t", "arm/#", "-C", "3", "-v"]
    command = ["mosquitto_sub", "-h", "127.0.0.1", "-p", str(out.contact.port), *words]
    with Process(command) as client:
        assert out.wait_for_outputs(timeout=HANG)
        for number in range(3):
            out.write([number])
        client.wait_line(r"arm/state \[2\]", timeout=HANG, stream="out")
    wait_until(lambda: not out.outputs)


@pytest.mark.parametrize("version", ["mqttv311", "mqttv5"])
@pytest.mark.parametrize("qos", ["0", "1", "2"])
def test_mosquitto_pub_writes_into_a_port(
    reader: yarpy.BufferedPort, version: str, qos: str
) -> None:
    found: list[Any] = []
    thread = threading.Thread(target=lambda: found.append(reader.read(timeout=2 * HANG)))
    thread.start()
    words = ["-V", version, "-q", qos, "-t", "anything", "-m", '{"speed": 2}']
    said = run("mosquitto_pub", reader.contact.port, *words)
    thread.join()
    assert (said.returncode, said.stderr) == (0, "")
    assert found[0].as_(dict) == {"speed": 2}
    assert found[0].source == "mqtt"


def test_mosquitto_rr_asks_a_port(names: yarpy.LocalNames) -> None:
    with yarpy.RpcServer("/double", lambda message: [2 * message.value], names=names) as server:
        said = run("mosquitto_rr", server.contact.port, "-t", "q", "-e", "answers", "-m", "21")
    assert said.stdout == "[42]\n"


def test_rules_of_access_hold(
    names: yarpy.LocalNames, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    allow(tmp_path, monkeypatch, "read")
    with yarpy.BufferedPort("/readable", strict=True, names=names) as port:
        said = run("mosquitto_pub", port.contact.port, "-q", "1", "-t", "x", "-m", "1")
        assert said.returncode
        with pytest.raises(yarpy.Timeout):
            port.read(timeout=0.1)
    allow(tmp_path, monkeypatch, "write")
    with yarpy.Port("/writable", names=names) as port:
        said = run("mosquitto_sub", port.contact.port, "-t", "#", "-W", str(int(HANG)))
        assert "denied" in said.stderr
        assert not port.outputs


def test_paho_reads_and_writes(out: yarpy.Port, reader: yarpy.BufferedPort) -> None:
    paho = pytest.importorskip("paho.mqtt.client", reason="needs paho-mqtt")
    heard: list[bytes] = []
    clients = []
    for port in (out, reader):
        client = paho.Client(paho.CallbackAPIVersion.VERSION2, protocol=paho.MQTTv5)
        client.on_message = lambda client, data, message: heard.append(message.payload)
        client.connect("127.0.0.1", port.contact.port, keepalive=3)
        client.loop_start()
        clients.append(client)
    try:
        clients[0].subscribe("arm/state")
        assert out.wait_for_outputs(timeout=HANG)
        out.write([1])
        wait_until(lambda: heard == [b"[1]"])
        clients[1].publish("x", "[2]", qos=1)
        assert reader.read(timeout=HANG).value == yarpy.Bottle([2])
        link = out._hub.outputs.links[0]
        before = link.driver.bytes_in
        wait_until(lambda: link.driver.bytes_in >= before + 4)  # two pings, which are answered
        assert clients[0].is_connected()
    finally:
        for client in clients:
            end(client)
