"""Payloads: bytes on every connection, their value as text."""

from yarpy.data import codec
from yarpy.data.bottle import Bottle
from yarpy.kits.thrift.payload import Payload
from yarpy.kits.thrift.wire.extent import version_ending
from yarpy.wire.message import Packet


def test_bytes_and_text() -> None:
    data = Bottle(["a", 1]).to_bytes()
    payload = Payload(data)
    assert codec.encode(payload) == (data,) and codec.encode_text(payload) == b"a 1"
    assert Packet(payload).line == b"a 1" and payload.reply_end is None
    assert Payload(data, version_ending).reply_end is version_ending
