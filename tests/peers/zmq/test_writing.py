"""Subscriptions decide what a PUB sends, and are limited; who only reads sends nothing."""

from __future__ import annotations

import pytest
from support.zmq_end import accepted, hear, written

from yarpy.data import codec
from yarpy.errors import RemoteProtocolError
from yarpy.limit import ZMQ_SUBSCRIPTIONS
from yarpy.peers.zmq import zmtp


@pytest.mark.parametrize("minor", [0, 1])
def test_subscriptions_decide_what_is_sent(minor: int) -> None:
    subscribe, cancel = (
        (lambda topic: zmtp.command(b"SUBSCRIBE", topic), lambda t: zmtp.command(b"CANCEL", t))
        if minor
        else (lambda topic: zmtp.frame(b"\1" + topic), lambda topic: zmtp.frame(b"\0" + topic))
    )
    end, carrier = accepted(b"SUB", minor=minor)
    assert written(end, carrier, [1]) == b""
    assert carrier.unwanted == 1
    hear(end, carrier, subscribe(b"/other") + subscribe(b"/port/and/more"))
    assert written(end, carrier, [1]) == b""
    hear(end, carrier, subscribe(b"/po") + subscribe(b""))
    assert written(end, carrier, [1]) == b"\1\5/port\0\3[1]"
    hear(end, carrier, cancel(b""))
    assert written(end, carrier, [1]) == b"\1\5/port\0\3[1]"
    hear(end, carrier, cancel(b"/po") + cancel(b"never"))
    assert written(end, carrier, [1]) == b""


def test_a_prefix_subscribed_to_twice_is_cancelled_twice() -> None:
    end, carrier = accepted(b"XSUB")
    hear(end, carrier, 2 * zmtp.frame(b"\1"))
    hear(end, carrier, zmtp.frame(b"\0"))
    assert written(end, carrier, 7) == b"\1\5/port\0\x017"
    hear(end, carrier, zmtp.frame(b"\0"))
    assert written(end, carrier, 7) == b""


def test_the_spelling_of_yarp_is_a_topic_of_its_own() -> None:
    end, carrier = accepted(b"SUB")
    binary = b"".join(codec.encode([1]))
    raw = b"".join(map(bytes, zmtp.encode([b"raw:/port", binary])))
    hear(end, carrier, zmtp.command(b"SUBSCRIBE", b"raw:"))
    assert written(end, carrier, [1]) == raw
    hear(end, carrier, zmtp.command(b"SUBSCRIBE", b""))
    assert written(end, carrier, [1]) == b"\1\5/port\0\3[1]" + raw


def test_subscriptions_are_limited() -> None:
    end, carrier = accepted(b"SUB")
    steps = carrier.listen(end.stream)
    assert steps is not None
    next(steps)
    with pytest.raises(RemoteProtocolError, match="subscriptions"):
        for number in range(ZMQ_SUBSCRIPTIONS + 1):
            end.stream.feed(zmtp.command(b"SUBSCRIBE", b"%d" % number))
            next(steps)
    end, carrier = accepted(b"SUB")
    for _ in range(3):  # what is given up makes room
        for number in range(40):
            hear(end, carrier, zmtp.command(b"SUBSCRIBE", b"%d" % number + bytes(1000)))
        for number in range(40):
            hear(end, carrier, zmtp.command(b"CANCEL", b"%d" % number + bytes(1000)))
    with pytest.raises(RemoteProtocolError, match="65536 bytes"):
        for number in range(80):
            hear(end, carrier, zmtp.command(b"SUBSCRIBE", b"%d" % number + bytes(1000)))
    end, carrier = accepted(b"SUB")
    with pytest.raises(RemoteProtocolError, match="limit"):
        hear(end, carrier, b"\2" + (5000).to_bytes(8, "big"))


def test_somebody_who_only_reads_sends_no_messages() -> None:
    end, carrier = accepted(b"PULL")
    with pytest.raises(RemoteProtocolError, match="only reads"):
        hear(end, carrier, b"\0\1x")
