"""What a protocol asks of its driver: plain values."""

from dataclasses import FrozenInstanceError

import pytest

from yarpy.wire.effects import Group, Open, Switch
from yarpy.wire.stream import ByteStream


def test_effects_are_values() -> None:
    assert Open("udp", listen=True) == Open("udp", True, 0, "")
    assert Open("udp", listen=False, port=5) != Open("udp", listen=False, port=6)
    assert Group() == Group()
    with pytest.raises(FrozenInstanceError):
        Open("udp", listen=True).port = 1  # type: ignore[misc]


def test_switch_names_the_new_place_and_its_buffer() -> None:
    handle, stream = object(), ByteStream()
    switch = Switch(handle, stream)
    assert switch.handle is handle
    assert switch.stream is stream
    assert not hasattr(switch, "__dict__")
