"""What a port says first to a broker; wills that wait."""

from __future__ import annotations

import queue
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import paho.mqtt.client as paho
import pytest
from support.broker import Broker
from support.paho_client import end
from support.process import Process
from support.wait import HANG

import yarpy
from yarpy.errors import LocalProtocolError, RemoteProtocolError
from yarpy.peers.mqtt import packet as mqtt
from yarpy.peers.mqtt.broker import Publisher
from yarpy.peers.mqtt.hello import check, hello, name_of
from yarpy.route import Route, parse_carrier
from yarpy.testing import End

# A port that writes one word to a topic of a broker, and goes when its input ends.
PROGRAM = """
import sys, yarpy
with yarpy.Port("/arm", names=yarpy.LocalNames()) as out:
    out.connect(sys.argv[1])
    out.write(sys.argv[2])
    assert out.flush(timeout=30)
    print("written", flush=True)
    sys.stdin.read()
"""


@pytest.fixture
def broker(tmp_path: Path) -> Iterator[Broker]:
    found = Broker(tmp_path)
    try:
        yield found
    finally:
        found.stop()


@pytest.fixture
def heard(broker: Broker) -> Iterator[queue.Queue[bytes]]:
    """What comes to the topic `arm`."""
    found = queue.Queue[bytes]()
    ready = queue.Queue[bool]()
    watcher = paho.Client(paho.CallbackAPIVersion.VERSION2)
    watcher.on_message = lambda client, data, message: found.put(message.payload)
    watcher.on_subscribe = lambda *_: ready.put(True)
    watcher.connect("127.0.0.1", broker.port)
    watcher.loop_start()
    watcher.subscribe("arm", 1)
    ready.get(timeout=HANG)
    yield found
    end(watcher)


def arm(topic: str, word: str) -> Process:
    return Process([sys.executable, "-c", PROGRAM, topic, word])


# -- what mosquitto does -------------------------------------------------------------------------


@pytest.mark.peer("mosquitto")
@pytest.mark.parametrize("qos", ["1", "2"])
def test_a_will_waits_for_the_port_to_come_back(
    broker: Broker, heard: queue.Queue[bytes], qos: str
) -> None:
    """An hour; but the port is back before that, and says goodbye the second time."""
    topic = broker.topic("arm", f"+will.gone+will_delay.3600+qos.{qos}")
    for word in ("one", "two"):
        with arm(topic, word) as program:
            program.wait_line("written")
            assert heard.get(timeout=HANG) == f'"{word}"'.encode()
            if word == "one":
                program.kill()
            else:
                program.end_input()
                assert program.wait(HANG) == 0
    assert not session_is_kept(broker, "arm")
    with yarpy.Port("/last", names=yarpy.LocalNames()) as out:
        out.connect(broker.topic("arm"))
        out.write("three")
        assert heard.get(timeout=HANG) == b'"three"'  # and no will before it


@pytest.mark.peer("mosquitto")
def test_a_will_is_published_when_the_time_is_over(
    broker: Broker, heard: queue.Queue[bytes]
) -> None:
    with arm(broker.topic("arm", "+will.gone+will_delay.1+qos.1"), "here") as program:
        program.wait_line("written")
        assert heard.get(timeout=HANG) == b'"here"'
        program.kill()
        assert heard.get(timeout=HANG) == b"gone"
    assert not session_is_kept(broker, "arm")


def session_is_kept(broker: Broker, topic: str) -> bool:
    """Return whether the broker knows a port `/arm` that writes to a topic."""
    route = Route("/arm", f"/mqtt://127.0.0.1/{topic}", "mqtt+will.x+will_delay.1", 1, "h")
    said = queue.Queue[bool]()
    client = paho.Client(
        paho.CallbackAPIVersion.VERSION2, name_of(Publisher(route)), protocol=paho.MQTTv5
    )
    client.on_connect = lambda client, data, flags, reason, _: said.put(flags.session_present)
    client.connect("127.0.0.1", broker.port, clean_start=False)
    client.loop_start()
    try:
        return said.get(timeout=HANG)
    finally:
        end(client)


