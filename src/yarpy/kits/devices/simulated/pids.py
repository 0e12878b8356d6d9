"""SimulatedPids: the controllers of simulated joints, of one kind.

Rules: it has the members that `control_board.interface.PidController` describes. What is set is
remembered, and changes nothing, as in C++'s fakeMotionControl; what they measure is given. An
offset is one of the gains.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from yarpy.kits.devices.control_board.interface import Gains
from yarpy.kits.devices.refusal import Refused

Read = Callable[[], list[float]]


class SimulatedPids:
    """Controllers of `count` joints. errors, outputs: return what they measure. targets: returns
    what they follow, where that comes from commands of the board; then setting it is refused.
    """

    def __init__(
        self, count: int, errors: Read, outputs: Read, targets: Read | None = None
    ) -> None:
        self.gains: Sequence[Sequence[float]] = [Gains()] * count
        self.error_limits: Sequence[float] = [0.0] * count
        self.enabled: Sequence[bool] = [targets is not None] * count
        self.errors, self.outputs = errors, outputs
        self._followed = targets
        self._targets = [0.0] * count

    @property
    def targets(self) -> list[float]:
        return [*self._targets] if self._followed is None else self._followed()

    @targets.setter
    def targets(self, values: Sequence[float]) -> None:
        if self._followed is not None:
            raise Refused("these controllers follow the commands of the board: move its joints")
        self._targets = [*values]

    @property
    def offsets(self) -> list[float]:
        return [Gains(*gains).offset for gains in self.gains]

    @offsets.setter
    def offsets(self, values: Sequence[float]) -> None:
        pairs = zip(self.gains, values, strict=True)
        self.gains = [Gains(*gains)._replace(offset=value) for gains, value in pairs]

    def reset(self, joints: Sequence[int]) -> None:
        """Do nothing: there is no integral."""
