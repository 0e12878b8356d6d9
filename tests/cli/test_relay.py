"""Messages are sent on byte for byte."""

import pytest
from support.wait import HANG

import yarpy
from yarpy.cli.relay import forwardable


@pytest.mark.parametrize("carrier", ["tcp", "udp", "text", "local"])
def test_any_message_over_any_carrier(carrier):
    names = yarpy.LocalNames()
    with (
        yarpy.Port("/from", names=names) as source,
        yarpy.Port("/in", names=names) as inlet,
        yarpy.Port("/out", names=names) as outlet,
        yarpy.Port("/to", names=names) as sink,
    ):
        source.connect("/in", carrier)
        outlet.connect("/to")
        value = yarpy.Bottle([1, "two", [3.5, yarpy.Vocab("four")], yarpy.Int8(5)])
        source.write(value)
        message = inlet.read(timeout=HANG)
        outlet.write(forwardable(message))
        arrived = sink.read(timeout=HANG)
        assert arrived.value == value
        if carrier in ("tcp", "udp"):
            assert bytes(arrived.payload) == value.to_bytes()


def test_what_is_no_bottle():
    """An image, or what nobody here can read."""
    payload = b"\1\2\3 no bottle"
    whole = forwardable(yarpy.Message("D", payload))
    assert b"".join(whole.to_wire()) == payload
