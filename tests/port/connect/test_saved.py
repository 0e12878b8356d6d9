"""Priorities and deadlines of connections that break and come back."""

from __future__ import annotations

import socket

import pytest
from support.system import NO_MARKS
from support.wait import HANG, wait_until

import yarpy
from yarpy.link.send.outbound import Outbound
from yarpy.port.connect import saved
from yarpy.qos import Qos
from yarpy.route import Route

# What the packets are marked with, where they can be, and what is seen otherwise.
LOW, HIGH = (None, None) if NO_MARKS else ("AF11", "AF42")
UNMARKED = "CS0"


@pytest.mark.parametrize("carrier", ["tcp", "fast_tcp"])
def test_a_connection_that_breaks_has_them_again(carrier: str) -> None:
    names = yarpy.LocalNames()
    with (
        yarpy.Port("/out", names=names) as out,
        yarpy.BufferedPort("/in", names=names) as in_,
    ):
        out.connect("/in", carrier)
        assert in_.wait_for_inputs(timeout=HANG)
        out.outputs[0].qos = Qos(packets=HIGH, deadline=5, late="drop")
        in_.inputs[0].qos = Qos(packets=LOW, rate=50)
        before = out._hub.outputs.links[0]
        before.driver.transport.interrupt()  # as where a switch breaks it

        def back() -> bool:
            out.write([1])
            links = out._hub.outputs.links
            return bool(links) and links[0] is not before and bool(in_.inputs)

        wait_until(back)
        wait_until(lambda: in_.inputs and in_.inputs[0].qos.rate == 50)
        assert in_.inputs[0].qos.packets == (LOW or UNMARKED)
        found = out.outputs[0].qos
        assert (found.packets, found.deadline, found.late) == (HIGH or UNMARKED, 5, "drop")
        assert not in_._hub.saved_qos._asked
        assert not out._hub.saved_qos._asked


def test_one_whose_end_was_not_seen_before_the_next_came() -> None:
    """A cable that was pulled tells nothing: the sender dials again, and the old one is there."""
    names = yarpy.LocalNames()
    with (
        yarpy.Port("/in", names=names) as in_,
        socket.create_connection(("127.0.0.1", in_.contact.port)) as first,
        socket.create_connection(("127.0.0.1", in_.contact.port)) as second,
    ):
        first.sendall(b"CONNECT /sender\r\n")
        assert in_.wait_for_inputs(timeout=HANG)
        in_.inputs[0].qos = Qos(packets=LOW, rate=50)
        before = in_._hub.inputs.links
        second.sendall(b"CONNECT /sender\r\n")
        wait_until(lambda: in_._hub.inputs.links != before)
        wait_until(lambda: in_.inputs[0].qos.rate == 50)
        assert in_.inputs[0].qos.packets == (LOW or UNMARKED)
        # In good order: nobody wants it any more.
        second.sendall(b"q\r\n")
        wait_until(lambda: not in_.inputs)
        assert not in_._hub.saved_qos._asked


def test_one_that_was_ended_begins_without() -> None:
    names = yarpy.LocalNames()
    with yarpy.Port("/out", names=names) as out, yarpy.BufferedPort("/in", names=names) as in_:
        out.connect("/in").qos = Qos(packets=HIGH, deadline=5)
        out.disconnect("/in")
        wait_until(lambda: not in_.inputs)
        found = out.connect("/in").qos
        assert (found.packets, found.deadline) == (UNMARKED, None)
        assert not out._hub.saved_qos._asked


def test_not_too_many_are_remembered(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(saved, "MOST", 3)

    class Link(Outbound):
        def __init__(self, target: str) -> None:
            self.route = Route("/out", target)
            self.asked, self.wanted = Qos(packets="HIGH"), None

    remembered = saved.SavedQos()
    for number in range(10):
        remembered.keep(Link(f"/{number}"))
    assert [peer for _, peer in remembered._asked] == ["/7", "/8", "/9"]


def test_what_the_system_refuses_is_logged(caplog: pytest.LogCaptureFixture) -> None:
    names = yarpy.LocalNames()
    with yarpy.Port("/out", names=names) as out, yarpy.BufferedPort("/in", names=names):
        out.connect("/in")
        link = out._hub.outputs.links[0]
        link.asked = Qos(packets="HIGH")
        out._hub.saved_qos.keep(link)
        link.driver.transport.set_dscp = _refuse  # type: ignore[method-assign]
        out._hub.saved_qos.give(link)
        assert "is back without its priority" in caplog.text


def _refuse(tos: int) -> None:
    raise OSError(1, "Operation not permitted")
