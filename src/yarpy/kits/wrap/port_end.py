"""The end of a topic that is a port: what publishers and listeners of several middlewares share."""

from __future__ import annotations

from typing import Any

from yarpy.errors import Timeout
from yarpy.kits.wrap.middleware import Binding
from yarpy.port.port import MessagePort
from yarpy.wire.message import Message


class PortEnd:
    """A port of its own, for what `binding` says; closing ends it."""

    def __init__(self, port: MessagePort, binding: Binding) -> None:
        self.port = port
        self.binding = binding

    def read(self, timeout: float | None) -> Message:
        """The next message. Raises Timeout, which names the topic, and PortClosed."""
        try:
            return self.port.read(timeout)
        except Timeout:
            raise Timeout(
                f'nothing came from "{self.binding.topic}" within {timeout:.3g} s'
            ) from None

    def wait(self, timeout: float | None) -> bool:
        """Wait until it is connected: a broker does not say who has subscribed."""
        return self.port.wait_for_outputs(1, timeout)

    @property
    def stats(self) -> dict[str, Any]:
        """Return the port's counters."""
        return self.port.stats.as_dict()

    def close(self) -> None:
        self.port.close()
