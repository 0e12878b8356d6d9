"""stats_monitor: the traffic of a connection, published once a second on two ports.

Attach it at the sender's end, as in C++ YARP 4: `/stats_monitor/from/to/stats:o` is about messages
from `/from` to `/to`, `/stats_monitor/to/from/stats:o` about the replies. Each second they write

    time from to carrier [ok] bytes_per_second messages_per_second     ([fail] for replies)

Rules: a monitor that owns ports, so it lives in this layer. C++ clients request it for every
connection if YARP_CONNECTIONS_STATS_ENABLE is set. Without C++, `yarpy stats` shows this and more.
"""

from __future__ import annotations

import threading
import time

from yarpy.data.value import Vocab
from yarpy.errors import LocalProtocolError, YarpError
from yarpy.monitors.base import Place
from yarpy.port.port import BufferedPort
from yarpy.threads import Thread
from yarpy.wire.message import Message, Packet

_PERIOD = 1.0  # seconds


class StatsMonitor:
    """Counts messages and replies."""

    def __init__(self, place: Place) -> None:
        if not place.sending:
            raise LocalProtocolError(
                '"stats_monitor" works at the sender\'s end: connect with +send.stats_monitor'
            )
        self._forward = _Direction(place, place.source, place.target, Vocab("ok"))
        try:
            self._backward = _Direction(place, place.target, place.source, Vocab("fail"))
        except YarpError:
            self._forward.port.close()
            raise
        self._closed = threading.Event()
        self._thread = Thread(target=self._run, name=f"yarpy stats {place}", daemon=True)
        self._thread.start()

    def update(self, message: Message) -> None:
        self._forward.count(message)

    def update_reply(self, message: Message) -> None:
        self._backward.count(message)

    def _run(self) -> None:
        while not self._closed.wait(_PERIOD):
            for direction in (self._forward, self._backward):
                direction.tell()

    def close(self) -> None:
        self._closed.set()
        self._thread.join()
        self._forward.port.close()
        self._backward.port.close()


class _Direction:
    """One direction."""

    def __init__(self, place: Place, source: str, target: str, forward: Vocab) -> None:
        name = f"/stats_monitor{source}{target}/stats:o"
        self.port = BufferedPort(name, names=place.names)
        self._facts = (source, target, place.carrier, forward)
        self._messages = self._bytes = 0
        self._since = time.monotonic()

    def count(self, message: Message) -> None:
        self._messages += 1
        self._bytes += sum(memoryview(block).nbytes for block in Packet(message.value).blocks)

    def tell(self) -> None:
        now = time.monotonic()
        messages, size, passed = self._messages, self._bytes, now - self._since
        self._since = now
        self._messages -= messages
        self._bytes -= size
        self.port.write([time.time(), *self._facts, size / passed, messages / passed])
