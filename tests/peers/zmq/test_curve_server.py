"""CURVE of a port that is dialled: against the side that dials, which `test_curve.py` compares with
RFC 26; `interop/test_zmq_sockets.py` has libzmq's."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pytest
from nacl import bindings as nacl
from support.steps import chop

from yarpy.errors import (
    AccessRefused,
    LocalProtocolError,
    LoginRefused,
    RemoteProtocolError,
)
from yarpy.peers.zmq import curve, curve_server, zmtp
from yarpy.wire.effects import Claim
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream

PUBLIC, SECRET = nacl.crypto_box_keypair()
OWN_PUBLIC, OWN_SECRET = nacl.crypto_box_keypair()


class Admitting:
    """A port that lets somebody in, and what it did."""

    def __init__(self, known: bool | None = None) -> None:
        self.server = curve_server.Server(SECRET)
        self.stream = ByteStream()
        self.claims: list[Claim] = []
        self.properties: dict[str, bytes] | None = None
        self._steps = self._answered(known)
        next(self._steps)

    def _answered(self, known: bool | None) -> Steps[None]:
        steps, answer = self.server.admit(self.stream), None
        while self.properties is None:
            try:
                effect = steps.send(answer)
            except StopIteration as end:
                self.properties = end.value
                return
            answer = None
            if isinstance(effect, Claim):
                self.claims.append(effect)
                answer = known
            else:
                yield effect

    def feed(self, data: bytes, size: int = 0) -> bytes:
        """Go on with these bytes, in pieces; what it says to that."""
        for piece in chop(data, size):
            self.stream.feed(piece)
            next(self._steps, None)
        return taken(self.stream)


def taken(stream: ByteStream) -> bytes:
    return b"".join(map(bytes, stream.take_output()))


def content(command: bytes) -> bytes:
    """What a command says behind its name."""
    start = 9 if command[0] & zmtp.LONG else 2
    return zmtp.parse_command(command[start:])[1]


SAID = {"Socket-Type": b"SUB"}


@pytest.mark.parametrize("size", [1, 7, 1000])
@pytest.mark.parametrize("known", [True, None])
def test_two_sides_agree(known: bool | None, size: int) -> None:
    client, port = curve.Sealed(PUBLIC, OWN_SECRET), Admitting(known)
    welcome = port.feed(client.hello(), size)
    assert port.properties is None
    said = zmtp.properties_of(SAID)
    assert port.feed(client.initiate(content(welcome), said), size) == b""
    assert port.properties == {"socket-type": b"SUB"}
    assert port.claims == [Claim(OWN_PUBLIC.hex(), public_key=True)]
    ready = port.server.ready_of({"Socket-Type": b"PUB"})
    assert client.ready(content(ready)) == {"socket-type": b"PUB"}
    for one, other in ((client, port.server), (port.server, client)):
        for body in (b"", b"topic", bytes(3000)):
            sealed = b"".join(map(bytes, one.encode([body])))
            start = 9 if sealed[0] & zmtp.LONG else 2
            assert not body or body not in sealed
            assert other.open(0, sealed[start:]) == (0, body)
        with pytest.raises(RemoteProtocolError, match="come before"):
            other.open(0, sealed[start:])


def test_a_key_that_is_not_known_is_refused() -> None:
    client, port = curve.Sealed(PUBLIC, OWN_SECRET), Admitting(False)
    welcome = port.feed(client.hello())
    with pytest.raises(AccessRefused, match=f"{OWN_PUBLIC.hex()}.*curve ="):
        port.feed(client.initiate(content(welcome), b""))
    assert taken(port.stream) == zmtp.error("400")


def test_a_peer_with_another_key_of_the_port_is_refused() -> None:
    with pytest.raises(LoginRefused, match="CURVE_SERVERKEY"):
        Admitting().feed(curve.Sealed(OWN_PUBLIC).hello())


def test_nobody_shows_the_key_of_somebody_else() -> None:
    """The vouch says for which connection a key was shown."""
    client, port = curve.Sealed(PUBLIC, OWN_SECRET), Admitting(True)
    seen = content(port.feed(client.hello()))
    thief = curve.Sealed(PUBLIC, OWN_SECRET)
    thief._brief_public, thief._number = nacl.crypto_box_keypair()[0], 1
    thief._brief = client._brief
    with pytest.raises(AccessRefused, match="does not belong"):
        port.feed(thief.initiate(seen, b""))
    assert not port.claims


@pytest.mark.parametrize(
    ("data", "why"),
    [
        (zmtp.command(b"HELLO", bytes(194)), "HELLO of CURVE"),
        (zmtp.command(b"HELLO", b"\1" + bytes(100)), "101 bytes instead of 194"),
        (zmtp.command(b"HELLO", b"\1" + bytes(193)), "come before"),
        (zmtp.command(b"INITIATE", bytes(300)), "does not say HELLO"),
        (zmtp.ready({}), "does not say HELLO"),
        (b"\0\6\5HELLO", "does not say HELLO"),
    ],
)
def test_bad_beginnings(data: bytes, why: str) -> None:
    with pytest.raises(RemoteProtocolError, match=why):
        Admitting().feed(data)


@pytest.mark.parametrize("change", ["cookie", "number", "box", "short", "twice"])
def test_bad_initiates(change: str) -> None:
    client, port = curve.Sealed(PUBLIC, OWN_SECRET), Admitting(True)
    hello = client.hello()
    told = bytearray(content(client.initiate(content(port.feed(hello)), b"")))
    kind: Any = RemoteProtocolError
    if change == "cookie":
        told[0] ^= 1
    elif change == "number":
        told[96:104] = bytes(8)
    elif change == "box":
        told[-1] ^= 1
        kind = LoginRefused
    elif change == "short":
        del told[200:]
    command = hello if change == "twice" else zmtp.command(b"INITIATE", bytes(told))
    with pytest.raises(kind):
        port.feed(command)
    assert not port.claims


def test_the_key_of_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    found: list[Path | None] = [None]
    monkeypatch.setattr(curve_server, "find_file", lambda name: found[0])
    with pytest.raises(RemoteProtocolError, match=r"no curve\.key beside"):
        curve_server.own_key()
    for name, text in (("good", SECRET.hex() + "\n"), ("short", "abc"), ("strange", "\xe9")):
        (tmp_path / name).write_bytes(text.encode("latin-1"))
        (tmp_path / name).chmod(0o600)
    found[0] = tmp_path / "good"
    assert curve_server.own_key() == SECRET
    for name, why in (("short", "64 hexadecimal"), ("strange", "cannot be read")):
        found[0] = tmp_path / name
        with pytest.raises(LocalProtocolError, match=why):
            curve_server.own_key()
    found[0] = tmp_path / "none"
    with pytest.raises(LocalProtocolError, match="cannot be read"):
        curve_server.own_key()


@pytest.mark.skipif(os.name != "posix", reason="files have no such rights there")
@pytest.mark.parametrize("rights", [0o640, 0o604, 0o666])
def test_a_key_that_others_may_read_is_refused(
    rights: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "curve.key"
    file.write_text(SECRET.hex())
    file.chmod(rights)
    monkeypatch.setattr(curve_server, "find_file", lambda name: file)
    with pytest.raises(LocalProtocolError, match=r"others may read it: chmod 600 .*curve\.key"):
        curve_server.own_key()
    file.chmod(0o400)
    assert curve_server.own_key() == SECRET
