"""PLAIN: a name and a password for a ZeroMQ socket that asks for them, in clear text.

    04 SIZE | 05 "HELLO" | NAME-SIZE name PASSWORD-SIZE password      the side that dials
    04 SIZE | 07 "WELCOME"                                            or ERROR
    04 SIZE | 08 "INITIATE" | properties                              the side that dials
    04 SIZE | 05 "READY" | properties                                 or ERROR

Rules: pure. A port shows them where it dials. Of a socket that shows them to a port the password is
a token of `access.toml`, whatever the name; where there are no tokens nobody looks at it, as with
libzmq, and the rules are for its address. Source: ZeroMQ RFC 24.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from yarpy.errors import AccessRefused, LocalProtocolError, LoginRefused, RemoteProtocolError
from yarpy.limit import ZMQ_COMMAND
from yarpy.peers.zmq import zmtp
from yarpy.route import CarrierSpec
from yarpy.wire.effects import Claim
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream

MECHANISM: Final = b"PLAIN"
_ERROR: Final = b"\x5eRROR"  # what libzmq 4.3.5 writes for `05 "ERROR"`
LONGEST: Final = 255  # bytes of a name, and of a password


def credentials(spec: CarrierSpec) -> tuple[bytes, bytes] | None:
    """Return the name and the password of a carrier string, None if it has none. Raises
    LocalProtocolError for a password without a name, and for what is too long."""
    user, password = spec.value("user"), spec.value("password")
    if user is None:
        if password is not None:
            raise LocalProtocolError("a password for a socket needs a name: say +user.NAME")
        return None
    found = user.encode(), (password or "").encode()
    if max(map(len, found)) > LONGEST:
        raise LocalProtocolError(
            f"a name or a password for a ZeroMQ socket has {LONGEST} bytes at most"
        )
    return found


def hello(user: bytes, password: bytes) -> bytes:
    """The command that shows a name and a password.

    >>> hello(b"me", b"word").hex(" ")
    '04 0e 05 48 45 4c 4c 4f 02 6d 65 04 77 6f 72 64'
    """
    return zmtp.command(b"HELLO", bytes((len(user),)) + user + bytes((len(password),)) + password)


def log_in(
    stream: ByteStream, user: bytes, password: bytes, said: Mapping[str, bytes]
) -> Steps[dict[str, bytes]]:
    """Log in behind the greeting, and say the properties `said`; return those of the peer. Raises
    LoginRefused, RemoteProtocolError."""
    stream.write(hello(user, password))
    flags, body = yield from zmtp.read_frame(stream, ZMQ_COMMAND)
    name = bytes(body)[1 : 1 + body[0]] if body and flags & zmtp.COMMAND else b""
    if name == b"ERROR" or bytes(body[:5]) == _ERROR:
        raise LoginRefused("the peer takes another name or password: say +user.NAME+password.WORD")
    if name != b"WELCOME":
        raise RemoteProtocolError(f"a ZeroMQ peer answers HELLO with {name[:20]!r}")
    stream.write(zmtp.command(b"INITIATE", zmtp.properties_of(said)))
    try:
        return (yield from zmtp.read_ready(stream))
    except AccessRefused as error:
        raise LoginRefused(f"the peer does not admit us: {error}") from None


def admit(stream: ByteStream) -> Steps[dict[str, bytes]]:
    """Let a peer log in behind its greeting; return its properties. Raises AccessRefused for a
    password that is no token where there are some, which the peer is told."""
    content = yield from _command(stream, b"HELLO")
    end = 1 + content[0] if content else 0
    password = content[end + 1 :]
    if not content or len(content) <= end or content[end] != len(password):
        raise RemoteProtocolError("a HELLO of PLAIN whose name and password are cut off")
    if (yield Claim(password.decode("utf-8", "surrogateescape"))) is False:
        stream.write(zmtp.error("400"))  # as the RFC spells it: libzmq 4.3.5 takes only the end
        raise AccessRefused(
            "the password of a ZeroMQ socket is none of the tokens of access.toml: give it one"
        )
    stream.write(zmtp.command(b"WELCOME"))
    return zmtp.parse_properties((yield from _command(stream, b"INITIATE")))


def _command(stream: ByteStream, wanted: bytes) -> Steps[bytes]:
    flags, body = yield from zmtp.read_frame(stream, ZMQ_COMMAND)
    data = bytes(body)
    if not flags & zmtp.COMMAND or data[: 1 + len(wanted)] != bytes((len(wanted),)) + wanted:
        raise RemoteProtocolError(f"a ZeroMQ peer with PLAIN does not say {wanted.decode()}")
    return data[1 + len(wanted) :]
