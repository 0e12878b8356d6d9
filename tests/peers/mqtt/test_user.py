"""User properties: bytes, envelopes, and paho at a port, both ways."""

from __future__ import annotations

import queue

import paho.mqtt.client as paho
import pytest
from paho.mqtt.packettypes import PacketTypes
from paho.mqtt.properties import Properties
from support.paho_client import end
from support.wait import HANG

import yarpy
from yarpy.errors import RemoteProtocolError
from yarpy.limit import MQTT_USER
from yarpy.peers.mqtt import packet as mqtt
from yarpy.peers.mqtt import user
from yarpy.peers.mqtt.carrier import Mqtt
from yarpy.route import Route, parse_carrier
from yarpy.testing import End
from yarpy.wire.message import Packet

PAIRS = [(b"unit", b"deg"), (b"unit", b"two words"), (b"", b"7"), ("naïve".encode(), b"(")]


def test_pairs_come_back() -> None:
    text = user.envelope_of(PAIRS)
    assert text == '(unit deg) (unit "two words") ("" "7") ("naïve" "(")'
    assert user.pairs_of(text.encode()) == PAIRS


@pytest.mark.parametrize(
    "text", [b"7 1.5", b"hello", b"(a b) c", b"(a 1)", b"((a b) (c d))", b"(a", b"(a b c)"]
)
def test_other_envelopes_have_a_name(text: bytes) -> None:
    assert user.pairs_of(text) == [(b"envelope", text)]
    assert user.envelope_of([(b"envelope", text)]) == text.decode()


def test_no_envelope_no_pairs() -> None:
    assert user.pairs_of(b"") == []
    assert user.envelope_of([]) == ""


def test_only_so_many_bytes_are_kept() -> None:
    pairs = [(b"n", b"x" * 1023)] * 20
    assert len(yarpy.Bottle.from_text(user.envelope_of(pairs))) == MQTT_USER // 1024
    assert len(user.envelope_of([(b"envelope", b"x" * 60000)])) == MQTT_USER


def publisher(spec: str) -> tuple[End, Mqtt]:
    end = End()
    carrier = Mqtt.of(parse_carrier(spec))(Route("/arm", "/mqtt://broker:1883/a", spec, 1883, "b"))
    end.begin(carrier.greet(end.stream))
    end.feed(b"\x20\3\0\0\0" if "v5" in spec else b"\x20\2\0\0")
    end.take()
    return end, carrier  # type: ignore[return-value]


def test_a_port_says_its_envelope() -> None:
    end, carrier = publisher("mqtt+v5")
    carrier.encode(end.stream, Packet([1], b"(unit deg)"))
    said = b"\x26\0\4unit\0\3deg"
    assert end.take() == mqtt.packet(mqtt.PUBLISH, b"\0\1a" + bytes((len(said),)) + said + b"[1]")
    carrier.encode(end.stream, Packet([1]))
    assert end.take() == mqtt.packet(mqtt.PUBLISH, b"\0\1a\0[1]")


def test_version_3_has_no_place_for_it() -> None:
    end, carrier = publisher("mqtt")
    carrier.encode(end.stream, Packet([1], b"(unit deg)"))
    assert end.take() == mqtt.packet(mqtt.PUBLISH, b"\0\1a[1]")


def test_a_pair_that_is_cut_off_is_refused() -> None:
    said = mqtt.Body(b"\6\x26\0\1a\0\5")
    with pytest.raises(RemoteProtocolError, match="too early"):
        said.properties([])


def test_paho_gives_and_gets_user_properties() -> None:
    names = yarpy.LocalNames()
    heard: queue.Queue[object] = queue.Queue()
    properties = Properties(PacketTypes.PUBLISH)
    properties.UserProperty = [("unit", "deg"), ("by", "the arm")]

    def program(port: yarpy.Port | yarpy.BufferedPort) -> paho.Client:
        made = paho.Client(paho.CallbackAPIVersion.VERSION2, protocol=paho.MQTTv5)
        made.on_message = lambda client, data, message: heard.put(message)
        made.connect(port.contact.host, port.contact.port)
        return made

    with (
        yarpy.Port("/out", names=names) as out,
        yarpy.BufferedPort("/in", strict=True, names=names) as port,
    ):
        writer, reader = program(port), program(out)
        reader.subscribe("out")
        for one in (writer, reader):
            one.loop_start()
        try:
            writer.publish("a", "[1]", properties=properties)
            message = port.read(timeout=HANG)
            assert message is not None
            assert message.envelope == '(unit deg) (by "the arm")'
            out.wait_for_outputs(timeout=HANG)
            out.write(message.value, stamp=message.envelope)
            got = heard.get(timeout=HANG)
            assert isinstance(got, paho.MQTTMessage)
            assert got.properties is not None
            assert got.properties.UserProperty == properties.UserProperty
        finally:
            for one in (writer, reader):
                end(one)
