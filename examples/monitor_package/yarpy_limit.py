"""limit: keep the numbers on a connection within limits, whatever its sender writes.

yarpy connect /joystick /motor tcp+recv.limit+most.10
yarpy admin /motor set in /joystick "(most 5)"
"""

from typing import Any

from yarpy.data.bottle import Property
from yarpy.errors import LocalProtocolError
from yarpy.monitors import Place
from yarpy.wire.message import Message


class Limit:
    """Numbers from -most to most pass unchanged, others are clipped; anything else is dropped."""

    def __init__(self, place: Place) -> None:
        self.most = place.number("most", 1.0, least=0.0)
        self.cut = 0

    def accept(self, message: Message) -> bool:
        return all(isinstance(value, (int, float)) for value in message.value)

    def update(self, message: Message) -> list[float] | None:
        values = [max(-self.most, min(value, self.most)) for value in message.value]
        if values == list(message.value):
            return None  # goes on as it came
        self.cut += 1
        return values

    def configure(self, parameters: Property) -> None:
        most = parameters.get("most", self.most)
        if not isinstance(most, (int, float)) or most < 0:
            raise LocalProtocolError(f'"most" takes a number from 0, not "{most}"')
        self.most = most

    def parameters(self) -> dict[str, Any]:
        return {"most": self.most}

    def state(self) -> dict[str, Any]:
        return {"cut": self.cut}
