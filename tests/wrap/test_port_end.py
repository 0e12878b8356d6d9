"""Ends of topics that are ports: what comes, what does not, and the end."""

from __future__ import annotations

import threading

import pytest
from support.patience import patience

import yarpy
from yarpy.wrap.middleware import Way
from yarpy.wrap.port_end import PortEnd


def test_reading_waiting_counting_closing() -> None:
    names = yarpy.LocalNames()
    reader = PortEnd(yarpy.BufferedPort("/end/in", names=names), Way("/topic"))
    writer = PortEnd(yarpy.BufferedPort("/end/out", names=names), Way("/topic"))
    try:
        assert not writer.wait(0.01)
        writer.port.connect("/end/in")
        assert writer.wait(patience(5.0))
        with pytest.raises(yarpy.Timeout, match=r'nothing came from "/topic" within 0\.01 s'):
            reader.read(0.01)
        writer.port.write([1])
        assert reader.read(patience(5.0)).value == [1]
        assert reader.stats["inputs"][0]["messages"] == 1
        late = threading.Timer(0.05, reader.close)
        late.start()
        with pytest.raises(yarpy.PortClosed):
            reader.read(patience(10.0))
        late.join()
    finally:
        reader.close()
        writer.close()
