"""CURVE: a ZeroMQ socket that is known by its public key, and everything enciphered (CurveZMQ).

    04 c8 | 05 "HELLO" 01 00, 72 zeros, C', nonce, box of 64 zeros          the side that dials
    04 a8 | 07 "WELCOME" nonce, box of (S', cookie)                         or ERROR
    04 .. | 08 "INITIATE" cookie, nonce, box of (C, vouch, properties)      the side that dials
    04 .. | 05 "READY" nonce, box of properties                             or ERROR
    00 .. | 07 "MESSAGE" nonce, box of (flags, body)                        both sides

Rules: pure. S and C are the lasting keys of the side that was dialled, the server, and of the one
that dials; S' and C' are those of the connection. The number in a nonce grows with every box, and
one that does not is refused, so nothing can be sent a second time by others. Nothing is accepted
from a socket that cannot open what was meant for the server's key. `curve_server` is the side that
was dialled. Source: ZeroMQ RFC 26. PyNaCl is imported where it is needed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final

from yarpy.errors import LinkClosed, LocalProtocolError, LoginRefused, RemoteProtocolError
from yarpy.limit import ZMQ_COMMAND
from yarpy.peers.zmq import zmtp
from yarpy.route import CarrierSpec
from yarpy.wire.steps import Steps
from yarpy.wire.stream import Buffer, ByteStream

if TYPE_CHECKING:
    from types import ModuleType

MECHANISM: Final = b"CURVE"
KEY: Final = 32  # bytes
OVERHEAD: Final = 33  # bytes by which a frame is longer than its body
_MORE: Final = 1  # flags within a box
_COMMAND: Final = 2
_MESSAGE: Final = b"\7MESSAGE"
_WELCOME: Final = 160  # bytes of its content


def library() -> ModuleType:
    """Return the functions of libsodium. Raises LocalProtocolError where they are not installed."""
    try:
        from nacl import bindings
    except ImportError as error:
        raise LocalProtocolError(
            'CURVE of ZeroMQ needs the package PyNaCl: pip install "yarpy[zmq]"'
        ) from error
    return bindings


def keys_of(spec: CarrierSpec) -> tuple[bytes, bytes | None] | None:
    """Return the server's public key and our secret one (None: one for this connection alone) of a
    carrier string; None if it names no server's key. Raises LocalProtocolError."""
    server = spec.value("curve")
    if server is None:
        if "curve" in spec.tokens:
            raise LocalProtocolError(
                "CURVE needs the server's public key: say +curve.KEY, with 64 hexadecimal digits"
            )
        return None
    if spec.value("user") is not None:
        raise LocalProtocolError("a socket asks for a name (PLAIN) or for a key (CURVE): say one")
    own = spec.value("password")
    library()
    return key_of(server, "+curve.KEY"), None if own is None else key_of(own, "+password.KEY")


def key_of(text: str, where: str) -> bytes:
    """Return the bytes of a key. Raises LocalProtocolError, which says `where` it stands."""
    try:
        found = bytes.fromhex(text)
    except ValueError:
        found = b""
    if len(found) != KEY:
        raise LocalProtocolError(
            f"{where} takes a key of 64 hexadecimal digits: zmq.utils.z85.decode(key).hex() makes "
            "them of one in Z85"
        )
    return found


