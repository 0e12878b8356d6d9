"""Deadlines between two ports: counted, told, and kept from being sent too late."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator

import pytest
from support.lasted import lasted
from support.wait import HANG, wait_until

import yarpy
from yarpy.network import qos
from yarpy.network.sampling import flow
from yarpy.port.deadline import DeadlineEvent
from yarpy.qos import Qos


@pytest.fixture
def names() -> yarpy.LocalNames:
    return yarpy.LocalNames()


@pytest.fixture
def ends(names: yarpy.LocalNames) -> Iterator[tuple[yarpy.Port, yarpy.BufferedPort]]:
    with (
        yarpy.Port("/out", names=names) as out,
        yarpy.BufferedPort("/in", names=names, strict=True) as in_,
    ):
        out.connect("/in")
        assert in_.wait_for_inputs(timeout=HANG)
        yield out, in_


Ends = tuple[yarpy.Port, yarpy.BufferedPort]


def late(seconds: float) -> yarpy.Stamp:
    return yarpy.Stamp(1, time.time() - seconds)


def test_late_messages_are_counted_and_told(ends: Ends, names: yarpy.LocalNames) -> None:
    out, in_ = ends
    heard: list[DeadlineEvent] = []
    in_.on_deadline(heard.append)
    qos.grant("/out", "/in", receiver=Qos(deadline=60), names=names)
    assert qos.granted("/out", "/in", names)[1].deadline == 60
    for age in (0, 100, 0, 200):
        out.write([age], late(age))
        assert in_.read(timeout=HANG).value == [age]
    assert [event.silent for event in heard] == [False, False]
    assert (heard[1].source, heard[1].target, heard[1].missed) == ("/out", "/in", 2)
    assert 140 <= heard[1].lateness < 200
    assert "ms after the deadline (missed: 2)" in str(heard[1])
    assert in_.inputs[0].stats.missed == 2
    assert flow("/out", "/in", names).missed == 2
    in_.inputs[0].qos = Qos(deadline=0)
    assert in_.inputs[0]._link.chain is None
    assert in_.inputs[0].stats.missed is None


def test_late_messages_are_dropped_at_the_receiver(ends: Ends) -> None:
    out, in_ = ends
    in_.inputs[0].qos = Qos(deadline=60, late="drop")
    for age in (0, 100, 0):
        out.write([age], late(age))
    assert [in_.read(timeout=HANG).value for _ in range(2)] == [[0], [0]]
    stats = in_.inputs[0].stats
    assert (stats.missed, stats.drops) == (1, 1)


def test_what_is_late_already_is_not_sent(ends: Ends, names: yarpy.LocalNames) -> None:
    out, in_ = ends
    out.outputs[0].qos = Qos(deadline=60, late="drop")
    assert out.outputs[0].qos == Qos(packets="CS0", deadline=60, late="drop")
    assert [out.write([age], late(age)) for age in (0, 100)] == [1, 0]
    out._hub.outputs.links[0].start_background()
    assert [out.write([age], late(age)) for age in (0, 100)] == [1, 0]
    assert [in_.read(timeout=HANG).value for _ in range(2)] == [[0], [0]]
    assert out.outputs[0].stats.drops == 2
    found = flow("/out", "/in", names)
    assert found.sender is not None
    assert found.sender.timing["dropped"] == 2


@pytest.mark.parametrize("others", [0, 1])
def test_a_queue_does_not_send_what_has_become_late_in_it(
    names: yarpy.LocalNames, others: int
) -> None:
    """The reader holds the sender up until what waits is too late."""
    go, came = threading.Event(), []

    def read(message: yarpy.Message) -> None:
        came.append(message.value[0])
        go.wait(30)

    with (
        yarpy.Port("/out", names=names) as out,
        yarpy.Port("/in", names=names, callback=read) as in_,
        yarpy.BufferedPort("/other", names=names),
    ):
        out.connect("/in")
        if others:
            out.connect("/other")
        assert in_.wait_for_inputs(timeout=HANG)
        try:
            out.write([0])
            wait_until(lambda: came)
            link = out._hub.outputs.links[0]
            link.start_background()
            link.expect(Qos(deadline=0.2, late="drop"))
            started = time.monotonic()
            thread = threading.Thread(
                target=lambda: [out.write([number, b"x" * 100_000]) for number in range(1, 40)]
            )
            thread.start()
            time.sleep(0.5)
            wait_until(lambda: link.late)  # what waited for 0.2 s is too late
        finally:
            go.set()
        thread.join(30)
        assert out.flush(20)
        wait_until(lambda: in_.inputs[0].stats.messages == link.counter.messages)
        assert link.counter.messages + link.counter.drops == 40
        assert link.counter.drops == link.late
        assert lasted(started) < 60


def test_a_silence_is_told_once(ends: Ends) -> None:
    out, in_ = ends
    heard: list[DeadlineEvent] = []
    in_.on_deadline(heard.append)
    in_.inputs[0].qos = Qos(rate=20)
    out.write([1])
    wait_until(lambda: heard)
    assert heard[0].silent
    assert "nothing came from /out" in str(heard[0])
    assert in_.inputs[0].stats.missed == 1
    watch = in_._hub.callbacks.watch
    in_.close()
    assert watch is not None and watch._stopped.is_set


def test_a_callback_that_fails_costs_nothing(ends: Ends, caplog: pytest.LogCaptureFixture) -> None:
    out, in_ = ends

    def fail(event: DeadlineEvent) -> None:
        raise ZeroDivisionError

    in_.on_deadline(fail)
    in_.inputs[0].qos = Qos(deadline=60)
    out.write([1], late(100))
    assert in_.read(timeout=HANG).value == [1]
    assert "the deadline callback failed" in caplog.text


WRONG = ["(deadline -1)", "(deadline soon)", "(rate nan)", "(late never)", "(rate (1 2))"]


@pytest.mark.parametrize("text", WRONG)
def test_what_is_no_deadline_is_refused(ends: Ends, names: yarpy.LocalNames, text: str) -> None:
    from yarpy import network

    asked = yarpy.Bottle.from_text(f"(timing ({text}))")
    reply = network.admin("/in", "prop", "set", "/out", *asked, names=names)
    assert str(reply[0]) == "fail"
    assert ends[1].inputs[0]._link.timing is None


def test_monitors_still_see_what_comes(names: yarpy.LocalNames) -> None:
    with (
        yarpy.Port("/out", names=names) as out,
        yarpy.BufferedPort("/in", names=names, strict=True) as in_,
    ):
        out.connect("/in", "tcp+recv.throttleDown+period_ms.100000")
        assert in_.wait_for_inputs(timeout=HANG)
        in_.inputs[0].qos = Qos(deadline=60, late="drop")
        in_.attach("in", {"monitor": "throttleDown", "period_ms": 0})
        for age in (100, 0, 0):
            out.write([age], late(age))
        assert in_.read(timeout=HANG).value == [0]
        [link] = [one for one in in_._hub.inputs.links if one.route.source == "/out"]
        assert link.own_chain is not None
        wait_until(lambda: link.own_chain.dropped == [1])
        assert link.timing is not None and link.timing.missed == 1
        in_.inputs[0].qos = Qos(deadline=0)
        assert link.chain is not None