@pytest.mark.peer("mosquitto")
def test_what_the_broker_does_not_pass_on_is_counted(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    rules = tmp_path / "rules"
    rules.write_text("topic read #\n")
    rules.chmod(0o644)
    broker = Broker(tmp_path, "user root", f"acl_file {rules}")
    try:
        with yarpy.Port("/out", names=yarpy.LocalNames()) as out:
            for qos in ("1", "2"):
                out.connect(broker.topic("arm", f"+v5+qos.{qos}"))
                for number in range(3):
                    out.write([number])
                assert out.flush(timeout=HANG)
                (link,) = out.outputs
                assert link.stats.drops == 3, link.stats
                out.disconnect(broker.topic("arm"))
    finally:
        broker.stop()
    assert caplog.text.count("it does not allow us to write to this topic") == 2


@pytest.mark.peer("mosquitto")
@pytest.mark.parametrize(
    ("setting", "added", "words"),
    [
        ("max_qos 1", "+v5+qos.2", r"QoS 0 to 1 alone: say \+qos\.1"),
        ("retain_available false", "+v5+retain", r"leave \+retain out"),
    ],
)
def test_what_the_broker_does_not_do_is_said_beforehand(
    tmp_path: Path, setting: str, added: str, words: str
) -> None:
    broker = Broker(tmp_path, setting)
    try:
        with yarpy.Port("/out", names=yarpy.LocalNames()) as out:
            with pytest.raises(RemoteProtocolError, match=words):
                out.connect(broker.topic("arm", added))
            out.connect(broker.topic("arm", "+v5+qos.1"))
            out.write([1])
            assert out.flush(timeout=HANG)
    finally:
        broker.stop()


@pytest.mark.peer("mosquitto")
def test_messages_expire(broker: Broker) -> None:
    heard = queue.Queue[Any]()
    ready = queue.Queue[bool]()
    watcher = paho.Client(paho.CallbackAPIVersion.VERSION2, protocol=paho.MQTTv5)
    watcher.on_message = lambda client, data, message: heard.put(message)
    watcher.on_subscribe = lambda *_: ready.put(True)
    watcher.connect("127.0.0.1", broker.port)
    watcher.loop_start()
    watcher.subscribe("arm")
    ready.get(timeout=HANG)
    with yarpy.Port("/out", names=yarpy.LocalNames()) as out:
        out.connect(broker.topic("arm", "+expiry.900"))
        out.write([1], "(unit deg)")
        found = heard.get(timeout=HANG).properties
        assert 800 < found.MessageExpiryInterval <= 900
        assert found.UserProperty == [("unit", "deg")]
    end(watcher)


# -- the packets ----------------------------------------------------------------------------------


def dialled(spec: str) -> tuple[End, Publisher]:
    return End(), Publisher(Route("/arm", "/mqtt://broker:1883/x", spec, 1883, "broker"))


def test_the_packet() -> None:
    _, carrier = dialled("mqtt+will.gone+will_delay.90+qos.1")
    said = mqtt.Body(hello(carrier)[2:])
    assert bytes(said.string()) == b"MQTT"
    assert (said.number(1), said.number(1), said.number(2)) == (mqtt.V5, 0b00001100, 60)
    assert said.properties() == {mqtt.SESSION_EXPIRY: b"\0\0\0\x5a"}
    assert bytes(said.string()).startswith(b"yarpy-arm-") and said.properties() == {
        mqtt.WILL_DELAY: b"\0\0\0\x5a"
    }
    assert (bytes(said.string()), bytes(said.string())) == (b"x", b"gone")
    assert hello(carrier) == hello(dialled("mqtt+will.gone+will_delay.90+qos.1")[1])
    assert name_of(carrier) != name_of(dialled("mqtt+sub+session.90+qos.1")[1])


def test_the_goodbye_ends_the_session() -> None:
    end, carrier = dialled("mqtt+will.gone+will_delay.90")
    end.begin(carrier.greet(end.stream))
    end.feed(bytes.fromhex("2003000000"))
    end.take()
    carrier.encode_quit(end.stream)
    assert end.take() == bytes.fromhex("e00700051100000000")


def test_numbers_of_before_are_let_go_of() -> None:
    end, carrier = dialled("mqtt+will.gone+will_delay.90+qos.2")
    end.begin(carrier.greet(end.stream))
    end.take()
    end.feed(bytes.fromhex("2003010000"))  # it knows us
    released = end.take()
    assert released == b"".join(b"\x62\2" + n.to_bytes(2, "big") for n in range(1, 41))
    for number in range(1, 41):
        assert not end.done
        end.feed(b"\x70\3" + number.to_bytes(2, "big") + b"\x92")
    assert end.done
    end, carrier = dialled("mqtt+will.gone+will_delay.90+qos.2")
    end.begin(carrier.greet(end.stream))
    with pytest.raises(RemoteProtocolError, match="does not let go"):
        end.feed(bytes.fromhex("2003010000") + bytes.fromhex("400200010000"))


def test_one_message_that_is_not_taken_among_others() -> None:
    """Its refusal comes before the end of the one in front of it."""
    from yarpy.wire.message import Packet

    end, carrier = dialled("mqtt+v5+qos.2")
    end.begin(carrier.greet(end.stream))
    end.feed(bytes.fromhex("2003000000"))
    for number in range(3):
        carrier.encode(end.stream, Packet([number]))
    end.take()
    end.begin(carrier.expect_ack(end.stream))
    end.feed(bytes.fromhex("50020001" + "5003000297" + "50020003"))
    assert end.take() == bytes.fromhex("62020001" + "62020003") and not end.done
    end.feed(bytes.fromhex("70020001"))
    assert end.done
    end.begin(carrier.expect_ack(end.stream))
    assert end.done and carrier.lost == 1
    end.begin(carrier.expect_ack(end.stream))
    end.feed(bytes.fromhex("70020003"))
    assert end.done


@pytest.mark.parametrize(
    ("spec", "words"),
    [
        ("mqtt+will_delay.5", r"say \+will\.TEXT"),
        ("mqtt+will.x+will_delay.0", "say seconds"),
        ("mqtt+will.x+will_delay.-1", "say seconds"),
        ("mqtt+will.x+will_delay.99999999999", "say seconds"),
        ("mqtt+expiry.x", "say seconds"),
        ("mqtt+sub+expiry.5", "write to a topic"),
        ("mqtt+sub+will.x+will_delay.5", "write to a topic"),
    ],
)
def test_what_makes_no_sense(spec: str, words: str) -> None:
    with pytest.raises(LocalProtocolError, match=words):
        check(parse_carrier(spec))
