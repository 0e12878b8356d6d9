"""Properties and options of version 5: bytes, and paho and mosquitto at ports."""

from __future__ import annotations

import contextlib
import queue
import socket
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import paho.mqtt.client as paho
import pytest
from paho.mqtt.packettypes import PacketTypes
from paho.mqtt.properties import Properties
from paho.mqtt.subscribeoptions import SubscribeOptions
from support.broker import Broker
from support.paho_client import end
from support.wait import HANG, wait_until

import yarpy
from yarpy.errors import LocalProtocolError
from yarpy.peers.mqtt.broker import Publisher, Subscriber
from yarpy.peers.mqtt.carrier import Mqtt, Reader
from yarpy.peers.mqtt.packet import Body
from yarpy.route import Route, parse_carrier
from yarpy.testing import End
from yarpy.wire.message import Packet


def dialled(spec: str, welcome: str) -> tuple[End, Any]:
    end = End()
    carrier = Mqtt.of(parse_carrier(spec))(Route("/arm", "/mqtt://broker:1883/a", spec, 1883, "b"))
    end.begin(carrier.greet(end.stream))  # type: ignore[attr-defined]
    end.take()
    end.feed(bytes.fromhex(welcome))
    return end, carrier


def reader() -> tuple[End, Reader]:
    writer = Mqtt(Route("/w", "/out", "mqtt"))
    writer.version = 5
    return End(), Reader(writer)


def test_a_port_does_not_ask_for_what_is_retained() -> None:
    end, carrier = dialled("mqtt+sub+retain_handling.2+qos.1", "2003000000")
    assert isinstance(carrier, Subscriber) and carrier.version == 5
    assert end.take() == bytes.fromhex("820700010000016121")
    for wrong in ("mqtt+sub+retain_handling.3", "mqtt+retain_handling.1"):
        with pytest.raises(LocalProtocolError, match="N is 0, 1 or 2"):
            Mqtt.of(parse_carrier(wrong))


def test_what_is_too_large_for_the_broker_stays_here() -> None:
    end, carrier = dialled("mqtt+v5", "20080000052700000010")
    assert isinstance(carrier, Publisher)
    carrier.encode(end.stream, Packet("x" * 20))
    assert (end.take(), carrier.lost) == (b"", 1)
    carrier.encode(end.stream, Packet([1]))
    assert end.take() == bytes.fromhex("3007000161005b315d")


def test_subscriptions_of_a_reader_have_numbers() -> None:
    end, carrier = reader()
    assert carrier.subscribe(end.stream, Body(bytes.fromhex("0001 030bc801 00036f757400")))
    assert carrier.subscribe(end.stream, Body(bytes.fromhex("0002 020b02 00012300")))
    end.take()
    carrier.encode(end.stream, Packet([1]))
    assert end.take() == bytes.fromhex("300e 00036f7574 05 0bc801 0b02 5b315d")
    carrier.unsubscribe(end.stream, Body(bytes.fromhex("0003 00 00036f7574")))
    end.take()
    carrier.encode(end.stream, Packet([1]))
    assert end.take() == bytes.fromhex("300b 00036f7574 02 0b02 5b315d")


def test_nothing_is_too_large_for_a_reader() -> None:
    end, carrier = reader()
    carrier.most = 14
    assert carrier.subscribe(end.stream, Body(bytes.fromhex("0001 00 00036f757400")))
    end.take()
    carrier.encode(end.stream, Packet("x" * 20))
    assert (end.take(), carrier.lost) == (b"", 1)
    carrier.encode(end.stream, Packet([1]))
    assert end.take() == bytes.fromhex("3009 00036f7574 00 5b315d")


@pytest.mark.parametrize(("version", "reason"), [(5, "00 9e"), (4, "80")])
def test_a_port_shares_nothing_out(version: int, reason: str) -> None:
    end, carrier = reader()
    carrier.version = version
    pattern = b"$share/all/out"
    body = b"\0\1" + b"\0" * (version == 5) + len(pattern).to_bytes(2, "big") + pattern + b"\0"
    assert not carrier.subscribe(end.stream, Body(body))
    assert end.take() == bytes((0x90, 3 + (version == 5))) + bytes.fromhex(f"0001 {reason}")


# -- paho at a port -------------------------------------------------------------------------------


@pytest.fixture
def names() -> yarpy.LocalNames:
    return yarpy.LocalNames()


@contextlib.contextmanager
def program(port: Any, heard: queue.Queue[Any] | None = None, **said: Any) -> Iterator[paho.Client]:
    """A client that has connected, and says what it hears, and how its subscriptions went."""
    made = paho.Client(paho.CallbackAPIVersion.VERSION2, protocol=paho.MQTTv5)
    heard = heard if heard is not None else queue.Queue()
    made.on_message = lambda client, data, message: heard.put(message)
    made.on_subscribe = lambda client, data, number, reasons, more: heard.put(reasons)
    made.connect(port.contact.host, port.contact.port, **said)
    made.loop_start()
    try:
        yield made
    finally:
        end(made)


def properties(kind: int, **said: object) -> Properties:
    found = Properties(kind)
    for name, value in said.items():
        setattr(found, name, value)
    return found


def test_paho_numbers_its_subscriptions(names: yarpy.LocalNames) -> None:
    heard = queue.Queue[Any]()
    with yarpy.Port("/out", names=names) as out, program(out, heard) as client:
        number = properties(PacketTypes.SUBSCRIBE, SubscriptionIdentifier=200)
        options = SubscribeOptions(noLocal=True, retainAsPublished=True, retainHandling=2)
        client.subscribe("out", options=options, properties=number)
        assert not heard.get(timeout=HANG)[0].is_failure
        out.wait_for_outputs(timeout=HANG)
        out.write([1])
        message = heard.get(timeout=HANG)
        assert message.properties.SubscriptionIdentifier == [200]
        assert (message.payload, message.retain) == (b"[1]", False)


