"""Connections out of a port: what waits, what is counted, what is refused."""

from __future__ import annotations

from support.wait import HANG

import yarpy


def test_messages_that_nobody_hears_are_counted(names: yarpy.LocalNames) -> None:
    with yarpy.Port("/out", names=names) as out, yarpy.Port("/in", names=names):
        assert [out.write(number) for number in range(3)] == [0, 0, 0]
        out.connect("/in")
        assert out._hub.outputs.unconnected == 3
        assert out.stats.unconnected == 3


def test_one_that_waits_for_slow_readers_or_not_applies_to_what_is_connected(
    names: yarpy.LocalNames,
) -> None:
    with (
        yarpy.BufferedPort("/out", names=names) as out,
        yarpy.BufferedPort("/in", names=names),
    ):
        out.connect("/in")
        (link,) = out._hub.outputs.links
        for strict in (True, False, True):
            out.strict = strict
            assert out.strict is strict and out._hub.outputs.newest is not strict
            assert link in out._hub.outputs.links


def test_what_ends_is_counted_as_past_once(names: yarpy.LocalNames) -> None:
    with yarpy.Port("/out", names=names) as out, yarpy.Port("/in", names=names) as in_:
        out.connect("/in")
        out.write(1)
        assert in_.read(HANG).value == 1
        (link,) = out._hub.outputs.links
        out.disconnect("/in")
        assert not out._hub.outputs.drop(link)
        assert out.stats.past.outputs.messages == 1
