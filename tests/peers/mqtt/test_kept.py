"""Sessions that a broker keeps while a port is away, and subscriptions that ports share."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from support.broker import Broker
from support.wait import HANG, wait_until

import yarpy
from yarpy.errors import LocalProtocolError, RemoteProtocolError
from yarpy.peers.mqtt.broker import Subscriber
from yarpy.peers.mqtt.hello import check
from yarpy.route import Route, parse_carrier
from yarpy.testing import End

COUNT = 20


@pytest.fixture
def broker(tmp_path: Path) -> Iterator[Broker]:
    found = Broker(tmp_path)
    try:
        yield found
    finally:
        found.stop()


@pytest.mark.peer("mosquitto")
def test_what_comes_while_the_port_is_away(names: yarpy.LocalNames, broker: Broker) -> None:
    kept = broker.topic("x", "+sub+session.600+qos.1")
    with yarpy.Port("/out", names=names) as out:
        out.connect(broker.topic("x", "+qos.1"))
        for begin in (0, COUNT):
            with yarpy.BufferedPort("/in", strict=True, names=names) as reader:
                reader.connect(kept)
                got = []
                while len(got) < begin:
                    message = reader.read(timeout=HANG)
                    assert message is not None
                    got.append(message.value[0])
                assert got == list(range(begin))
            for n in range(COUNT if not begin else 0):
                out.write([n])
            assert out.flush(timeout=HANG)  # the broker has them


@pytest.mark.peer("mosquitto")
def test_ports_that_share_a_subscription(names: yarpy.LocalNames, broker: Broker) -> None:
    with (
        yarpy.Port("/out", names=names) as out,
        yarpy.BufferedPort("/one", strict=True, names=names) as one,
        yarpy.BufferedPort("/two", strict=True, names=names) as two,
    ):
        for reader in (one, two):
            reader.connect(broker.topic("$share/workers/x/#", "+sub+qos.1"))
        out.connect(broker.topic("x/1", "+qos.1"))
        for n in range(COUNT):
            out.write([n])
        got: dict[str, list[int]] = {"/one": [], "/two": []}

        def all_came() -> bool:
            for reader in (one, two):
                message = reader.poll()
                if message is not None:
                    assert message.source.endswith("/x/1"), message.source
                    got[reader.name].append(message.value[0])
            return sum(map(len, got.values())) == COUNT

        wait_until(all_came)
        assert sorted(got["/one"] + got["/two"]) == list(range(COUNT))
        assert got["/one"] and got["/two"]


def dialled(spec: str) -> tuple[End, Subscriber]:
    return End(), Subscriber(Route("/in", "/mqtt://broker:1883/x", spec, 1883, "broker"))


def test_its_name_is_the_same_each_time() -> None:
    hellos = []
    for _ in range(2):
        end, carrier = dialled("mqtt+sub+session.600+qos.1")
        end.begin(carrier.greet(end.stream))
        hellos.append(end.take())
    assert hellos[0] == hellos[1]
    assert hellos[0][8:18] == bytes.fromhex("0500003c051100000258")  # version 5, not clean, 600 s


def test_what_was_kept_may_come_before_the_broker_agrees() -> None:
    end, carrier = dialled("mqtt+sub+session.600+qos.1")
    end.begin(carrier.greet(end.stream))
    end.feed(bytes.fromhex("2003010000"))  # it knows us
    assert end.done
    end.begin(carrier.decode(end.stream))
    end.feed(bytes.fromhex("3209000178000100") + b"[7]")
    assert end.done and end.result.value == [7]
    end.begin(carrier.decode(end.stream))
    with pytest.raises(RemoteProtocolError, match="refuses the subscription to x"):
        end.feed(bytes.fromhex("900400010087"))


@pytest.mark.parametrize(
    ("spec", "words"),
    [
        ("mqtt+session.5+qos.1", "read from topics"),
        ("mqtt+sub+session.5", r"\+qos\.1"),
        ("mqtt+sub+session.0+qos.1", "say seconds"),
        ("mqtt+sub+session.x+qos.1", "say seconds"),
        ("mqtt+sub+session.99999999999+qos.1", "say seconds"),
    ],
)
def test_what_makes_no_sense(spec: str, words: str) -> None:
    with pytest.raises(LocalProtocolError, match=words):
        check(parse_carrier(spec))
