"""Two programs of one name that send to one port."""

from __future__ import annotations

import logging

import pytest
from support.wait import HANG, wait_until

import yarpy
from yarpy.port.answer import name_conflicts
from yarpy.port.answer.name_conflicts import LONG, MOST, SOON, NameConflicts


class Clock:
    """Time that passes when it is told to."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.now = 1000.0
        monkeypatch.setattr(name_conflicts.time, "monotonic", lambda: self.now)


def test_who_replaces_one_that_lives_twice_is_somebody_else(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    clock, found = Clock(monkeypatch), NameConflicts(lambda: "/in")
    assert not found.refusal("/out")
    found.replaced("/out")
    assert not found.refusal("/out"), "its connection broke, and nobody has noticed"
    clock.now += SOON + 1
    found.replaced("/out")
    assert not found.refusal("/out"), "once more"
    clock.now += SOON / 2
    found.replaced("/out")
    assert "another program" in found.refusal("/out")
    assert not found.refusal("/other")
    for _ in range(10):
        clock.now += LONG / 2
        assert found.refusal("/out"), "it dials again and again"
    clock.now += LONG + 1
    assert not found.refusal("/out")


def test_names_without_end_are_not_kept() -> None:
    found = NameConflicts(lambda: "/in")
    for number in range(3 * MOST):
        found.replaced(f"/out/{number}")
        found.replaced(f"/out/{number}")
    assert len(found._replaced) == len(found._refused) == MOST


@pytest.mark.parametrize("carrier", ["tcp", "fast_tcp", "unix_stream", "local"])
def test_one_stays_and_the_other_is_told(
    carrier: str, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With a name server each, as beside YARP's own and a ROS master."""
    monkeypatch.setattr(name_conflicts, "SOON", HANG)  # however long each takes on this machine
    events: list[yarpy.ConnectionEvent] = []
    caplog.set_level(logging.INFO)
    with (
        yarpy.Port("/in", names=yarpy.LocalNames(), callback=lambda message: None) as in_,
        yarpy.Port("/out", names=yarpy.LocalNames()) as one,
        yarpy.Port("/out", names=yarpy.LocalNames()) as other,
    ):
        in_.on_connection(events.append)
        target = f"/{in_.address}"
        one.connect(target, carrier)
        other.connect(target, carrier)
        told = 'another program called "/out" sends to "/in" already'
        wait_until(lambda: told in caplog.text, HANG)
        assert len(in_.inputs) == 1
        wait_until(lambda: len(one.outputs) + len(other.outputs) == 1, HANG)
        settled = len(events)
        assert settled <= 8
        stays = one if one.outputs else other
        for number in range(100):
            assert stays.write([number]) == 1
        stays.flush(HANG)
        wait_until(lambda: in_.inputs[0].stats.messages == 100, HANG)
        assert len(events) == settled
        assert caplog.text.count("two programs called") == 1
        goes = other if stays is one else one
        stays.close()
        goes.connect(target, carrier, timeout=HANG)
        assert goes.write([1]) == 1


def test_a_sender_may_close_its_connection_and_make_another_where_two_had_one_name() -> None:
    """What it has closed may look alive to the receiver, which has not read its end yet."""
    with (
        yarpy.Port("/in", names=yarpy.LocalNames(), callback=lambda message: None) as in_,
        yarpy.Port("/out", names=yarpy.LocalNames()) as out,
    ):
        in_._hub.inputs._conflicts.replaced("/out")
        in_._hub.inputs._conflicts.replaced("/out")
        assert "another program" in in_._hub.inputs._conflicts.refusal("/out")
        target = f"/{in_.address}"
        for _ in range(30):  # each takes the place of the one before it
            out.connect(target)
            assert out.write([1]) == 1
