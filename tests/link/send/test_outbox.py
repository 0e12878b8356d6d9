"""What becomes of a message: each outbox counts it once, and says what is left to do."""

from __future__ import annotations

import pytest
from support.outbound import connected, open_link

from yarpy.carriers.own.tcp import FastTcp, Tcp
from yarpy.errors import PortClosed
from yarpy.link.ending import NEVER, Ending
from yarpy.link.send.dated import Dated
from yarpy.link.send.direct import Direct
from yarpy.link.send.lossy import Lossy
from yarpy.link.send.queued import Queued
from yarpy.monitors.chain import Chain
from yarpy.qos import Qos
from yarpy.wire.message import Packet

LARGE = ["x" * 20_000_000]


class Dropping:
    """A monitor that lets nothing pass."""

    def accept(self, message: object) -> bool:
        return False


def test_which_one_a_connection_has() -> None:
    link, _ = open_link(FastTcp)
    assert type(link.box) is Direct and link.box is link.reliable
    link.join(NEVER, newest=True)
    assert type(link.box) is Lossy and type(link.reliable) is Direct
    link.expect(Qos(deadline=1.0, late="drop"))
    assert type(link.box) is Dated and type(link.reliable) is Dated
    link.expect(Qos(deadline=0))
    link.join(NEVER, newest=False)
    link.start_background()
    assert type(link.box) is Queued
    link.close()


@pytest.mark.parametrize("newest", [False, True])
def test_a_monitor_drops(newest: bool) -> None:
    link, transport = open_link(FastTcp)
    link.ride(Chain([Dropping()], "here"))
    link.join(NEVER, newest)
    assert link.box.offer(Packet([1])) is False
    assert (link.counter.drops, link.counter.replaced) == (1, 0)
    assert transport.said == b""


@pytest.mark.parametrize("kind", [Direct, Queued])
def test_a_port_that_ends_lets_nobody_wait(kind: type) -> None:
    with connected(Tcp) as (link, _):
        ending = Ending()
        link.join(ending, newest=False)
        if kind is Queued:
            link.start_background()
        assert type(link.box) is kind
        ending.begin("it is over")
        with pytest.raises(PortClosed, match="it is over"):
            for _ in range(10):
                link.box.offer(Packet(LARGE))
        ending.resume()
