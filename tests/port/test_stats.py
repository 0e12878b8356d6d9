"""What ports and connections have counted, as values."""

import dataclasses
import socket

import pytest
from support.wait import HANG, wait_until

import yarpy
from yarpy.port.stats import port_stats

COUNTED = {
    "source": "/a",
    "target": "/b",
    "carrier": "tcp",
    "messages": 3,
    "bytes": 30,
    "replaced": 0,
    "drops": 1,
    "unconfirmed": 0,
    "rate": 2.0,
    "period": 0.5,
    "jitter": 0.0,
    "latency": 0.0,
    "since": 9.0,
}
SUMS = {"messages": 1, "bytes": 2, "replaced": 3, "drops": 4, "unconfirmed": 5}
FOUND = {
    "name": "/a",
    "inputs": [{**COUNTED, "missed": 7}],
    "outputs": [{**COUNTED, "unacknowledged": 2}],
    "unconnected": 6,
    "past": {"inputs": SUMS, "outputs": SUMS},
    "waiting": 1,
}


def test_plain_data_and_back() -> None:
    stats = port_stats(FOUND)
    assert stats.outputs[0].unacknowledged == 2 and stats.outputs[0].missed is None
    assert stats.inputs[0].missed == 7 and stats.past.outputs.drops == 4
    assert stats.as_dict() == FOUND
    assert stats.inputs[0].as_dict() == FOUND["inputs"][0]  # type: ignore[index]


def test_they_are_values() -> None:
    stats = port_stats(FOUND)
    with pytest.raises(dataclasses.FrozenInstanceError):
        stats.waiting = 3  # type: ignore[misc]
    with pytest.raises(AttributeError, match="dropped"):
        _ = stats.inputs[0].dropped  # type: ignore[attr-defined]


def test_of_living_ports(names: yarpy.LocalNames) -> None:
    with (
        yarpy.Port("/out", names=names) as out,
        yarpy.BufferedPort("/in", strict=True, names=names) as in_,
    ):
        out.write([0])
        out.connect("/in")
        out.write([1], wait=True)
        in_.read(timeout=HANG)
        assert out.stats.unconnected == 1
        assert out.stats.outputs[0].messages == in_.stats.inputs[0].messages == 1
        assert out.outputs[0].stats.target == "/in"
        assert in_.inputs[0].stats.unacknowledged is None


def test_an_administrator_is_no_input(names: yarpy.LocalNames) -> None:
    with (
        yarpy.Port("/in", names=names) as port,
        socket.create_connection(("127.0.0.1", port.contact.port)) as sock,
    ):
        sock.sendall(b"CONNACK admin\r\n")
        assert sock.recv(7) == b"Welcome"
        wait_until(lambda: port._hub.inputs.links)
        assert list(port.inputs) == list(port.stats.inputs) == []
