"""A connection of two other ports: the same kind of thing as one of a port here."""

from __future__ import annotations

import pytest
from support.system import NO_MARKS
from support.wait import HANG, wait_until

import yarpy
from yarpy import network
from yarpy.errors import LocalProtocolError, UnknownName
from yarpy.nameserver.local import LocalNames
from yarpy.nameserver.server import NameServer
from yarpy.port.port import BufferedPort, Port
from yarpy.qos import Qos


def test_both_ways_to_connect_give_a_connection() -> None:
    names = LocalNames()
    with Port("/out", names=names) as out, BufferedPort("/in", strict=True, names=names) as in_:
        own = out.connect("/in", "fast_tcp")
        other = network.connect("/out", "/in", "tcp+peer_timeout.9", names=names)
        assert isinstance(own, yarpy.Connection)
        assert isinstance(other, yarpy.Connection)
        assert repr(own) == "<Connection /out -> /in (fast_tcp)>"
        assert repr(other) == "<Connection /out -> /in (tcp+peer_timeout.9)>"
        assert other.reply == "Added connection from /out to tcp+peer_timeout.9://in"
        for number in range(3):
            out.write([number])
        out.flush(5)
        wait_until(lambda: in_.waiting == 3)
        stats = other.stats
        assert stats.messages == out.outputs[0].stats.messages == 3
        assert stats.bytes > 0
        assert stats.drops == 0
        other.close()
        wait_until(lambda: not in_.inputs)
        assert out.outputs == []
        other.close()  # it has ended: nothing happens
        with pytest.raises(UnknownName, match='neither "/out" nor "/in"'):
            _ = other.stats


@pytest.mark.skipif(bool(NO_MARKS), reason=NO_MARKS)
def test_priority_is_read_and_asked_for_at_the_senders_end() -> None:
    names = LocalNames()
    with Port("/out", names=names) as out, BufferedPort("/in", names=names):
        made = network.connect("/out", "/in", names=names)
        made.qos = Qos(packets="high")
        assert made.qos.packets == out.outputs[0].qos.packets == Qos(packets="high").packets


def test_monitors_of_both_ends_are_told() -> None:
    names = LocalNames()
    with Port("/out", names=names), BufferedPort("/in", names=names):
        made = network.connect("/out", "/in", "tcp+send.throttleDown+period_ms.1", names=names)
        assert made.monitors == ["throttleDown"]


def test_decorated_ends_are_called_by_their_names() -> None:
    names = LocalNames()
    with Port("/out", names=names), BufferedPort("/in", names=names):
        made = network.connect("/out", "fast_tcp://in", names=names)
        assert (made.source, made.target, made.carrier) == ("/out", "/in", "fast_tcp")
        assert made.stats.messages == 0


def test_a_topic_is_left_and_has_no_numbers() -> None:
    with NameServer() as server, BufferedPort("/out"), BufferedPort("/in") as in_:
        sending = yarpy.connect("/out", "topic://news")
        assert sending.reply == "connection to topic added."
        hearing = yarpy.connect("topic://news", "/in")
        assert in_.wait_for_inputs(timeout=HANG)
        with pytest.raises((UnknownName, LocalProtocolError)):
            _ = sending.stats
        rules = server.service.topology.subscriptions
        assert len(rules()) == 2
        hearing.close()
        assert [rule.source for rule in rules()] == ["/out"]


def test_connection_of_a_port_is_the_one_that_was_just_made() -> None:
    names = LocalNames()
    with (
        BufferedPort("/both", names=names) as both,
        BufferedPort("/a", names=names),
        BufferedPort("/b", names=names),
    ):
        assert [both.connect(to).name for to in ("/a", "/b", "/both")] == ["/a", "/b", "/both"]
        again = both.connect("/a", "udp")
        assert (again.target, again.carrier) == ("/a", "udp")
        again.close()
        assert [each.target for each in both.outputs] == ["/b", "/both"]
        by_address = both.connect(f"/{network.query('/a', names).address}")
        assert by_address.stats.messages == 0
