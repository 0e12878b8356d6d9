"""SimulatedAnalogSensor: a sensor with channels, without hardware; fakeAnalogSensor in C++.

Rules: it has the members that `analog.interface` describes. The first channel is the time, as in
C++; a calibration takes the values of that moment away.
"""

from __future__ import annotations

from collections.abc import Sequence

from yarpy import clock


class SimulatedAnalogSensor:
    """A sensor that measures the time, in seconds, and nothing else. count: of its channels."""

    def __init__(self, count: int = 1) -> None:
        self._shift = [0.0] * count

    def channels(self) -> list[float]:
        """The time, and zeros."""
        return [value - shift for value, shift in zip(self._read(), self._shift, strict=True)]

    def states(self) -> list[str]:
        """Return the state of each channel: all of them work."""
        return ["ok"] * len(self._shift)

    def calibrate(self, values: Sequence[float] | None = None) -> None:
        """Let the present values count as zero, or as these. Raises ValueError for another number
        of them."""
        found = [0.0] * len(self._shift) if values is None else [*values]
        if len(found) != len(self._shift):
            raise ValueError(f"{len(found)} values for {len(self._shift)} channels")
        self._shift = [now - value for now, value in zip(self._read(), found, strict=True)]

    def calibrate_channel(self, channel: int, value: float | None = None) -> None:
        """Let the present value of a channel count as zero, or as this. Raises ValueError for a
        channel that it has not."""
        if not 0 <= channel < len(self._shift):
            raise ValueError(f"no channel {channel} (there are 0 to {len(self._shift) - 1})")
        self._shift[channel] = self._read()[channel] - (value or 0.0)

    def _read(self) -> list[float]:
        return [clock.now(), *[0.0] * (len(self._shift) - 1)]
