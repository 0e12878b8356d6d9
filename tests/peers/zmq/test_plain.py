"""PLAIN: bytes as libzmq 4.3.5 takes and gives them, whole and one at a time."""

from __future__ import annotations

from typing import Any

import pytest
from support.steps import chop

from yarpy.errors import (
    AccessRefused,
    LinkClosed,
    LocalProtocolError,
    LoginRefused,
    RemoteProtocolError,
)
from yarpy.peers.zmq import plain, zmtp
from yarpy.route import parse_carrier
from yarpy.wire.effects import Claim
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream, run

GREETING = bytes.fromhex("ff00000000000000017f0301504c41494e") + bytes(47)
WELCOME = bytes.fromhex("040857454c434f4d45").replace(b"\x08W", b"\x08\x07W")
SERVER = GREETING[:32] + b"\1" + GREETING[33:]  # which says so
READY = zmtp.ready({"Socket-Type": b"PUB"})


@pytest.mark.parametrize("size", [1, 7, 1000])
def test_a_name_and_a_password_are_shown(size: int) -> None:
    assert zmtp.greeting(plain.MECHANISM) == GREETING
    stream = ByteStream()
    assert run(zmtp.read_greeting(stream, b"PLAIN", True), stream, chop(SERVER, size)) == 1
    steps = plain.log_in(stream, b"me", b"word", {"Socket-Type": b"SUB"})
    found = run(steps, stream, chop(WELCOME + READY, size))
    assert found == {"socket-type": b"PUB"}
    initiate = b"\x08INITIATE" + bytes.fromhex("0b") + b"Socket-Type\0\0\0\3SUB"
    said = plain.hello(b"me", b"word") + zmtp.frame(initiate, zmtp.COMMAND)
    assert b"".join(map(bytes, stream.output)) == said


@pytest.mark.parametrize(
    ("answer", "kind", "why"),
    [
        (zmtp.error("400"), LoginRefused, "another name or password"),
        (b"\4\x09\x5eRROR\x03400", LoginRefused, "another name or password"),
        (WELCOME + zmtp.error("400"), RemoteProtocolError, "400"),
        (WELCOME + zmtp.error("Access refused: no"), LoginRefused, "does not admit us"),
        (READY, RemoteProtocolError, "READY"),
        (b"\0\3abc", RemoteProtocolError, "answers HELLO"),
        (b"\4\0", RemoteProtocolError, "answers HELLO"),
        (b"\4\xff", LinkClosed, "closed|end|went"),
    ],
)
def test_other_answers(answer: bytes, kind: type[Exception], why: str) -> None:
    stream = ByteStream()
    with pytest.raises(kind, match=why):
        run(plain.log_in(stream, b"me", b"", {}), stream, [answer])


def test_both_sides_want_the_same() -> None:
    null = zmtp.GREETING
    for data, wanted, why in (
        (SERVER, b"NULL", "say \\+user.NAME"),
        (null, b"PLAIN", "leave \\+user"),
    ):
        stream = ByteStream()
        with pytest.raises(RemoteProtocolError, match=why):
            run(zmtp.read_greeting(stream, wanted, True), stream, [data])


def test_carrier_strings() -> None:
    assert plain.credentials(parse_carrier("zmq+sub")) is None
    assert plain.credentials(parse_carrier("zmq+sub+user.me")) == (b"me", b"")
    spec = parse_carrier("zmq+sub+user.me+password.a.b")
    assert plain.credentials(spec) == (b"me", b"a.b")
    for wrong, why in (("password.x", "needs a name"), (f"user.{'x' * 300}", "255 bytes")):
        with pytest.raises(LocalProtocolError, match=why):
            plain.credentials(parse_carrier(f"zmq+sub+{wrong}"))


INITIATE = zmtp.command(b"INITIATE", zmtp.properties_of({"Socket-Type": b"SUB"}))


def admitted(data: bytes, known: bool | None, size: int = 0) -> tuple[Any, str, bytes]:
    """What a port makes of a peer that dials it: the properties, what it claimed, the answer."""
    stream, claims = ByteStream(), []

    def answering() -> Steps[Any]:
        steps, answer = plain.admit(stream), None
        while True:
            try:
                effect = steps.send(answer)
            except StopIteration as end:
                return end.value
            answer = None
            if isinstance(effect, Claim):
                claims.append(effect.token)
                answer = known
            else:
                yield effect

    try:
        found: Any = run(answering(), stream, chop(data, size))
    except AccessRefused as error:
        found = str(error)
    return found, "".join(claims), b"".join(map(bytes, stream.output))


@pytest.mark.parametrize("size", [1, 7, 1000])
@pytest.mark.parametrize("known", [True, None])
def test_a_password_is_a_token(known: bool | None, size: int) -> None:
    found = admitted(plain.hello(b"me", b"a word") + INITIATE, known, size)
    assert found == ({"socket-type": b"SUB"}, "a word", WELCOME)


def test_another_password_is_refused() -> None:
    found, claimed, said = admitted(plain.hello(b"", b"") + INITIATE, False)
    assert "none of the tokens" in found
    assert (claimed, said) == ("", zmtp.error("400"))


@pytest.mark.parametrize(
    "data",
    [
        INITIATE,
        zmtp.command(b"HELLO"),
        zmtp.command(b"HELLO", b"\2me"),
        zmtp.command(b"HELLO", b"\2me\5word"),
        zmtp.command(b"HELLO", b"\2me\3word"),
        b"\0\6\5HELLO",
        plain.hello(b"me", b"x") + zmtp.ready({}),
        plain.hello(b"me", b"x") + INITIATE[:1] + b"\x0a" + INITIATE[2:12],
    ],
)
def test_bad_peers_that_dial(data: bytes) -> None:
    with pytest.raises(RemoteProtocolError):
        admitted(data, True)
