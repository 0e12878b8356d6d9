"""mqtt_peer: topics, and what both sides of MQTT refuse."""

from __future__ import annotations

import pytest

from yarpy.errors import RemoteProtocolError
from yarpy.limit import MQTT_TOPIC
from yarpy.peers.mqtt import packet as mqtt
from yarpy.peers.mqtt.session import MqttPeer
from yarpy.route import Route
from yarpy.testing import End


@pytest.mark.parametrize(
    ("target", "topic"),
    [
        ("/mqtt://broker:1883/robot/arm", b"robot/arm"),
        ("/mqtt://broker:1883//robot", b"/robot"),
        ("/arm/left", b"arm/left"),
        ("/127.0.0.1:1883/", b""),
    ],
)
def test_topics_stand_behind_the_broker(target: str, topic: bytes) -> None:
    assert MqttPeer(Route("/out", target, "mqtt", 1883)).topic == topic


@pytest.mark.parametrize(
    ("data", "why"),
    [
        (b"\x36\5\0\1a\0\1", "QoS 3"),
        (mqtt.packet(mqtt.PUBLISH, mqtt.string(bytes(MQTT_TOPIC + 1))), "a topic of"),
        (b"\x10\0", "does not belong"),
    ],
)
def test_what_is_refused(data: bytes, why: str) -> None:
    end, peer = End(), MqttPeer(Route("", "/in", "mqtt", 10002))
    end.begin(peer.decode(end.stream))
    with pytest.raises(RemoteProtocolError, match=why):
        end.feed(data)
