"""The proof of a shared key: golden bytes, wrong keys, damaged and truncated exchanges."""

from __future__ import annotations

import hmac
from collections.abc import Callable

import pytest
from hypothesis import given
from hypothesis import strategies as st

from yarpy.carriers.auth import prove_acceptor, prove_initiator
from yarpy.errors import LinkClosed, RemoteProtocolError, YarpError
from yarpy.testing import End, drive
from yarpy.wire.stream import run

KEY = b"secretkey"

# The first message of a C++ server 3.9.1 with this key.
NONCE = bytes.fromhex("547749648828493e")
SIGNATURE = bytes.fromhex("27d2864d2878cd72259ff5809f23c7caacc0cf23036e4bb1438d74edad1a8bcc")


def given_by(*nonces: bytes) -> Callable[[int], bytes]:
    """A source of randomness that gives these, in order."""
    rest = iter(nonces)
    return lambda count: next(rest)


def signed(nonces: bytes, key: bytes = KEY) -> bytes:
    """A message: its last eight random bytes, and the proof over all of them."""
    return nonces[-8:] + hmac.digest(key, nonces, "sha256")


def test_golden_first_message() -> None:
    end = End()
    end.begin(prove_acceptor(end.stream, KEY, given_by(NONCE)))
    assert end.take() == NONCE + SIGNATURE


@pytest.mark.parametrize("piece", [0, 1])
def test_golden_exchange(piece: int) -> None:
    """Every message proves all random bytes so far."""
    second, third = b"22222222", b"33333333"
    acceptor, initiator = End(piece), End(piece)
    acceptor.begin(prove_acceptor(acceptor.stream, KEY, given_by(NONCE, third)))
    initiator.begin(prove_initiator(initiator.stream, KEY, given_by(second)))
    traffic: list[tuple[str, bytes]] = []
    drive(initiator, acceptor, traffic)
    assert acceptor.done
    assert initiator.done
    assert traffic == [
        ("acceptor", signed(NONCE)),
        ("initiator", signed(NONCE + second)),
        ("acceptor", signed(NONCE + second + third)),
    ]


def test_random_bytes_are_fresh() -> None:
    first, second = End(), End()
    for end in (first, second):
        end.begin(prove_acceptor(end.stream, KEY))
    assert first.take() != second.take()


def test_wrong_key_is_found_on_either_side() -> None:
    end = End()
    end.begin(prove_initiator(end.stream, b"another"))
    with pytest.raises(RemoteProtocolError, match=r"auth\.conf"):
        end.feed(NONCE + SIGNATURE)
    assert end.take() == b""  # and nothing is proved to the stranger
    end = End()
    end.begin(prove_acceptor(end.stream, KEY, given_by(NONCE)))
    end.take()
    with pytest.raises(RemoteProtocolError, match="does not know our key"):
        end.feed(signed(NONCE + b"22222222", b"another"))
    assert end.take() == b""


def test_message_of_another_exchange_is_not_accepted() -> None:
    """A listener cannot use what it heard: the proof covers our own random bytes."""
    end = End()
    end.begin(prove_acceptor(end.stream, KEY, given_by(NONCE)))
    with pytest.raises(RemoteProtocolError):
        end.feed(signed(b"11111111" + b"22222222"))


@pytest.mark.parametrize("size", [0, 1, 8, 39])
def test_exchange_that_is_cut_off(size: int) -> None:
    end = End()
    end.begin(prove_initiator(end.stream, KEY))
    end.feed((NONCE + SIGNATURE)[:size])
    with pytest.raises(LinkClosed):
        end.feed_eof()


@given(st.integers(0, 39), st.integers(1, 255))
def test_damaged_proof_is_refused(at: int, change: int) -> None:
    data = bytearray(NONCE + SIGNATURE)
    data[at] ^= change
    end = End()
    with pytest.raises(RemoteProtocolError):
        run(prove_initiator(end.stream, KEY), end.stream, [bytes(data)])


@given(st.binary(max_size=100))
def test_noise_ends_in_our_errors(data: bytes) -> None:
    for prove in (prove_acceptor, prove_initiator):
        end = End()
        with pytest.raises(YarpError):
            run(prove(end.stream, KEY), end.stream, [data])
