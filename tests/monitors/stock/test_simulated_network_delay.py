"""simulated_network_delay: messages wait, other connections do not, and closing ends the wait."""

from __future__ import annotations

import threading
import time

import pytest
from support.monitor import place
from support.wait import HANG

import yarpy
from yarpy import LocalProtocolError
from yarpy.link.send import window
from yarpy.monitors.stock import simulated_network_delay
from yarpy.monitors.stock.simulated_network_delay import SimulatedNetworkDelay
from yarpy.wire.message import DATA, Message


def test_a_message_waits() -> None:
    monitor = SimulatedNetworkDelay(place("delay_ms.20"))
    started = time.monotonic()
    monitor.update(Message(DATA))
    assert time.monotonic() - started >= 0.019
    assert monitor.parameters() == {"delay_ms": 20}


def test_closing_ends_the_wait() -> None:
    monitor = SimulatedNetworkDelay(place("delay_ms.10000"))
    thread = threading.Thread(target=monitor.update, args=(Message(DATA),))
    thread.start()
    monitor.close()
    thread.join(HANG)
    assert not thread.is_alive()


@pytest.mark.parametrize("tokens", ["delay_ms.-1", "delay_ms.10001", "delay_ms.long"])
def test_wrong_delay(tokens: str) -> None:
    with pytest.raises(LocalProtocolError, match="delay_ms"):
        SimulatedNetworkDelay(place(tokens))


def test_other_connections_go_on(monkeypatch: pytest.MonkeyPatch) -> None:
    """At the receiver's end only the slow connection waits."""
    monkeypatch.setattr(simulated_network_delay, "_MOST", 1e6)
    monkeypatch.setattr(window, "WINDOW_SECONDS", 60.0)  # else a writer who is kept waits for it
    names = yarpy.LocalNames()
    with (
        yarpy.BufferedPort("/out", strict=True, names=names) as out,
        yarpy.BufferedPort("/slow", strict=True, names=names) as slow,
        yarpy.BufferedPort("/fast", strict=True, names=names) as fast,
    ):
        out.connect("/slow", "tcp+recv.simulated_network_delay+delay_ms.100000")
        out.connect("/fast")
        for number in range(5):
            assert out.write(number) == 2
        read = [fast.read(timeout=HANG) for _ in range(5)]
        assert [message.value for message in read if message] == [0, 1, 2, 3, 4]
        with pytest.raises(yarpy.Timeout):
            slow.read(timeout=0)


def test_order_is_kept() -> None:
    names = yarpy.LocalNames()
    with (
        yarpy.Port("/out", names=names) as out,
        yarpy.BufferedPort("/in", strict=True, names=names) as in_,
    ):
        out.connect(
            "/in", "tcp+send.simulated_network_delay+recv.simulated_network_delay+delay_ms.5"
        )
        for number in range(5):
            out.write(number)
        read = [in_.read(timeout=HANG) for _ in range(5)]
        assert [message.value for message in read if message] == [0, 1, 2, 3, 4]
