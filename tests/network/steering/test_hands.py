"""Changes at real ports, and back."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

import yarpy
from yarpy.errors import LocalProtocolError
from yarpy.network.sampling import Sampler
from yarpy.network.steering.change import Change
from yarpy.network.steering.hands import Hands
from yarpy.qos import Qos

Ports = tuple[yarpy.Port, yarpy.BufferedPort, Sampler, Hands]


@pytest.fixture
def ports() -> Iterator[Ports]:
    names = yarpy.LocalNames()
    with (
        yarpy.Port("/a", names=names) as a,
        yarpy.BufferedPort("/b", names=names) as b,
        Sampler(names, urgent="tester") as sampler,
    ):
        a.connect("/b", "tcp")
        assert b.wait_for_inputs(timeout=10)
        yield a, b, sampler, Hands(sampler.ask, names)


def test_packets_and_deadlines(ports: Ports) -> None:
    a, b, _, hands = ports
    packets = Change("/a", "/b", "packets", "AF42", "CS0")
    hands.make(packets)
    assert a.outputs[0].qos.packets == "AF42"
    hands.make(packets.undone)
    assert a.outputs[0].qos.packets == "CS0"
    timing = Change("/b", "/a", "timing", (0.5, 10.0), (0.0, 0.0))
    hands.make(timing)
    assert "missed" in b.inputs[0].stats
    hands.make(timing.undone)
    assert not b.inputs[0].qos.timed


def test_threads(ports: Ports) -> None:
    _, b, _, hands = ports
    change = Change("/b", "/a", "threads", ("SCHED_FIFO", 30), ("SCHED_OTHER", 0))
    try:
        hands.make(change)
    except LocalProtocolError as error:
        assert "real-time scheduling" in str(error)  # no right to: it says so
        return
    assert b.inputs[0].qos == Qos("SCHED_FIFO", 30, "CS0")
    hands.make(change.undone)
    assert b.inputs[0].qos.policy == "SCHED_OTHER"


def test_a_limit_on_a_port(ports: Ports) -> None:
    _, _, sampler, hands = ports
    first = Change("/a", "/a", "limit", 5.0, None)
    hands.make(first)
    hands.make(Change("/a", "/a", "limit", 3.0, 5.0))
    told = sampler.look().flows["/a", "/b"].sender
    assert told is not None and "Adaptive of the port" in told.dropped
    [told_too] = sampler.ask("/a", "get", "out", "/a")
    assert told_too["mbit"] == 3.0
    hands.make(first.undone)
    told = sampler.look().flows["/a", "/b"].sender
    assert told is not None and not told.dropped


def test_a_carrier_that_is_refused_costs_no_connection(ports: Ports) -> None:
    a, _, _, hands = ports
    with pytest.raises(yarpy.YarpError, match="nothing confirms"):
        hands.make(Change("/a", "/b", "carrier", "udp+send.adaptive", "tcp"))
    assert [output.carrier for output in a.outputs] == ["tcp"]


def test_a_limit_on_a_connection_and_another_carrier(ports: Ports) -> None:
    a, _, sampler, hands = ports
    carrier = Change("/a", "/b", "carrier", "tcp+send.adaptive", "tcp")
    hands.make(carrier)
    limit = Change("/a", "/b", "limit", 5.0, 0.0)
    hands.make(limit)
    told = sampler.look().flows["/a", "/b"].sender
    assert told is not None and told.parameters["mbit"] == 5.0
    hands.make(limit.undone)
    told = sampler.look().flows["/a", "/b"].sender
    assert told is not None and told.parameters["mbit"] == 0.0
    hands.make(carrier.undone)
    assert a.outputs[0].carrier == "tcp"


def test_what_is_refused_or_gone(ports: Ports) -> None:
    a, _, _, hands = ports
    change = Change("/a", "/b", "packets", "AF42", "CS0")
    assert not hands.is_gone(change)
    a.disconnect("/b")
    assert hands.is_gone(change)
    with pytest.raises(LocalProtocolError, match='"/a" does not set packets for "/b"'):
        hands.make(change)
    with pytest.raises(yarpy.UnknownName):
        hands.make(Change("/nobody", "/b", "packets", "AF42", "CS0"))


def test_a_connection_that_was_dialled_by_address() -> None:
    names = yarpy.LocalNames()
    with (
        yarpy.Port("/a", names=names) as a,
        yarpy.BufferedPort("/b", names=names) as b,
        Sampler(names, urgent="tester") as sampler,
    ):
        a.connect(f"/{b.address}/", "tcp")
        assert b.wait_for_inputs(timeout=10)
        [flow] = sampler.look().flows.values()
        assert (flow.source, flow.target) == ("/a", "/b")
        assert flow.sender
        assert flow.receiver
        hands = Hands(sampler.ask, names)
        change = Change("/a", "/b", "packets", "AF42", "CS0")
        hands.make(change)
        assert a.outputs[0].qos.packets == "AF42"
        assert not hands.is_gone(change)
        hands.make(Change("/a", "/b", "carrier", "fast_tcp", "tcp"))
        assert [str(link.carrier) for link in a.outputs] == ["fast_tcp"]
