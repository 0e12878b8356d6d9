"""Optional authentication, before any greeting: both sides prove that they know auth.conf's key.

Rules: three messages of eight random bytes and an HMAC-SHA256 over all random bytes so far; the
acceptor begins. It encrypts nothing.
"""

from __future__ import annotations

import os
from collections.abc import Callable

from yarpy.errors import RemoteProtocolError
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream

_NONCE = 8
_MESSAGE = _NONCE + 32

Random = Callable[[int], bytes]


def _sign(key: bytes, nonces: bytes) -> bytes:
    import hmac  # which loads OpenSSL: where there is a key

    return hmac.digest(key, nonces, "sha256")


def _check(message: bytes, key: bytes, nonces: bytes) -> bytes:
    nonce, signature = message[:_NONCE], message[_NONCE:]
    from hmac import compare_digest

    if not compare_digest(signature, _sign(key, nonces + nonce)):
        raise RemoteProtocolError("the peer does not know our key; compare both sides' auth.conf")
    return nonces + nonce


def prove_acceptor(stream: ByteStream, key: bytes, random: Random = os.urandom) -> Steps[None]:
    """The accepting side of the exchange. Raises RemoteProtocolError if the keys differ."""
    nonces = random(_NONCE)
    stream.write(nonces + _sign(key, nonces))
    nonces = _check(bytes((yield from stream.read_exact(_MESSAGE))), key, nonces)
    last = random(_NONCE)
    stream.write(last + _sign(key, nonces + last))


def prove_initiator(stream: ByteStream, key: bytes, random: Random = os.urandom) -> Steps[None]:
    """The dialling side of the exchange. Raises RemoteProtocolError if the keys differ."""
    nonces = _check(bytes((yield from stream.read_exact(_MESSAGE))), key, b"")
    own = random(_NONCE)
    nonces += own
    stream.write(own + _sign(key, nonces))
    _check(bytes((yield from stream.read_exact(_MESSAGE))), key, nonces)