def test_paho_is_sent_no_more_than_it_takes(names: yarpy.LocalNames) -> None:
    heard = queue.Queue[Any]()
    most = properties(PacketTypes.CONNECT, MaximumPacketSize=100)
    with yarpy.Port("/out", names=names) as out, program(out, heard, properties=most) as client:
        client.subscribe("out")
        heard.get(timeout=HANG)
        out.wait_for_outputs(timeout=HANG)
        out.write("x" * 200)
        out.write("small")
        assert heard.get(timeout=HANG).payload == b'"small"'


def test_paho_hears_that_nothing_is_shared_out(names: yarpy.LocalNames) -> None:
    heard = queue.Queue[Any]()
    with yarpy.Port("/out", names=names) as out, program(out, heard) as client:
        client.subscribe("$share/all/out")
        (reason,) = heard.get(timeout=HANG)
        assert str(reason) == "Shared subscription not supported"


def test_paho_writes_under_a_topic_alias(names: yarpy.LocalNames) -> None:
    """A port says that it wants none; who uses one all the same is heard: no topic is looked at."""
    with (
        yarpy.BufferedPort("/in", strict=True, names=names) as port,
        program(port) as client,
    ):
        alias = properties(PacketTypes.PUBLISH, TopicAlias=1)
        client.publish("goal", "[1]", properties=alias, qos=1, retain=True)
        client.publish("goal", "[2]", properties=alias, qos=1)
        assert [port.read(timeout=HANG).value for _ in range(2)] == [[1], [2]]  # type: ignore[union-attr]


# -- ports at mosquitto ---------------------------------------------------------------------------


def test_the_will_of_paho_is_not_put_off(names: yarpy.LocalNames) -> None:
    """Its session ends with its connection, as it is told, and with that its will is due."""
    told: queue.Queue[Any] = queue.Queue()
    delay = properties(PacketTypes.WILLMESSAGE, WillDelayInterval=3600)
    expiry = properties(PacketTypes.CONNECT, SessionExpiryInterval=7200)
    made = paho.Client(paho.CallbackAPIVersion.VERSION2, protocol=paho.MQTTv5)
    made.will_set("arm", b'"gone"', properties=delay)
    made.on_connect = lambda client, data, flags, reason, more: told.put((flags, more))
    with yarpy.BufferedPort("/in", strict=True, names=names) as port:
        contact = port.contact
        made.connect(contact.host, contact.port, clean_start=False, properties=expiry)
        made.loop_start()
        try:
            flags, more = told.get(timeout=HANG)
            assert (flags.session_present, more.SessionExpiryInterval) == (False, 0)
            sock = made.socket()
            assert sock is not None
            sock.shutdown(socket.SHUT_RDWR)
            last = port.read(timeout=HANG)  # and not in an hour
            assert last is not None and last.value == "gone"
            flags, _ = told.get(timeout=HANG)  # it is back, and nobody knows it
            assert not flags.session_present
        finally:
            end(made)


def test_paho_hears_that_there_is_no_login_of_another_kind(names: yarpy.LocalNames) -> None:
    """It would wait for the next step of that."""
    told: queue.Queue[Any] = queue.Queue()
    method = properties(PacketTypes.CONNECT, AuthenticationMethod="SCRAM-SHA-1")
    made = paho.Client(paho.CallbackAPIVersion.VERSION2, protocol=paho.MQTTv5)
    made.on_connect = lambda client, data, flags, reason, more: told.put(reason)
    with yarpy.BufferedPort("/in", names=names) as port:
        made.connect(port.contact.host, port.contact.port, properties=method)
        made.loop_start()
        try:
            assert str(told.get(timeout=HANG)) == "Bad authentication method"
        finally:
            end(made)


@pytest.mark.peer("mosquitto")
def test_what_mosquitto_has_retained_is_left_out(tmp_path: Path, names: yarpy.LocalNames) -> None:
    broker = Broker(tmp_path)
    try:
        with (
            yarpy.Port("/out", names=names) as out,
            yarpy.BufferedPort("/all", strict=True, names=names) as everything,
            yarpy.BufferedPort("/new", strict=True, names=names) as new,
        ):
            out.connect(broker.topic("kept", "+retain+qos.1"))
            out.write("old")
            out.flush(HANG)
            everything.listen_to(broker.topic("kept", "+sub"))
            assert everything.read(timeout=HANG).value == "old"  # type: ignore[union-attr]
            new.listen_to(broker.topic("kept", "+sub+retain_handling.2"))
            out.write("young")
            assert new.read(timeout=HANG).value == "young"  # type: ignore[union-attr]
    finally:
        broker.stop()


@pytest.mark.peer("mosquitto")
def test_mosquitto_is_sent_no_more_than_it_takes(tmp_path: Path, names: yarpy.LocalNames) -> None:
    broker = Broker(tmp_path, "max_packet_size 100")
    try:
        with (
            yarpy.Port("/out", names=names) as out,
            yarpy.BufferedPort("/in", strict=True, names=names) as reader_,
        ):
            reader_.listen_to(broker.topic("small", "+sub"))
            out.connect(broker.topic("small", "+v5"))
            (route,) = out.stats.outputs
            out.write("x" * 200)
            out.write("small")
            assert reader_.read(timeout=HANG).value == "small"  # type: ignore[union-attr]
            wait_until(lambda: out.stats.outputs[0].drops == 1)
            assert out.stats.outputs[0].carrier == route.carrier
    finally:
        broker.stop()
