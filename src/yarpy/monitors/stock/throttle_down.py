"""throttleDown: let at most one message pass in each period, and drop the others.

Parameter, as in C++ YARP 4: `period_ms`, default 1000. At the sender's end dropped messages are not
transmitted; at the receiver's end they are.

Rules: the first message passes. Messages that come a little late do not delay the following ones,
so that the period is kept on average.
"""

from __future__ import annotations

import time

from yarpy.data.bottle import Property
from yarpy.errors import LocalProtocolError
from yarpy.monitors.base import Place
from yarpy.wire.message import Message


class ThrottleDown:
    """Thins a stream out."""

    def __init__(self, place: Place) -> None:
        self._period = place.number("period_ms", 1000.0, 0) / 1000
        self._due = 0.0

    def accept(self, message: Message) -> bool:
        now = time.monotonic()
        if now < self._due:
            return False
        # More than a period late: start a new period.
        self._due = (self._due if now < self._due + self._period else now) + self._period
        return True

    def configure(self, parameters: Property) -> None:
        period = parameters.get("period_ms", self._period * 1000)
        if not isinstance(period, (int, float)) or not period >= 0:
            raise LocalProtocolError(f'"period_ms" takes a number of at least 0, not "{period}"')
        self._period, self._due = period / 1000, 0.0

    def parameters(self) -> dict[str, object]:
        return {"period_ms": self._period * 1000}
