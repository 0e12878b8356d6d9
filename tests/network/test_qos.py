"""The priority of connections between any two ports."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from support.system import NO_MARKS, NO_SCHEDULING
from support.wait import wait_until

import yarpy
from yarpy.data.bottle import Bottle
from yarpy.network import qos
from yarpy.qos import Qos


@pytest.fixture
def names() -> Iterator[yarpy.LocalNames]:
    found = yarpy.LocalNames()
    with yarpy.Port("/in", names=found) as in_, yarpy.Port("/out", names=found) as out:
        out.connect("/in")
        wait_until(lambda: in_.inputs)
        yield found


@pytest.mark.skipif(bool(NO_SCHEDULING or NO_MARKS), reason=NO_SCHEDULING or NO_MARKS)
def test_both_ends(names: yarpy.LocalNames) -> None:
    assert qos.granted("/out", "/in", names) == (
        Qos(packets="CS0"),
        Qos("SCHED_OTHER", 0, "CS0"),
    )
    qos.grant(
        "/out", "/in", sender=Qos(packets="HIGH"), receiver=Qos("SCHED_OTHER", 0, 3), names=names
    )
    assert qos.granted("/out", "/in", names) == (
        Qos(packets="AF42"),
        Qos("SCHED_OTHER", 0, 3),
    )
    qos.grant("/out", "/in", receiver=Qos("SCHED_OTHER", packets="LOW"), names=names)
    assert qos.granted("/out", "/in", names)[1] == Qos("SCHED_OTHER", 0, "LOW")


def test_no_such_port_or_connection(names: yarpy.LocalNames) -> None:
    for source, target in (("/out", "/other"), ("/nobody", "/in")):
        with pytest.raises(yarpy.UnknownName):
            qos.granted(source, target, names)
        with pytest.raises(yarpy.UnknownName):
            qos.grant(source, target, sender=Qos(packets="HIGH"), names=names)


def test_refusal_names_its_reason(names: yarpy.LocalNames, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise PermissionError

    monkeypatch.setattr("yarpy.platform.scheduling.schedule", refuse)
    with pytest.raises(yarpy.LocalProtocolError, match=r'"/in" does not set.* refuses real-time'):
        qos.grant("/out", "/in", receiver=Qos("SCHED_FIFO", 10), names=names)


def test_answers_of_cpp() -> None:
    text = "(sched ((policy 1) (priority 30) (tid -1))) (qos ((tos 144)))"
    assert qos.read(Bottle.from_text(text)) == Qos("SCHED_FIFO", 30, "AF42")
    text = "(sched ((policy -1) (priority -1) (tid -1))) (qos ((tos 0)))"
    assert qos.read(Bottle.from_text(text)) == Qos(packets="CS0")
    assert qos.read(Bottle()) == Qos()


def test_when_messages_should_come(names: yarpy.LocalNames) -> None:
    wanted = Qos(deadline=0.02, rate=50, late="drop")
    qos.grant("/out", "/in", sender=wanted, receiver=wanted, names=names)
    for found in qos.granted("/out", "/in", names):
        assert (found.deadline, found.rate, found.late) == (0.02, 50, "drop")
    qos.grant("/out", "/in", receiver=Qos(deadline=0, rate=0), names=names)
    assert not qos.granted("/out", "/in", names)[1].timed


def test_ports_that_know_no_deadlines_are_not_believed(
    names: yarpy.LocalNames, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("yarpy.link.receive.inbound.Inbound.expect", lambda self, wanted: None)
    with pytest.raises(yarpy.LocalProtocolError, match=r'"/in" is no port of yarpy'):
        qos.grant("/out", "/in", receiver=Qos(deadline=1), names=names)


def test_nonsense_about_deadlines_is_none() -> None:
    text = '(sched ((policy 0))) (timing ((deadline "soon") (rate -3) (late never)))'
    assert qos.read(Bottle.from_text(text)) == Qos("SCHED_OTHER")


def test_a_connection_that_was_dialled_by_address(names: yarpy.LocalNames) -> None:
    with yarpy.Port("/a", names=names) as a, yarpy.Port("/b", names=names) as b:
        a.connect(f"/{b.address}")
        wait_until(lambda: b.inputs)
        qos.grant("/a", "/b", sender=Qos(deadline=0.5), receiver=Qos(rate=3), names=names)
        found = qos.granted("/a", "/b", names)
        assert [(one.deadline, one.rate) for one in found] == [(0.5, None), (None, 3)]


def test_the_sender_stands_first(names: yarpy.LocalNames) -> None:
    """Both ends know the connection by the other's name: turned round, another one was changed."""
    for change in (
        lambda: qos.granted("/in", "/out", names),
        lambda: qos.grant("/in", "/out", sender=Qos(packets="HIGH"), names=names),
        lambda: qos.grant("/in", "/out", receiver=Qos("SCHED_OTHER", 0), names=names),
    ):
        with pytest.raises(yarpy.UnknownName, match="the sender stands first, /out /in"):
            change()
    assert qos.granted("/out", "/in", names)[0] == Qos(packets="CS0")


def test_of_two_connections_each_is_meant_as_it_is_written(names: yarpy.LocalNames) -> None:
    yarpy.connect("/in", "/out", names=names)
    qos.grant("/in", "/out", sender=Qos(deadline=0.5), names=names)
    assert qos.granted("/in", "/out", names)[0].deadline == 0.5
