"""simulated_network_delay: delay every message, as a slow network would.

Parameter, as in C++ YARP 4: `delay_ms`, default 0, at most 10000.

Use it at the receiver's end, where only the thread of that connection waits. At the sender's end,
which C++ allows too, the writer itself waits, and with it all connections of its port.

Rules: it is a pause, not a delay line: messages that come faster than the delay queue up, and
acknowledgements then slow their sender down, as a narrow network would.
"""

from __future__ import annotations

import threading

from yarpy.monitors.base import Place
from yarpy.wire.message import Message

_MOST = 10_000.0  # milliseconds


class SimulatedNetworkDelay:
    """Delays messages."""

    def __init__(self, place: Place) -> None:
        self._delay = place.number("delay_ms", 0.0, 0, _MOST) / 1000
        self._closed = threading.Event()

    def update(self, message: Message) -> None:
        self._closed.wait(self._delay)

    def parameters(self) -> dict[str, object]:
        return {"delay_ms": self._delay * 1000}

    def close(self) -> None:
        self._closed.set()
