"""Changes at real ports, and back."""

from __future__ import annotations

import sys
from collections.abc import Iterator

import pytest
from support.system import NO_MARKS
from support.wait import HANG

import yarpy
from yarpy.errors import LocalProtocolError
from yarpy.kits.autoqos.change import Change
from yarpy.kits.autoqos.controls import Controls
from yarpy.network.sampling import Sampler
from yarpy.qos import Qos

Ports = tuple[yarpy.Port, yarpy.BufferedPort, Sampler, Controls]


@pytest.fixture
def ports() -> Iterator[Ports]:
    names = yarpy.LocalNames()
    with (
        yarpy.Port("/a", names=names) as a,
        yarpy.BufferedPort("/b", names=names) as b,
        Sampler(names, urgent="tester") as sampler,
    ):
        a.connect("/b", "tcp")
        assert b.wait_for_inputs(timeout=HANG)
        yield a, b, sampler, Controls(sampler.ask, names)


@pytest.mark.skipif(bool(NO_MARKS), reason=NO_MARKS)
def test_packets(ports: Ports) -> None:
    a, _, _, controls = ports
    packets = Change("/a", "/b", "packets", "AF42", "CS0")
    controls.make(packets)
    assert a.outputs[0].qos.packets == "AF42"
    controls.make(packets.undone)
    assert a.outputs[0].qos.packets == "CS0"


def test_deadlines(ports: Ports) -> None:
    _, b, _, controls = ports
    timing = Change("/b", "/a", "timing", (0.5, 10.0), (0.0, 0.0))
    controls.make(timing)
    assert b.inputs[0].stats.missed is not None
    controls.make(timing.undone)
    assert not b.inputs[0].qos.timed


def test_threads(ports: Ports) -> None:
    _, b, _, controls = ports
    change = Change("/b", "/a", "threads", ("SCHED_FIFO", 30), ("SCHED_OTHER", 0))
    try:
        controls.make(change)
    except LocalProtocolError as error:
        # No right to, or no such thing: it says so.
        assert "real-time scheduling" in str(error) or "thread priorities" in str(error)
        return
    # Windows has levels, and tells the least priority of one.
    given = ("SCHED_RR", 1) if sys.platform == "win32" else ("SCHED_FIFO", 30)
    assert b.inputs[0].qos == Qos(*given, "CS0")
    controls.make(change.undone)
    assert b.inputs[0].qos.policy == "SCHED_OTHER"


def test_a_limit_on_a_port(ports: Ports) -> None:
    _, _, sampler, controls = ports
    first = Change("/a", "/a", "limit", 5.0, None)
    controls.make(first)
    controls.make(Change("/a", "/a", "limit", 3.0, 5.0))
    told = sampler.look().flows["/a", "/b"].sender
    assert told is not None and "Adaptive of the port" in told.dropped
    [told_too] = sampler.ask("/a", "get", "out", "/a")
    assert told_too["mbit"] == 3.0
    controls.make(first.undone)
    told = sampler.look().flows["/a", "/b"].sender
    assert told is not None and not told.dropped


def test_a_carrier_that_is_refused_costs_no_connection(ports: Ports) -> None:
    a, _, _, controls = ports
    with pytest.raises(yarpy.YarpError, match="nothing confirms"):
        controls.make(Change("/a", "/b", "carrier", "udp+send.adaptive", "tcp"))
    assert [output.carrier for output in a.outputs] == ["tcp"]


def test_a_limit_on_a_connection_and_another_carrier(ports: Ports) -> None:
    a, _, sampler, controls = ports
    carrier = Change("/a", "/b", "carrier", "tcp+send.adaptive", "tcp")
    controls.make(carrier)
    limit = Change("/a", "/b", "limit", 5.0, 0.0)
    controls.make(limit)
    told = sampler.look().flows["/a", "/b"].sender
    assert told is not None and told.parameters["mbit"] == 5.0
    controls.make(limit.undone)
    told = sampler.look().flows["/a", "/b"].sender
    assert told is not None and told.parameters["mbit"] == 0.0
    controls.make(carrier.undone)
    assert a.outputs[0].carrier == "tcp"


def test_what_is_refused_or_gone(ports: Ports) -> None:
    a, _, _, controls = ports
    change = Change("/a", "/b", "packets", "AF42", "CS0")
    assert not controls.is_gone(change)
    a.disconnect("/b")
    assert controls.is_gone(change)
    with pytest.raises(LocalProtocolError, match='"/a" does not set packets for "/b"'):
        controls.make(change)
    with pytest.raises(yarpy.UnknownName):
        controls.make(Change("/nobody", "/b", "packets", "AF42", "CS0"))


@pytest.mark.skipif(bool(NO_MARKS), reason=NO_MARKS)
def test_a_connection_that_was_dialled_by_address() -> None:
    names = yarpy.LocalNames()
    with (
        yarpy.Port("/a", names=names) as a,
        yarpy.BufferedPort("/b", names=names) as b,
        Sampler(names, urgent="tester") as sampler,
    ):
        a.connect(f"/{b.address}/", "tcp")
        assert b.wait_for_inputs(timeout=HANG)
        [flow] = sampler.look().flows.values()
        assert (flow.source, flow.target) == ("/a", "/b")
        assert flow.sender
        assert flow.receiver
        controls = Controls(sampler.ask, names)
        change = Change("/a", "/b", "packets", "AF42", "CS0")
        controls.make(change)
        assert a.outputs[0].qos.packets == "AF42"
        assert not controls.is_gone(change)
        controls.make(Change("/a", "/b", "carrier", "fast_tcp", "tcp"))
        assert [str(link.carrier) for link in a.outputs] == ["fast_tcp"]
