"""AnalogSensor: a remote sensor with channels, C++ or Python, used like a local one.

    with AnalogSensor("/icub/left_arm/analog:o") as sensor:
        print(sensor.channels())            # [0.1, -0.2, -9.8, 0.0, 0.0, 0.0]
        sensor.calibrate()                  # this is zero from now on

Rules: it has every member listed in `devices.analog.interface` but the states of channels, which
nobody sends; so it can be served again.

Source: analogsensorclient of YARP 3.x.
"""

from __future__ import annotations

from collections.abc import Sequence

from yarpy.data.bottle import Bottle
from yarpy.data.sig.vector import Vector
from yarpy.data.value import Vocab
from yarpy.errors import LocalProtocolError
from yarpy.kits.devices.remote_device import TIMEOUT, RemoteDevice
from yarpy.wire.message import Message


class AnalogSensor(RemoteDevice[tuple[float, ...]]):
    """The sensor whose values come from the port `remote`, to the port `local`."""

    def channels(self) -> list[float]:
        """A number for each channel, in the sensor's own units."""
        return [*self._latest.value()]

    def timestamp(self) -> float:
        """Return the time when they were measured, seconds (of the sender's clock)."""
        return self._latest.time()

    def calibrate(self, values: Sequence[float] | None = None) -> None:
        """Let the present values count as zero, or as these."""
        self._tell("cal", *(float(each) for each in values or ()))

    def calibrate_channel(self, channel: int, value: float | None = None) -> None:
        """Let the present value of a channel count as zero, or as this."""
        self._tell("calc", int(channel), *(() if value is None else (float(value),)))

    def _tell(self, what: str, *values: float) -> None:
        answer = self._rpc.call(Bottle([Vocab("iana"), Vocab(what), *values]), timeout=TIMEOUT)
        if answer not in (0, [0]):
            raise LocalProtocolError(
                f'"{self.remote}" is not calibrated, it answers {answer!r:.40}: the sensor cannot '
                "do this, or not with these values"
            )

    def _decode(self, message: Message) -> tuple[float, ...]:
        return tuple(float(each) for each in message.as_(Vector).array)
