"""Messages one at a time, and what a monitor is told of them."""

from __future__ import annotations

import socket
import time
from collections.abc import Callable

import pytest
from support.outbound import connected, open_link, read_messages
from support.system import NO_TAKEN
from support.wait import wait_until

from yarpy.carriers.base import Carrier
from yarpy.carriers.own.tcp import FastTcp, Tcp
from yarpy.carriers.own.udp import Udp
from yarpy.errors import LocalProtocolError
from yarpy.link.send import slow_reader
from yarpy.link.send.followed import Followed
from yarpy.link.send.slow_reader import SlowReader
from yarpy.monitors.base import Taken
from yarpy.monitors.chain import Chain
from yarpy.qos import Qos
from yarpy.wire import framing
from yarpy.wire.message import Packet

SIZE = len(b"".join(framing.encode(Packet([0]))))  # type: ignore[arg-type]


class Watcher:
    """Notes what it is told."""

    def __init__(self) -> None:
        self.taken: list[Taken] = []
        self.under_way: Callable[[], int] = lambda: -1

    def watch(self, under_way: Callable[[], int]) -> None:
        self.under_way = under_way

    def confirmed(self, taken: Taken) -> None:
        self.taken.append(taken)


def test_a_message_is_confirmed_when_the_reader_has_acknowledged_it() -> None:
    with connected(Tcp) as (link, far):
        watcher = Watcher()
        link.ride(Chain([watcher], "here"))
        assert watcher.under_way() == 0
        link.send(Packet([1]))
        assert [far.recv(SIZE, socket.MSG_WAITALL)] and watcher.under_way() == 1
        link.send(Packet([2]))
        assert watcher.under_way() == 2
        assert watcher.taken == []
        far.sendall(framing.ACK)
        wait_until(lambda: watcher.taken)
        read_messages(far, 1)
        wait_until(lambda: watcher.under_way() == 0)
        assert [one.size for one in watcher.taken] == [SIZE, SIZE]
        assert all(one.seconds > 0 for one in watcher.taken)
        assert link.sender.window.open == 0


@pytest.mark.skipif(bool(NO_TAKEN), reason=NO_TAKEN)
def test_where_nobody_acknowledges_the_system_confirms() -> None:
    with connected(FastTcp) as (link, far):
        watcher = Watcher()
        link.ride(Chain([watcher], "here"))
        for number in range(3):
            link.send(Packet([number]))
        read_messages(far, 3, ack=False)
        wait_until(lambda: len(watcher.taken) == 3)


@pytest.mark.parametrize(
    "kind",
    [Tcp, pytest.param(FastTcp, marks=pytest.mark.skipif(bool(NO_TAKEN), reason=NO_TAKEN))],
)
def test_a_reader_that_goes_away(kind: type[Carrier]) -> None:
    with connected(kind) as (link, far):
        link.ride(Chain([Watcher()], "here"))
        link.send(Packet(["x" * 5_000_000]))
        far.close()
        wait_until(lambda: link.ended() or link.broken)
        wait_until(lambda: link.thread is None or not link.thread.is_alive())


def test_a_reader_that_never_acknowledges_and_was_not_invited(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("yarpy.link.send.followed._AT_A_TIME", 0.02)
    assert slow_reader.STRANGERS > 1
    with connected(Tcp) as (link, _):
        link.sender.slow = SlowReader(link.route, 0.1)
        link.ride(Chain([Watcher()], "here"))
        link.send(Packet([1]))
        wait_until(lambda: link.broken)
        assert "did not take a message" in link.reason


def test_what_is_too_late_is_not_sent_and_not_confirmed() -> None:
    with connected(Tcp) as (link, far):
        watcher = Watcher()
        began = time.monotonic()
        link.ride(Chain([watcher], "here"))
        link.expect(Qos(deadline=0.05, late="drop"))
        link.send(Packet([1]))
        link.send(Packet([2]))  # waits for the first one for too long
        wait_until(lambda: time.monotonic() > began + 0.1)
        read_messages(far, 1)
        wait_until(lambda: watcher.under_way() == 0)
        assert len(watcher.taken) == 1
        assert link.late == 1


def test_a_carrier_that_confirms_nothing_is_refused() -> None:
    link, _ = open_link(Udp)
    with pytest.raises(LocalProtocolError, match="connect with tcp"):
        Followed(link.sender, Chain([Watcher()], "here"))
    link, _ = open_link(FastTcp)  # whose transport here knows nothing
    with pytest.raises(LocalProtocolError, match="nothing confirms"):
        link.ride(Chain([Watcher()], "here"))


def test_a_watcher_that_fails_is_told_of_and_the_connection_goes_on(
    caplog: pytest.LogCaptureFixture,
) -> None:
    class Bad:
        def confirmed(self, taken: Taken) -> None:
            raise RuntimeError("oh")

    with connected(Tcp) as (link, far):
        link.ride(Chain([Bad()], "here"))
        for number in range(2):
            link.send(Packet([number]))
            read_messages(far, 1)
    assert "RuntimeError: oh" in caplog.text
