"""Connections out of a port: what waits, what is counted, what is refused."""

from __future__ import annotations

import inspect
import select
import socket
import sys
from types import FrameType
from typing import Any

import pytest
from support.wait import HANG, wait_until

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


@pytest.mark.skipif(
    not hasattr(select, "poll"), reason="this system does not tell of an end behind unread bytes"
)
@pytest.mark.parametrize(
    "asks", [b"CONNECT foo\r\nr\r\n", b"GET /?action=stream HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"]
)
@pytest.mark.parametrize("says", [b"q\r\n", b"abc"])
def test_the_end_of_a_reader_that_said_something_is_noticed_by_a_port_that_sends_nothing(
    asks: bytes, says: bytes, names: yarpy.LocalNames
) -> None:
    """As a person with netcat does, who reads a while and says goodbye."""
    with yarpy.Port("/out", names=names) as out:
        with socket.create_connection(("127.0.0.1", out.contact.port)) as person:
            person.sendall(asks)
            assert out.wait_for_outputs(timeout=HANG)
            person.sendall(says)
            person.settimeout(HANG)
            person.recv(100)  # what it sends a reader when that comes
            assert len(out.outputs) == 1
        wait_until(lambda: not out.outputs)


def test_what_ends_is_counted_as_past_once(names: yarpy.LocalNames) -> None:
    with yarpy.Port("/out", names=names) as out, yarpy.Port("/in", names=names) as in_:
        out.connect("/in")
        out.write(1)
        assert in_.read(HANG).value == 1
        (link,) = out._hub.outputs.links
        out.disconnect("/in")
        assert not out._hub.outputs.drop(link)
        assert out.stats.past.outputs.messages == 1


def test_what_a_signal_handler_drops_meanwhile_stays_dropped(names: yarpy.LocalNames) -> None:
    """The lock lets the handler in: it runs above the frame that has it."""
    with (
        yarpy.Port("/out", names=names) as out,
        yarpy.Port("/a", names=names),
        yarpy.Port("/b", names=names),
    ):
        out.connect("/a")
        out.connect("/b")
        outputs = out._hub.outputs
        one, other = outputs.links
        file, handled = inspect.getfile(type(outputs)), False

        def handler(frame: FrameType, event: str, _: object) -> Any:
            """At the end of each generator there, as the one that leaves `one` out."""
            nonlocal handled
            if frame.f_code.co_filename != file or frame.f_code.co_name != "<genexpr>":
                return None
            if event == "return" and not handled:
                handled = True
                outputs.drop(other)
            return handler

        before = sys.gettrace()
        sys.settrace(handler)
        try:
            outputs.drop(one)
        finally:
            sys.settrace(before)
        assert handled
        assert outputs.links == ()
        one.close()
        other.close()
