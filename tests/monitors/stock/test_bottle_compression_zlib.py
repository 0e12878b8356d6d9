"""bottle_compression_zlib: the bytes of C++, every kind of message there and back, damage."""

from __future__ import annotations

import logging
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.message import bottles
from support.monitor import damaged, place, received, sent, through

from yarpy import Bottle, Image, Sound, Vector
from yarpy.errors import DecodeError
from yarpy.monitors.stock.bottle_compression_zlib import BottleCompressionZlib
from yarpy.wire.message import Message, Packet

# The Bottle `hello 1 2 3`, as C++ YARP sends it through this monitor.
GOLDEN = bytes.fromhex(
    "00010000 02000000"  # a list of 2
    "01000000 2d000000"  # 45
    "0c000000 20000000"  # a blob of 32 bytes
    "789c63606460606180605620ce48cdc9c9078a31c03013946606"
    "62003aa5022c"
)


def test_bytes_of_cpp() -> None:
    message = received(BottleCompressionZlib, GOLDEN)
    assert message.value == ["hello", 1, 2, 3]
    assert (message.envelope, message.source) == ("7 0.5", "/out")
    assert sent(BottleCompressionZlib, Bottle(["hello", 1, 2, 3])) == GOLDEN


@given(bottles)
def test_any_bottle_there_and_back(bottle: Bottle) -> None:
    assert bytes(through(BottleCompressionZlib, bottle).to_bytes()) == bottle.to_bytes()


@pytest.mark.parametrize(
    "value",
    [
        5,
        "text",
        None,
        {"key": 1},
        Vector(range(100)),
        Image(np.arange(30, dtype="u1").reshape(5, 6)),
        Sound(np.arange(20)),
        np.eye(3),
    ],
)
def test_any_value_there_and_back(value: Any) -> None:
    message = through(BottleCompressionZlib, value)
    assert bytes(message.to_bytes()) == b"".join(Packet(value).blocks)


@given(st.data())
def test_damage_is_a_decode_error(data: st.DataObject) -> None:
    wire = damaged(data, GOLDEN)
    try:
        received(BottleCompressionZlib, wire, limit=10_000)
    except DecodeError:
        pass


@pytest.mark.parametrize("value", [Bottle(), Bottle(["hi"]), Bottle([45, "hi"]), Bottle([1, 2, 3])])
def test_what_was_not_compressed(value: Bottle) -> None:
    with pytest.raises(DecodeError):
        received(BottleCompressionZlib, value.to_bytes())


def test_limit_of_the_port() -> None:
    data = sent(BottleCompressionZlib, bytes(5000))
    assert received(BottleCompressionZlib, data, limit=6000).value == bytes(5000)
    with pytest.raises(DecodeError, match="the limit is 4000"):
        received(BottleCompressionZlib, data, limit=4000)


def test_sizes_are_told(caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.INFO)
    quiet = BottleCompressionZlib(place(sending=True))
    quiet.update(Message.of(Packet(bytes(1000))))
    assert not caplog.text
    monitor = BottleCompressionZlib(place("debug_compression_info.1", sending=True))
    monitor.update(Message.of(Packet(bytes(1000))))
    assert "1016 bytes sent as" in caplog.text
    found = monitor.parameters()
    assert found["uncompressed"] == 1016
    assert 0 < found["compressed"] < 100  # type: ignore[operator]
