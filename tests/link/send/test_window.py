"""The window: how far a sender may be ahead of acknowledgements."""

from __future__ import annotations

import threading
import time

import pytest
from support.outbound import connected, open_link, read_messages
from support.wait import HANG

from yarpy.carriers.base import Limits
from yarpy.carriers.own.tcp import Tcp
from yarpy.link.ending import moment
from yarpy.link.send import window
from yarpy.wire import framing
from yarpy.wire.message import Packet

ACK = framing.ACK
WINDOW = Limits().ahead


def test_acknowledgements_are_read_late_but_within_a_window() -> None:
    with connected() as (link, far):
        done = threading.Event()

        def flood() -> None:
            for number in range(2 * WINDOW):
                link.send(Packet([number]))
            done.set()

        threading.Thread(target=flood, daemon=True).start()
        read_messages(far, 10, ack=False)
        assert not done.wait(0.1), "a sender runs ahead of a reader that does not acknowledge"
        assert link.sender.window.open <= WINDOW
        far.sendall(ACK * 10)
        read_messages(far, 2 * WINDOW - 10)
        assert done.wait(HANG)
        assert link.wait_acknowledged(moment(5))
        assert link.sender.window.open == 0


def test_slow_reader_holds_its_sender_up(monkeypatch: pytest.MonkeyPatch) -> None:
    """After some milliseconds without an acknowledgement a send waits, as it does in C++."""
    monkeypatch.setattr(window, "WINDOW_SECONDS", 0.0)
    with connected() as (link, far):
        link.send(Packet([1]))
        acknowledged = threading.Event()

        def acknowledge() -> None:
            acknowledged.set()
            far.sendall(ACK)

        threading.Timer(0.05, acknowledge).start()
        link.send(Packet([2]))
        assert acknowledged.is_set()
        assert link.sender.window.open == 1


def test_waiting_for_acknowledgements_has_its_limit_and_loses_none() -> None:
    """Also for one that has come in part."""
    with connected() as (link, far):
        for number in range(2):
            link.send(Packet([number]))
        far.sendall(ACK + ACK[:5])
        for deadline in (0.0, time.monotonic(), time.monotonic() + 0.05):
            assert not link.sender.window.collect(wait=True, all_=True, until=deadline)
        assert link.sender.window.open == 1
        threading.Timer(0.1, far.sendall, (ACK[5:],)).start()
        assert link.sender.window.collect(wait=True, all_=True)  # for ever: no limit is left behind
        assert link.sender.window.open == 0


def test_what_is_there_is_taken_in_without_waiting() -> None:
    link, transport = open_link(Tcp, ACK * 2)
    for number in range(3):
        link.send(Packet([number]))
    link.sender.window.collect(wait=False)
    assert link.sender.window.open == 1
    assert not link.sender.window.free(0.0)
    transport.incoming.append(ACK)
    link.sender.window.collect(wait=False)
    assert link.sender.window.free(0.0)


def test_an_acknowledgement_whose_end_a_signal_handler_reads_counts_once() -> None:
    """As where it closes the port in the middle of a write that waits."""
    link, _ = open_link(Tcp, ACK)
    for number in range(3):
        link.send(Packet([number]))
    found = link.sender.window

    class ReadMeanwhile:
        def __iter__(self) -> ReadMeanwhile:
            return self

        def __next__(self) -> None:
            if found._steps is self:  # the handler's own look
                found._steps = None
                found.open -= 1
            raise StopIteration

    found._steps = ReadMeanwhile()
    found.collect(wait=False)
    assert found.open == 1 and found._steps is None
