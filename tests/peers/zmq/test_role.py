"""What every role does: PINGs, and peers that do not fit or send too much."""

from __future__ import annotations

import pytest
from support.zmq_end import accepted, hear

from yarpy.data.bottle import Bottle
from yarpy.errors import RemoteProtocolError
from yarpy.limit import ZMQ_FRAMES
from yarpy.peers.zmq import zmtp
from yarpy.peers.zmq.carrier import ROLES
from yarpy.route import Route
from yarpy.testing import End


@pytest.mark.parametrize("kind", [b"SUB", b"PULL"])
def test_readers_get_their_pings_answered(kind: bytes) -> None:
    end, carrier = accepted(kind)
    end.take()
    ping = zmtp.command(b"PING", b"\0\x0ahere")
    assert hear(end, carrier, ping * 2) == 2 * zmtp.command(b"PONG", b"here")


def test_writers_get_their_pings_answered() -> None:
    end, carrier = accepted(b"PUSH")
    end.take()
    end.begin(carrier.decode(end.stream))
    end.feed(b"\1\1a" + zmtp.command(b"PING", b"\0\0") + b"\0\1b")
    assert end.result.value == Bottle(["a", "b"])
    assert end.take() == zmtp.command(b"PONG")


@pytest.mark.parametrize(
    ("role", "kind", "advice"),
    [
        ("pub", b"REP", r"take zmq\+req"),
        ("sub", b"PULL", r"take zmq\+push"),
        ("req", b"PAIR", "PAIR"),
    ],
)
def test_a_socket_that_does_not_fit_is_named(role: str, kind: bytes, advice: str) -> None:
    end = End()
    carrier = ROLES[role](Route("/w", "/127.0.0.1:1/", f"zmq+{role}", 1))
    end.begin(carrier.greet(end.stream))
    with pytest.raises(RemoteProtocolError, match=advice):
        end.feed(zmtp.GREETING + zmtp.ready({"Socket-Type": kind}))


def test_more_frames_than_anybody_needs_are_refused() -> None:
    end, carrier = accepted(b"PUSH")
    end.begin(carrier.decode(end.stream))
    with pytest.raises(RemoteProtocolError, match="frames"):
        end.feed(b"\1\0" * (ZMQ_FRAMES + 1))


def test_frames_together_are_limited_as_one_message() -> None:
    end, carrier = accepted(b"PUSH")
    end.stream.limit = 1000
    end.begin(carrier.decode(end.stream))
    with pytest.raises(RemoteProtocolError, match="limit"):
        end.feed((b"\1\xff" + bytes(255)) * 5)
