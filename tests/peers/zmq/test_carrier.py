"""zmq: the conformance suite for each role, what a port becomes, and who is refused."""

from __future__ import annotations

from typing import Any

import pytest
from support.wait import wait_until
from support.zmq_end import accepted

from yarpy.carriers.payload import payload_of, value_of
from yarpy.data import codec
from yarpy.errors import LocalProtocolError, RemoteProtocolError
from yarpy.peers.zmq import zmtp
from yarpy.peers.zmq.carrier import ROLES, Pub, Pull, Push, Rep, Req, Sub, Zmq
from yarpy.peers.zmq.role import Role
from yarpy.route import Route, parse_carrier
from yarpy.testing import CarrierConformance, End


class _Zmq(CarrierConformance):
    """A role of the carrier, which the other side answers with the one that fits."""

    carries_envelopes = False

    def test_its_own_greeting_is_recognised(self) -> None:
        talk = self._greeted()
        assert isinstance(talk.accepting, Role)

    def expected(self, value: Any) -> Any:
        return codec.decode(b"".join(codec.encode(value_of(payload_of(value)))))


class TestPush(_Zmq):
    carrier = Push
    modifiers = "+push"


class TestRawPush(_Zmq):
    carrier = Push
    modifiers = "+push+raw"

    def expected(self, value: Any) -> Any:
        return codec.decode(b"".join(bytes(block) for block in codec.encode(value)))


class TestPull(_Zmq):
    carrier = Pull
    modifiers = "+pull"


class TestReq(_Zmq):
    carrier = Req
    modifiers = "+req"


class TestSub(_Zmq):
    carrier = Sub
    modifiers = "+sub"

    def _connect(self, names: Any, sender: Any, receiver: Any) -> None:
        super()._connect(names, sender, receiver)
        (link,) = sender._hub.outputs.links
        wait_until(lambda: link.carrier._wanted)  # who comes late misses the first messages


@pytest.mark.parametrize(
    ("kind", "role", "push", "carrier"),
    [
        (b"SUB", Pub, False, "zmq+sub"),
        (b"XSUB", Pub, False, "zmq+sub"),
        (b"PULL", Push, False, "zmq+pull"),
        (b"REP", Req, False, "zmq+rep"),
        (b"ROUTER", Req, False, "zmq+rep"),
        (b"PUB", Sub, True, "zmq+pub"),
        (b"XPUB", Sub, True, "zmq+pub"),
        (b"PUSH", Pull, True, "zmq+push"),
        (b"REQ", Rep, True, "zmq+req"),
        (b"DEALER", Rep, True, "zmq+req"),
    ],
)
@pytest.mark.parametrize("piece", [0, 1])
def test_a_port_becomes_what_fits(
    kind: bytes, role: type[Role], push: bool, carrier: str, piece: int
) -> None:
    end, found = accepted(kind, piece)
    assert type(found) is role
    assert found.push == push
    assert found.route.carrier == carrier
    assert found.route.source == "zmq"
    said = end.take()
    assert said.startswith(b"\4")
    assert b"Socket-Type" in said
    assert role.role.upper().encode() in said


@pytest.mark.parametrize("kind", [b"PAIR", b"CLIENT", b"RADIO", b"", b"\x1b[2J", b"X" * 300])
def test_sockets_that_fit_nothing_are_told(kind: bytes) -> None:
    end = End()
    carrier = Zmq(Route("", "/port", "zmq", 10002))
    end.begin(carrier.welcome(end.stream, b""))
    with pytest.raises(RemoteProtocolError, match="take SUB"):
        end.feed(zmtp.GREETING + zmtp.ready({"Socket-Type": kind}))
    said = end.take().removeprefix(zmtp.GREETING)
    assert b"ERROR" in said
    assert b"\x1b" not in said


@pytest.mark.parametrize("claim", [b"/x (push)", b"/x (sub) (pub)", b"/x\n"])
def test_a_port_that_says_that_it_is_something_else_is_refused(claim: bytes) -> None:
    end = End()
    carrier = Zmq(Route("", "/port", "zmq", 10002))
    end.begin(carrier.welcome(end.stream, b""))
    with pytest.raises(RemoteProtocolError):
        end.feed(zmtp.GREETING + zmtp.ready({"Socket-Type": b"SUB", "X-Yarp-Port": claim}))


def test_a_carrier_string_says_what_we_are() -> None:
    for role, kind in ROLES.items():
        assert Zmq.of(parse_carrier(f"zmq+{role}.topic+raw")) is kind
    for text in ("zmq", "zmq+push+pull", "zmq+raw"):
        with pytest.raises(LocalProtocolError, match=r"zmq\+pub"):
            Zmq.of(parse_carrier(text))
