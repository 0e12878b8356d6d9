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
from contextlib import ExitStack
from typing import Final

from yarpy.data.bottle import Bottle
from yarpy.data.sig.vector import Vector
from yarpy.data.value import Vocab
from yarpy.errors import LocalProtocolError
from yarpy.kits.devices.closeable import Closeable, local_prefix, prefix
from yarpy.kits.devices.latest_message import LatestMessage
from yarpy.names.base import NameClient
from yarpy.port.rpc import RpcClient
from yarpy.wire.message import Message

#: Seconds to wait for an answer.
TIMEOUT: Final = 10.0


class AnalogSensor(Closeable):
    """The sensor whose values come from the port `remote`.

    local: the client's own port of values; generated if empty.
    timeout: values older than this many seconds are ignored.
    names: a name client, None for the default.
    Raises UnknownName, LinkClosed; later Timeout, LocalProtocolError.
    """

    def __init__(
        self,
        remote: str,
        local: str = "",
        *,
        carrier: str = "tcp",
        timeout: float = 0.5,
        names: NameClient | None = None,
    ) -> None:
        self.remote = remote = prefix(remote)
        local = local_prefix(local, remote)
        with ExitStack() as resources:
            self._rpc = resources.enter_context(
                RpcClient(f"{remote}/rpc:i", name=f"{local}/rpc:o", names=names)
            )
            self._latest = resources.enter_context(
                LatestMessage(remote, local, carrier, timeout, names, _channels)
            )
            self._resources = resources.pop_all()

    def __repr__(self) -> str:
        return f"<AnalogSensor {self.remote}>"

    def channels(self) -> list[float]:
        """A number for each channel, in the sensor's own units."""
        return [*self._latest.value()]

    def timestamp(self) -> float:
        """When they were measured, seconds (of the sender's clock)."""
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


def _channels(message: Message) -> tuple[float, ...]:
    """Return the values in a message. Raises DecodeError."""
    return tuple(float(each) for each in message.as_(Vector).array)
