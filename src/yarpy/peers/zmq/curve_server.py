"""CURVE of a port that is dialled: it has the key of the file `curve.key`.

Rules: the messages are those of `curve`. The file has the secret key in 64 hexadecimal digits, lies
where `yarp.conf` does, and is read once; one that others of this computer may read is refused. The
public key of the side that dials is claimed once it has proven that it has the secret one: where
`access.toml` names public keys it has to be one of them; where it names none all keys are taken, as
by libzmq, and the rules are for the address.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Final

from yarpy.config.resource import find_file
from yarpy.errors import AccessRefused, LocalProtocolError, LoginRefused, RemoteProtocolError
from yarpy.limit import ZMQ_COMMAND
from yarpy.peers.zmq import curve, zmtp
from yarpy.wire.effects import Claim
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream

FILE: Final = "curve.key"
_OTHERS: Final = 0o077  # rights of the group and of everybody else
_COOKIE: Final = 96  # bytes, by which a server knows a WELCOME of its own again
_HELLO: Final = 194  # bytes of its content
_INITIATE: Final = _COOKIE + 8 + 16 + 128  # and as many as the properties have


def own_key() -> bytes:
    """Return the secret key of the ports of this program. Raises RemoteProtocolError where there is
    none, LocalProtocolError where it cannot be read."""
    path = find_file(FILE)
    if path is None:
        raise RemoteProtocolError(
            f"the peer wants the security mechanism CURVE, and there is no {FILE} beside "
            "yarp.conf: put a secret key there, in 64 hexadecimal digits"
        )
    return _read(path)


@lru_cache(maxsize=8)
def _read(path: Path) -> bytes:
    try:
        others = path.stat().st_mode & _OTHERS if os.name == "posix" else 0
        text = path.read_text("ascii").strip()
    except (OSError, UnicodeDecodeError) as error:
        raise LocalProtocolError(f"{path} cannot be read: {error}") from error
    if others:
        raise LocalProtocolError(
            f"{path} has a secret key, and others may read it: chmod 600 {path}, and make a new "
            "key if somebody may have read it"
        )
    curve.library()
    return curve.key_of(text, str(path))


class Server(curve.Sealed):
    """A connection that is enciphered, as the side that was dialled."""

    _ours, _theirs = curve.Sealed._theirs, curve.Sealed._ours

    def __init__(self, secret: bytes) -> None:
        super().__init__(b"", secret)
        self._public: bytes = self._nacl.crypto_scalarmult_base(secret)
        self._cookie: bytes = self._nacl.randombytes(_COOKIE)
        self._peer = b""  # C'

    def admit(self, stream: ByteStream) -> Steps[dict[str, bytes]]:
        """Let a peer log in behind its greeting; return its properties. Raises AccessRefused for a
        key that is none of those in access.toml, which the peer is told."""
        stream.write(self.welcome((yield from _content(stream, b"HELLO"))))
        key, properties = self.opened((yield from _content(stream, b"INITIATE")))
        if (yield Claim(key.hex(), public_key=True)) is False:
            stream.write(zmtp.error("400"))  # as `plain` does
            raise AccessRefused(
                f"the public key {key.hex()} of a ZeroMQ socket is none of those in access.toml: "
                'name it there, below [tokens], as NAME = {curve = "KEY"}'
            )
        return zmtp.parse_properties(properties)

    def welcome(self, hello: bytes) -> bytes:
        """The command that answers the content of a HELLO. Raises AccessRefused for a peer that
        expects another key."""
        nacl = self._nacl
        if len(hello) != _HELLO or hello[:1] != b"\1":
            raise RemoteProtocolError(
                f"a HELLO of CURVE with {len(hello)} bytes instead of {_HELLO}, or not of version 1"
            )
        peer, number, box = hello[74:106], self._take(hello[106:114]), hello[114:]
        self._open(
            lambda: nacl.crypto_box_open(box, b"CurveZMQHELLO---" + number, peer, self._secret)
        )
        self._peer = peer
        self._shared = nacl.crypto_box_beforenm(peer, self._brief)
        nonce = nacl.randombytes(16)
        clear = self._brief_public + self._cookie
        answer = nacl.crypto_box(clear, b"WELCOME-" + nonce, peer, self._secret)
        return zmtp.command(b"WELCOME", nonce + answer)

    def opened(self, initiate: bytes) -> tuple[bytes, bytes]:
        """Return the lasting key of the peer, and its properties, in the content of an INITIATE."""
        nacl = self._nacl
        if len(initiate) < _INITIATE or initiate[:_COOKIE] != self._cookie:
            raise RemoteProtocolError("an INITIATE of CURVE without the cookie of its WELCOME")
        number, box = self._take(initiate[_COOKIE : _COOKIE + 8]), initiate[_COOKIE + 8 :]
        nonce = b"CurveZMQINITIATE" + number
        clear = self._open(lambda: nacl.crypto_box_open_afternm(box, nonce, self._shared))
        key, said, vouch = clear[:32], clear[32:48], clear[48:128]
        told = self._open(lambda: nacl.crypto_box_open(vouch, b"VOUCH---" + said, key, self._brief))
        if told != self._peer + self._public:
            raise AccessRefused("the key of a ZeroMQ socket does not belong to its connection")
        return key, clear[128:]

    def ready_of(self, said: Mapping[str, bytes]) -> bytes:
        """The command that ends the greeting."""
        number = self._next()
        nonce = b"CurveZMQREADY---" + number
        box = self._nacl.crypto_box_afternm(zmtp.properties_of(said), nonce, self._shared)
        return zmtp.command(b"READY", number + box)

    def _other_key(self) -> LoginRefused:
        return LoginRefused(
            f"a ZeroMQ socket has another public key of this port than that of {FILE}, or somebody "
            "has changed what it sent: give its program the right one (CURVE_SERVERKEY)"
        )


def _content(stream: ByteStream, wanted: bytes) -> Steps[bytes]:
    flags, body = yield from zmtp.read_frame(stream, ZMQ_COMMAND)
    name, content = zmtp.parse_command(body) if flags & zmtp.COMMAND else (b"", b"")
    if name != wanted:
        raise RemoteProtocolError(f"a ZeroMQ peer with CURVE does not say {wanted.decode()}")
    return content