class Sealed:
    """A connection that is enciphered, as the side that has dialled."""

    _ours = b"CurveZMQMESSAGEC"  # the beginnings of nonces
    _theirs = b"CurveZMQMESSAGES"

    def __init__(self, server: bytes, secret: bytes | None = None) -> None:
        self._nacl: Any = library()
        nacl = self._nacl
        self._server = server
        self._secret = nacl.crypto_box_keypair()[1] if secret is None else secret
        self._brief_public, self._brief = nacl.crypto_box_keypair()
        self._number = 0  # of the last nonce of ours
        self._heard = 0  # of the last nonce of the peer's
        self._shared = b""  # what S' and C' have in common

    def hello(self) -> bytes:
        """The command that begins."""
        number = self._next()
        box = self._nacl.crypto_box(
            bytes(64), b"CurveZMQHELLO---" + number, self._server, self._brief
        )
        return zmtp.command(b"HELLO", b"\1\0" + bytes(72) + self._brief_public + number + box)

    def initiate(self, welcome: bytes, properties: bytes) -> bytes:
        """The command that answers the content of a WELCOME. Raises LoginRefused for a peer that
        has another key than the one that is expected."""
        nacl = self._nacl
        if len(welcome) != _WELCOME:
            raise RemoteProtocolError(
                f"a WELCOME of CURVE with {len(welcome)} bytes instead of {_WELCOME}"
            )
        opened = self._open(
            lambda: nacl.crypto_box_open(
                welcome[16:], b"WELCOME-" + welcome[:16], self._server, self._brief
            )
        )
        brief, cookie = opened[:KEY], opened[KEY:]
        self._shared = nacl.crypto_box_beforenm(brief, self._brief)
        nonce = nacl.randombytes(16)
        vouch = nacl.crypto_box(
            self._brief_public + self._server, b"VOUCH---" + nonce, brief, self._secret
        )
        public = nacl.crypto_scalarmult_base(self._secret)
        number = self._next()
        box = nacl.crypto_box_afternm(
            public + nonce + vouch + properties, b"CurveZMQINITIATE" + number, self._shared
        )
        return zmtp.command(b"INITIATE", cookie + number + box)

    def ready(self, content: bytes) -> dict[str, bytes]:
        """Return the properties in the content of a READY."""
        number = self._take(content[:8])
        opened = self._open(
            lambda: self._nacl.crypto_box_open_afternm(
                content[8:], b"CurveZMQREADY---" + number, self._shared
            )
        )
        return zmtp.parse_properties(opened)

    def log_in(self, stream: ByteStream, said: Mapping[str, bytes]) -> Steps[dict[str, bytes]]:
        """Log in behind the greeting, and say the properties `said`; return those of the peer.
        Raises LoginRefused, RemoteProtocolError."""
        stream.write(self.hello())
        try:
            welcome = yield from _answer(stream, b"WELCOME")
        except LinkClosed:
            raise LinkClosed(
                "the peer hangs up without a word, as sockets do that have another key than the "
                "one in +curve.KEY: take the public key of that socket"
            ) from None
        stream.write(self.initiate(welcome, zmtp.properties_of(said)))
        return self.ready((yield from _answer(stream, b"READY")))

    def encode(self, frames: Sequence[Buffer]) -> list[Buffer]:
        """A message of these frames, enciphered."""
        last = len(frames) - 1
        sealed = (self._seal(_MORE * (place < last), body) for place, body in enumerate(frames))
        return [piece for body in sealed for piece in zmtp.encode([body])]

    def command(self, name: bytes, body: bytes = b"") -> bytes:
        """A command, enciphered."""
        return zmtp.frame(self._seal(_COMMAND, bytes((len(name),)) + name + body))

    def open(self, flags: int, body: Buffer) -> zmtp.Frame:
        """Return the frame that is in one of the peer's. Raises RemoteProtocolError."""
        data = bytes(body)
        if flags & (zmtp.MORE | zmtp.COMMAND) or data[:8] != _MESSAGE or len(data) < OVERHEAD:
            if flags & zmtp.COMMAND and data[:6] == b"\5ERROR":
                raise RemoteProtocolError(f"the peer ends the connection: {data[7:60]!r}")
            raise RemoteProtocolError("a frame in clear where CURVE was agreed on")
        number = self._take(data[8:16])
        opened = self._open(
            lambda: self._nacl.crypto_box_open_afternm(
                data[16:], self._theirs + number, self._shared
            )
        )
        told = opened[0]
        found = zmtp.MORE * bool(told & _MORE) | zmtp.COMMAND * bool(told & _COMMAND)
        zmtp.check_flags(found)
        return found, opened[1:]

    def _seal(self, flags: int, body: Buffer) -> bytes:
        number = self._next()
        clear = bytes((flags,)) + body
        box: bytes = self._nacl.crypto_box_afternm(clear, self._ours + number, self._shared)
        return _MESSAGE + number + box

    def _next(self) -> bytes:
        self._number += 1
        return self._number.to_bytes(8, "big")

    def _take(self, number: bytes) -> bytes:
        """Return the number of a nonce of the peer, if it is greater than all before."""
        found = int.from_bytes(number, "big")
        if len(number) < 8 or found <= self._heard:
            raise RemoteProtocolError("a message of CURVE that has come before")
        self._heard = found
        return number

    def _open(self, box: Any) -> bytes:
        from nacl.exceptions import CryptoError

        try:
            found: bytes = box()
        except (CryptoError, ValueError):
            raise self._other_key() from None
        return found

    def _other_key(self) -> LoginRefused:
        return LoginRefused(
            "the peer has another key than the one in +curve.KEY, or somebody has changed what it "
            "sent: take the public key of that socket"
        )


def _answer(stream: ByteStream, wanted: bytes) -> Steps[bytes]:
    flags, body = yield from zmtp.read_frame(stream, ZMQ_COMMAND)
    name, content = zmtp.parse_command(body) if flags & zmtp.COMMAND else (b"", b"")
    if name == b"ERROR":
        raise _refused(content)
    if name != wanted:
        raise RemoteProtocolError(f"a ZeroMQ peer says {name[:20]!r} instead of {wanted.decode()}")
    return content


def _refused(content: bytes) -> LoginRefused:
    return LoginRefused(
        f"the peer does not take our key ({content[1:40]!r}): say +password.KEY, the secret key "
        "whose public one it knows"
    )
