"""QoS 2: clients at a port and ports at a broker, with paho and mosquitto; each message once."""

from __future__ import annotations

from pathlib import Path

import paho.mqtt.client as paho
import pytest
from support.broker import Broker
from support.paho_client import end
from support.wait import HANG, wait_until

import yarpy
from yarpy.errors import RemoteProtocolError
from yarpy.limit import MQTT_UNRELEASED
from yarpy.peers.mqtt import packet as mqtt
from yarpy.peers.mqtt.session import MqttPeer
from yarpy.route import Route
from yarpy.testing import End

COUNT = 300
VERSIONS = [paho.MQTTv311, paho.MQTTv5]


@pytest.fixture
def broker(tmp_path: Path):  # type: ignore[no-untyped-def]
    found = Broker(tmp_path)
    yield found
    found.stop()


def publish(number: int, payload: bytes, again: bool = False) -> bytes:
    head = mqtt.string(b"a") + number.to_bytes(2, "big")
    return mqtt.packet(mqtt.PUBLISH | 4 | (8 if again else 0), head + payload)


@pytest.mark.parametrize("version", VERSIONS)
def test_paho_writes_to_a_port(names: yarpy.LocalNames, version: int) -> None:
    with yarpy.BufferedPort("/in", strict=True, names=names) as port:
        program = paho.Client(paho.CallbackAPIVersion.VERSION2, protocol=version)
        program.connect(port.contact.host, port.contact.port)
        program.loop_start()
        sent = [program.publish("a", str(n), qos=2) for n in range(COUNT)]
        got = []
        for _ in range(COUNT):
            message = port.read(timeout=HANG)
            assert message is not None
            got.append(message.value)
        assert got == list(range(COUNT))
        for each in sent:  # the whole handshake is over
            each.wait_for_publish(HANG)
            assert each.is_published()
        end(program)


@pytest.mark.peer("mosquitto")
@pytest.mark.parametrize("added", ["+qos.2", "+qos.2+v5"])
def test_ports_write_and_read_through_a_broker(
    names: yarpy.LocalNames, broker: Broker, added: str
) -> None:
    with (
        yarpy.Port("/out", names=names) as out,
        yarpy.BufferedPort("/in", strict=True, names=names) as reader,
    ):
        reader.connect(broker.topic("x", "+sub" + added))
        out.connect(broker.topic("x", added))
        for n in range(COUNT):
            out.write([n])
        got = []
        for _ in range(COUNT):
            message = reader.read(timeout=HANG)
            assert message is not None
            got.append(message.value[0])
        assert got == list(range(COUNT))
        assert len(out.outputs) == len(reader.inputs) == 1


@pytest.mark.peer("mosquitto")
def test_the_will_of_a_port(names: yarpy.LocalNames, broker: Broker) -> None:
    with yarpy.BufferedPort("/in", strict=True, names=names) as reader:
        reader.connect(broker.topic("x", "+sub+qos.1"))
        out = yarpy.Port("/out", names=names)
        out.connect(broker.topic("x", "+qos.2+will.%22gone%22"))
        out.write("here")
        first = reader.read(timeout=HANG)
        assert first is not None and first.value == "here"
        (link,) = out._hub.outputs.links
        link.driver.transport.interrupt()  # as if the program were killed
        last = reader.read(timeout=HANG)
        assert last is not None and last.value == "gone"
        out.close()


def test_a_message_that_comes_once_more_is_no_other() -> None:
    end, peer = End(), MqttPeer(Route("", "/in", "mqtt", 10002))
    end.begin(peer.decode(end.stream))
    end.feed(publish(7, b"[1]"))
    assert end.done and end.result.value == [1]
    end.begin(peer.decode(end.stream))
    end.feed(publish(7, b"[1]", again=True))
    assert not end.done
    assert end.take() == b""  # nobody has taken it yet
    peer.encode_ack(end.stream, 1)
    end.feed(publish(7, b"[1]", again=True))
    assert not end.done
    assert end.take() == bytes.fromhex("50020007") * 2
    end.feed(bytes.fromhex("62020007"))
    assert end.take() == bytes.fromhex("70020007")
    end.feed(publish(7, b"[2]"))  # the number is free
    assert end.done and end.result.value == [2]


def test_who_never_lets_go_is_refused() -> None:
    end, peer = End(), MqttPeer(Route("", "/in", "mqtt", 10002))
    with pytest.raises(RemoteProtocolError, match="does not release"):
        for number in range(1, MQTT_UNRELEASED + 2):
            end.begin(peer.decode(end.stream))
            end.feed(publish(number, b"1"))
            peer.encode_ack(end.stream, 1)
            end.take()
    assert number == MQTT_UNRELEASED + 1


def test_a_client_that_reads_is_granted_less(names: yarpy.LocalNames) -> None:
    with yarpy.Port("/out", names=names) as port:
        granted: list[int] = []
        program = paho.Client(paho.CallbackAPIVersion.VERSION2)
        program.on_subscribe = lambda c, d, m, codes, p: granted.extend(
            code.value for code in codes
        )
        program.connect(port.contact.host, port.contact.port)
        program.subscribe("out", qos=2)
        program.loop_start()
        wait_until(lambda: granted)
        assert granted == [0]
        end(program)
