"""Priorities of connections: asked for, granted, read back, refused."""

from __future__ import annotations

import socket
from collections.abc import Iterator

import pytest
from support.system import NO_MARKS, NO_SCHEDULING
from support.wait import HANG, wait_until

import yarpy
from yarpy.link import qos
from yarpy.platform import scheduling
from yarpy.qos import Qos, Sched

schedules = pytest.mark.skipif(bool(NO_SCHEDULING), reason=NO_SCHEDULING)


@pytest.fixture
def ports() -> Iterator[tuple[yarpy.Port, yarpy.Port]]:
    names = yarpy.LocalNames()
    with yarpy.Port("/in", names=names) as in_, yarpy.Port("/out", names=names) as out:
        out.connect("/in")
        wait_until(lambda: in_.inputs)
        yield out, in_


@pytest.fixture
def refusing(monkeypatch: pytest.MonkeyPatch) -> None:
    """A system that lets nobody have real-time scheduling."""

    def refuse(*_: object) -> None:
        raise PermissionError

    monkeypatch.setattr(scheduling, "schedule", refuse)


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> list[tuple[int, int, int]]:
    """What the system is asked for, by a process that may have it."""
    seen: list[tuple[int, int, int]] = []
    monkeypatch.setattr(scheduling, "schedule", lambda *what: seen.append(what))
    return seen


@schedules
def test_nothing_is_set_at_first(ports) -> None:
    out, in_ = ports
    assert out.outputs[0].qos == Qos(packets="CS0")  # the writer's thread sends: none of its own
    assert in_.inputs[0].qos == Qos("SCHED_OTHER", 0, "CS0")


@pytest.mark.skipif(bool(NO_MARKS), reason=NO_MARKS)
@pytest.mark.parametrize("packets", ["HIGH", "AF12", 3])
def test_packets_of_either_side(ports, packets) -> None:
    for connection in (ports[0].outputs[0], ports[1].inputs[0]):
        connection.qos = Qos(packets=packets)
        assert connection.qos.packets == Qos(packets=packets).packets
        sock = connection._link.driver.transport.sock
        assert sock.getsockopt(socket.IPPROTO_IP, socket.IP_TOS) == Qos(packets=packets).tos


@pytest.mark.skipif(not NO_MARKS, reason="this system marks packets as a program wants")
@pytest.mark.parametrize("carrier", ["tcp", "udp"])
def test_windows_says_who_marks_packets_there(ports, carrier) -> None:
    out, _ = ports
    out.connect("/in", carrier)
    with pytest.raises(yarpy.LocalProtocolError, match=r"New-NetQosPolicy .* -DSCPAction 36"):
        out.outputs[0].qos = Qos(packets="HIGH")
    assert out.outputs[0].qos.packets == "CS0"


@schedules
def test_output_that_is_scheduled_gets_its_thread(ports, asked) -> None:
    out, in_ = ports
    out.outputs[0].qos = Qos("SCHED_FIFO", 30)
    link = out._hub.outputs.links[0]
    assert link.thread is not None
    assert asked == [(link.thread.native_id, 1, 30)]
    for number in range(10):
        assert out.write([number]) == 1
        assert in_.read(timeout=HANG).value == [number]
    out.outputs[0].qos = Qos(priority=31)  # the policy stays
    assert asked[-1] == (link.thread.native_id, 1, 31)
    out.outputs[0].qos = Qos("SCHED_OTHER")
    assert asked[-1] == (link.thread.native_id, 0, 0)


@schedules
def test_input_that_is_scheduled_is_read_by_its_thread(ports, asked) -> None:
    out, in_ = ports
    for number in range(20):  # the reader gets the lease
        out.write([number])
        in_.read(timeout=HANG)
    in_.inputs[0].qos = Qos("SCHED_RR", 7)
    link = in_.inputs[0]._link
    assert asked == [(link.thread.native_id, 2, 7)]
    for number in range(20):
        out.write([number])
        assert in_.read(timeout=HANG).value == [number]
    assert not link.turn.leased


@schedules
def test_refusal_says_what_to_do_and_changes_nothing(ports, refusing) -> None:
    out, in_ = ports
    for connection in (out.outputs[0], in_.inputs[0]):
        with pytest.raises(yarpy.LocalProtocolError, match=scheduling.RIGHTS[:6]):
            connection.qos = Qos("SCHED_FIFO", 30)
        assert connection._link.sched == Sched()
    out.write([1])
    assert in_.read(timeout=HANG).value == [1]


def test_wrong_values_are_refused_before_anything_is_changed(ports) -> None:
    link = ports[0]._hub.outputs.links[0]
    for sched in (Sched(1, 100), Sched(1, 0), Sched(0, 5), Sched(9, 5)):
        with pytest.raises(ValueError, match=r"priority|policy"):
            qos.grant_sched(link, sched)
    with pytest.raises(ValueError, match="TOS"):
        qos.grant_tos(link, 256)
    assert (link.thread, link.sched, link.tos) == (None, Sched(), 0)


@pytest.mark.parametrize("carrier", ["local", "unix_stream", "udp"])
def test_other_carriers(carrier) -> None:
    names = yarpy.LocalNames()
    with yarpy.Port("/in", names=names) as in_, yarpy.Port("/out", names=names) as out:
        out.connect("/in", carrier)
        wait_until(lambda: in_.inputs)
        marked = out.outputs[0]
        if carrier == "udp" and not NO_MARKS:
            marked.qos = Qos(packets="CRIT")
            assert marked.qos.packets == "VA"
        else:
            assert marked.qos.packets == "CS0"


def test_values() -> None:
    assert Qos("rr", 1, "LOW") == Qos("SCHED_RR", 1, 10)
    assert Qos.of(Sched(1, 30), 12) == Qos("SCHED_FIFO", 30, 3)
    assert Qos.of(Sched(), -1) == Qos()
    for wrong in (("LIFO",), ("SCHED_FIFO", 100), (None, None, "WOW"), (None, None, 64)):
        with pytest.raises(ValueError, match=r"policy|priority|DSCP"):
            Qos(*wrong)
