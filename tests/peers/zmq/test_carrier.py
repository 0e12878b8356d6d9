"""zmq: what libzmq was recorded to say, each pair of sockets, the conformance suite, bad peers."""

from __future__ import annotations

from typing import Any

import pytest
from support.wait import wait_until

from yarpy.carriers.base import Carrier
from yarpy.carriers.payload import payload_of, value_of
from yarpy.data import codec
from yarpy.data.bottle import Bottle
from yarpy.errors import LocalProtocolError, RemoteProtocolError
from yarpy.limit import ZMQ_FRAMES, ZMQ_SUBSCRIPTIONS
from yarpy.peers.zmq import zmtp
from yarpy.peers.zmq.carrier import ROLES, Pub, Pull, Push, Rep, Req, Sub, Zmq
from yarpy.route import Route, parse_carrier
from yarpy.testing import CarrierConformance, End
from yarpy.wire.message import CALL, DATA, Message, Packet


class _Zmq(CarrierConformance):
    """A role of the carrier, which the other side answers with the one that fits."""

    carries_envelopes = False

    def test_its_own_greeting_is_recognised(self) -> None:
        talk = self._greeted()
        assert isinstance(talk.accepting, Zmq)

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


# ------------------------------------------------------------------- a socket of libzmq dials us


def accepted(kind: bytes, piece: int = 0, minor: int = 1) -> tuple[End, Carrier]:
    """The port's side of a connection that a socket has dialled, and what the port is there."""
    end = End(piece)
    found: list[Carrier] = []

    def steps() -> Any:
        first = bytes((yield from end.stream.read_exact(8)))
        carrier: Carrier = Zmq(Route("", "/port", "zmq", 10002))
        while (other := (yield from carrier.welcome(end.stream, first))) is not None:
            carrier = other
        found.append(carrier)

    end.begin(steps())
    greeting = bytearray(zmtp.GREETING)
    greeting[11] = minor
    end.feed(bytes(greeting[:11]))
    assert end.take() == zmtp.OPENING  # libzmq waits for that
    end.feed(bytes(greeting[11:]))
    assert zmtp.OPENING + end.take() == zmtp.GREETING
    end.feed(zmtp.ready({"Socket-Type": kind}))
    assert end.done
    return end, found[0]


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
    kind: bytes, role: type[Zmq], push: bool, carrier: str, piece: int
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


def hear(end: End, carrier: Carrier, data: bytes) -> bytes:
    """What is answered when a reader says `data`."""
    steps = carrier.listen(end.stream)
    assert steps is not None
    next(steps)
    end.stream.feed(data)
    next(steps)
    return end.take()


def written(end: End, carrier: Carrier, value: Any) -> bytes:
    end.take()
    carrier.encode(end.stream, Packet(value))
    return end.take()


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


def read(end: End, carrier: Carrier, data: bytes) -> Message:
    end.begin(carrier.decode(end.stream))
    end.feed(data)
    assert end.done
    message: Message = end.result
    return message


def test_what_a_pub_sends_has_a_topic_in_front() -> None:
    end, carrier = accepted(b"PUB")
    assert end.take().endswith(zmtp.command(b"SUBSCRIBE"))
    assert read(end, carrier, b"\1\3cam\0\3[1]").value == Bottle([1])
    assert read(end, carrier, b"\0\5alone").value == "alone"
    assert read(end, carrier, b"\1\3cam\1\x011\0\x012").value == Bottle([1, 2])
    end, carrier = accepted(b"PUB", minor=0)
    assert end.take().endswith(b"\0\1\1")


def test_yarps_own_spelling_comes_in() -> None:
    end, carrier = accepted(b"PUSH")
    body = b"".join(codec.encode([1, "two"]))
    data = b"".join(map(bytes, zmtp.encode([b"raw:", body])))
    message = read(end, carrier, data)
    assert (message.key, message.value) == (DATA, Bottle([1, "two"]))


@pytest.mark.parametrize(
    ("kind", "question", "answer"),
    [
        (b"REQ", b"\1\0\0\3[1]", b'\1\0\0\4"ok"'),
        (b"DEALER", b"\1\2id\1\0\0\3[1]", b'\1\2id\1\0\0\4"ok"'),
        (b"DEALER", b"\0\3[1]", b'\0\4"ok"'),
    ],
)
def test_questions_are_answered_on_the_way_that_they_came(
    kind: bytes, question: bytes, answer: bytes
) -> None:
    end, carrier = accepted(kind)
    for _ in range(2):
        end.take()
        message = read(end, carrier, question)
        assert (message.key, message.value) == (CALL, Bottle([1]))
        carrier.encode_reply(end.stream, "ok")
        assert end.take() == answer


# ----------------------------------------------------------------------------------- bad peers


@pytest.mark.parametrize("kind", [b"PAIR", b"STREAM", b"", b"\x1b[2J", b"X" * 300])
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
