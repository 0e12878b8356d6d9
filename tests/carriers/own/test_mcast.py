"""mcast: the group is told after the name, and everything else is udp."""

from __future__ import annotations

import pytest
from support.capture import load_capture
from support.steps import chop
from support.system import NO_GROUPS

from yarpy.carriers.own.mcast import Mcast
from yarpy.errors import RemoteProtocolError
from yarpy.route import Route
from yarpy.testing import CarrierConformance, Dialogue, End
from yarpy.testing.drive import GROUP


class TestMcast(CarrierConformance):
    carrier = Mcast
    missing = NO_GROUPS


def test_golden_greeting() -> None:
    """Our made-up group is the recorded one: 224.1.1.3:21604."""
    data = load_capture("conn_mcast_stream_envelope").steps[0].data
    end = End()
    end.begin(Mcast(Route("/cap/out", "/cap/in", "mcast")).greet(end.stream))
    assert end.done
    assert end.take() == data


@pytest.mark.parametrize("piece", [0, 1])
def test_golden_greeting_is_welcomed_in_silence(piece: int) -> None:
    data = load_capture("conn_mcast_stream_envelope").steps[0].data
    end = End()
    carrier = Mcast(Route("", "/cap/in", "mcast"))
    end.begin(carrier.welcome(end.stream, data[:8]))
    for part in chop(data[8:], piece):
        end.feed(part)
    assert end.done
    assert end.take() == b""
    (opened,) = end.opened
    assert (opened.kind, opened.listen, opened.group, opened.port) == ("mcast", True, *GROUP)


@pytest.mark.parametrize("first", [0, 10, 127, 192, 223, 240, 255])
def test_address_outside_multicast_is_refused(first: int) -> None:
    end = End()
    end.begin(Mcast(Route("", "/b", "mcast")).welcome(end.stream, b"YAb\x1e\0\0RP"))
    with pytest.raises(RemoteProtocolError, match="multicast"):
        end.feed(b"\x03\0\0\0/a\0" + bytes((first, 0, 0, 1)) + b"\x20\x00")


def test_one_send_reaches_all() -> None:
    assert Mcast.delivery.broadcast
    assert Mcast.delivery.connectionless
    talk = Dialogue(Mcast)
    talk.greet()
    assert talk.send([1]).value == [1]
    assert talk.quit() is None
