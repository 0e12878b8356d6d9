"""CURVE: against a server made of RFC 26's words; `interop/test_zmq_sockets.py` has libzmq's."""

from __future__ import annotations

from collections.abc import Generator
from typing import Any

import pytest
from nacl import bindings as nacl
from support.steps import chop

from yarpy.errors import LinkClosed, LocalProtocolError, LoginRefused, RemoteProtocolError
from yarpy.peers.zmq import curve, zmtp
from yarpy.route import parse_carrier
from yarpy.wire.stream import ByteStream, run

PUBLIC, SECRET = nacl.crypto_box_keypair()
OWN_PUBLIC, OWN_SECRET = nacl.crypto_box_keypair()
COOKIE = bytes(range(96))


class Server:
    """The other side of one connection: takes what a client says, and checks every part of it."""

    def __init__(self) -> None:
        self.public, self.secret = nacl.crypto_box_keypair()
        self.client = b""
        self.number = 0

    def welcome(self, hello: bytes) -> bytes:
        name, content = zmtp.parse_command(hello[2:])
        assert (hello[0], name, content[:2], content[2:74]) == (4, b"HELLO", b"\1\0", bytes(72))
        self.client = content[74:106]
        number, box = content[106:114], content[114:]
        assert number == (1).to_bytes(8, "big")
        clear = nacl.crypto_box_open(box, b"CurveZMQHELLO---" + number, self.client, SECRET)
        assert clear == bytes(64)
        nonce = bytes(16)
        box = nacl.crypto_box(self.public + COOKIE, b"WELCOME-" + nonce, self.client, SECRET)
        return zmtp.command(b"WELCOME", nonce + box)

    def ready(self, initiate: bytes, properties: bytes) -> tuple[bytes, bytes, bytes]:
        """The answer; the client's lasting key and its properties."""
        start = 9 if initiate[0] & zmtp.LONG else 2
        name, content = zmtp.parse_command(initiate[start:])
        assert (name, content[:96]) == (b"INITIATE", COOKIE)
        nonce = b"CurveZMQINITIATE" + content[96:104]
        clear = nacl.crypto_box_open(content[104:], nonce, self.client, self.secret)
        lasting, vouch = clear[:32], clear[32:128]
        opened = nacl.crypto_box_open(vouch[16:], b"VOUCH---" + vouch[:16], lasting, self.secret)
        assert opened == self.client + PUBLIC
        self.number += 1
        number = self.number.to_bytes(8, "big")
        box = nacl.crypto_box(properties, b"CurveZMQREADY---" + number, self.client, self.secret)
        return zmtp.command(b"READY", number + box), lasting, clear[128:]

    def message(self, flags: int, body: bytes) -> bytes:
        self.number += 1
        number = self.number.to_bytes(8, "big")
        nonce = b"CurveZMQMESSAGES" + number
        return (
            b"\7MESSAGE"
            + number
            + nacl.crypto_box(bytes((flags,)) + body, nonce, self.client, self.secret)
        )

    def read(self, body: bytes) -> tuple[int, bytes]:
        assert body[:8] == b"\7MESSAGE"
        nonce = b"CurveZMQMESSAGEC" + body[8:16]
        clear = nacl.crypto_box_open(body[16:], nonce, self.client, self.secret)
        return clear[0], clear[1:]


def taken(stream: ByteStream) -> bytes:
    """What was written."""
    return b"".join(map(bytes, stream.take_output()))


def advance(steps: Generator[Any, Any, Any], stream: ByteStream, data: bytes, size: int) -> Any:
    """Go on with these bytes, in pieces; the result once there is one."""
    for piece in chop(data, size):
        stream.feed(piece)
        try:
            next(steps)
        except StopIteration as end:
            return end.value
    return None


@pytest.mark.parametrize("size", [1, 7, 1000])
@pytest.mark.parametrize("secret", [None, OWN_SECRET], ids=["without a key", "with a key"])
def test_two_sides_agree(secret: bytes | None, size: int) -> None:
    sealed, server, stream = curve.Sealed(PUBLIC, secret), Server(), ByteStream()
    steps = sealed.log_in(stream, {"Socket-Type": b"SUB"})
    next(steps)
    assert advance(steps, stream, server.welcome(taken(stream)), size) is None
    said = zmtp.properties_of({"Socket-Type": b"PUB"})
    ready, lasting, properties = server.ready(taken(stream), said)
    assert (lasting == OWN_PUBLIC) is (secret is not None)
    assert zmtp.parse_properties(properties) == {"socket-type": b"SUB"}
    assert advance(steps, stream, ready, size) == {"socket-type": b"PUB"}
    # Messages and commands, short and long, both ways.
    large = bytes(3000)
    heard = ByteStream()
    sent = b"".join(map(bytes, sealed.encode([b"topic", large])))
    sent += sealed.command(b"SUBSCRIBE", b"x" * 300)
    heard.feed(sent)
    told = []
    while heard.waiting:
        flags, body = run(zmtp.read_frame(heard, 1 << 20), heard, [])
        assert not flags & ~zmtp.LONG
        told.append(server.read(bytes(body)))
    assert told == [(1, b"topic"), (0, large), (2, b"\x09SUBSCRIBE" + b"x" * 300)]
    for flags, body, found in (
        (1, b"a", (zmtp.MORE, b"a")),
        (0, b"", (0, b"")),
        (2, b"\4PING\0\0", (zmtp.COMMAND, b"\4PING\0\0")),
    ):
        assert sealed.open(0, server.message(flags, body)) == found


