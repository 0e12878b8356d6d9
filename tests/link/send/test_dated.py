"""Messages with a deadline."""

from __future__ import annotations

import time

from support.outbound import open_link

from yarpy.carriers.own.tcp import FastTcp
from yarpy.qos import Qos
from yarpy.wire.message import Packet


def test_a_late_message_is_not_sent() -> None:
    link, transport = open_link(FastTcp)
    link.expect(Qos(deadline=5.0, late="drop"))
    assert link.box.offer(Packet([1], f"1 {time.time() - 10:f}".encode())) is False
    assert (link.late, link.counter.drops, transport.said) == (1, 1, b"")
    assert link.box.offer(Packet([1])) is True
