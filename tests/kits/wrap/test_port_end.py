"""Ends of topics that are ports: what comes, what does not, and the end."""

from __future__ import annotations

import threading

import pytest
from support.wait import HANG

import yarpy
from yarpy.kits.wrap.middleware import Binding
from yarpy.kits.wrap.port_end import PortEnd


def test_reading_waiting_counting_closing() -> None:
    names = yarpy.LocalNames()
    reader = PortEnd(yarpy.BufferedPort("/end/in", names=names), Binding("/topic"))
    writer = PortEnd(yarpy.BufferedPort("/end/out", names=names), Binding("/topic"))
    try:
        assert not writer.wait(0.01)
        writer.port.connect("/end/in")
        assert writer.wait(HANG)
        with pytest.raises(yarpy.Timeout, match=r'nothing came from "/topic" within 0\.01 s'):
            reader.read(0.01)
        writer.port.write([1])
        assert reader.read(HANG).value == [1]
        assert reader.stats["inputs"][0]["messages"] == 1
        late = threading.Timer(0.05, reader.close)
        late.start()
        with pytest.raises(yarpy.PortClosed):
            reader.read(HANG)
        late.join()
    finally:
        reader.close()
        writer.close()