def agreed() -> tuple[curve.Sealed, Server]:
    """Two sides behind their greeting."""
    sealed, server, stream = curve.Sealed(PUBLIC), Server(), ByteStream()
    steps = sealed.log_in(stream, {})
    next(steps)
    advance(steps, stream, server.welcome(taken(stream)), 0)
    assert advance(steps, stream, server.ready(taken(stream), b"")[0], 0) == {}
    return sealed, server


def test_nothing_comes_twice_or_changed() -> None:
    sealed, server = agreed()
    first, second = server.message(0, b"one"), server.message(0, b"two")
    assert sealed.open(0, first) == (0, b"one")
    with pytest.raises(RemoteProtocolError, match="come before"):
        sealed.open(0, first)
    with pytest.raises(LoginRefused, match="has changed"):
        sealed.open(0, second[:-1] + bytes((second[-1] ^ 1,)))


@pytest.mark.parametrize(
    ("flags", "body", "why"),
    [
        (0, b"in clear", "in clear"),
        (zmtp.COMMAND, b"\7MESSAGE" + bytes(40), "in clear"),
        (zmtp.COMMAND, b"\5ERROR\3400", "ends the connection"),
        (0, b"\7MESSAGE" + bytes(5), "in clear"),
        (0, b"", "in clear"),
    ],
)
def test_other_frames(flags: int, body: bytes, why: str) -> None:
    with pytest.raises(RemoteProtocolError, match=why):
        agreed()[0].open(flags, body)


def test_a_command_has_no_more_frames() -> None:
    sealed, server = agreed()
    with pytest.raises(RemoteProtocolError, match="flags"):
        sealed.open(0, server.message(3, b"\4PING"))


@pytest.mark.parametrize(
    ("answer", "kind", "why"),
    [
        (zmtp.error("400"), LoginRefused, "does not take our key"),
        (zmtp.command(b"WELCOME", bytes(160)), LoginRefused, "has another key"),
        (zmtp.command(b"WELCOME", bytes(16)), RemoteProtocolError, "16 bytes instead of 160"),
        (zmtp.ready({}), RemoteProtocolError, "instead of WELCOME"),
        (b"\0\3abc", RemoteProtocolError, "instead of WELCOME"),
        (b"", LinkClosed, "hangs up"),
        (b"\4\xff", LinkClosed, "hangs up"),
    ],
)
def test_other_answers(answer: bytes, kind: type[Exception], why: str) -> None:
    stream = ByteStream()
    with pytest.raises(kind, match=why):
        run(curve.Sealed(PUBLIC).log_in(stream, {}), stream, [answer])


def test_a_server_that_does_not_know_us() -> None:
    sealed, server, stream = curve.Sealed(PUBLIC), Server(), ByteStream()
    steps = sealed.log_in(stream, {})
    next(steps)
    advance(steps, stream, server.welcome(taken(stream)), 0)
    stream.feed(zmtp.error("400"))
    with pytest.raises(LoginRefused, match="does not take our key"):
        next(steps)


def test_carrier_strings(monkeypatch: pytest.MonkeyPatch) -> None:
    key = PUBLIC.hex()
    assert curve.keys_of(parse_carrier("zmq+sub")) is None
    assert curve.keys_of(parse_carrier("zmq+sub+user.me+password.x")) is None
    assert curve.keys_of(parse_carrier(f"zmq+sub+curve.{key}")) == (PUBLIC, None)
    spec = parse_carrier(f"zmq+sub+curve.{key}+password.{OWN_SECRET.hex()}")
    assert curve.keys_of(spec) == (PUBLIC, OWN_SECRET)
    assert OWN_SECRET.hex() not in spec.text
    for wrong, why in (
        ("curve", "needs the server's public key"),
        ("curve.abc", r"z85.decode\(key\).hex\(\)"),
        (f"curve.{key[:-2]}", "64 hexadecimal"),
        (f"curve.{key}+password.x", r"\+password.KEY takes a key"),
        (f"curve.{key}+user.me", "say one"),
    ):
        with pytest.raises(LocalProtocolError, match=why):
            curve.keys_of(parse_carrier(f"zmq+sub+{wrong}"))
    monkeypatch.setitem(__import__("sys").modules, "nacl", None)
    with pytest.raises(LocalProtocolError, match=r"yarpy\[zmq\]"):
        curve.keys_of(parse_carrier(f"zmq+sub+curve.{key}"))


def test_a_peer_with_a_key_says_what_it_needs() -> None:
    greeting = zmtp.greeting(curve.MECHANISM)
    assert greeting[12:32] == b"CURVE".ljust(20, b"\0")
    stream = ByteStream()
    with pytest.raises(RemoteProtocolError, match=r"say \+curve.KEY"):
        run(zmtp.read_greeting(stream, b"NULL", True), stream, [greeting])
