"""SimulatedJoints: a control board without hardware, fakeMotionControl in C++.

Rules: it has the members that `control_board.interface` describes, and does at once what it is
told. Errors and outputs of its controllers are the numbers that fakeMotionControl has.
"""

from __future__ import annotations

from collections.abc import Sequence

from yarpy.kits.devices.simulated.pids import Read, SimulatedPids


class SimulatedJoints:
    """Joints that are at once where they are sent."""

    def __init__(self, axis_names: Sequence[str]) -> None:
        self.axis_names = [*axis_names]
        count = len(self.axis_names)
        self.axis_types = ["revolute"] * count
        self.reference_speeds = [10.0] * count
        self.reference_accelerations = [10.0] * count
        self.position_limits = [(-180.0, 180.0)] * count
        self.velocity_limits = [(0.0, 100.0)] * count
        self.automatic_brakes = [False] * count
        self.pids = {
            kind: SimulatedPids(count, *_measured(number, count))
            for number, kind in enumerate(("pos", "vel", "cur", "trq"), 1)
        }
        self._at = [0.0] * count
        self._torques = [0.0] * count
        self._braked = [False] * count
        self._modes = ["pos"] * count
        self._stiff = ["stif"] * count

    def encoders(self) -> list[float]:
        return [*self._at]

    def encoder_speeds(self) -> list[float]:
        return [0.0] * len(self._at)

    def torques(self) -> list[float]:
        return [*self._torques]

    def update_measures(self, values: Sequence[float]) -> None:
        """Take these torques for measured, from the first joint on (`analog.virtual`)."""
        self._torques[: len(values)] = values[: len(self._torques)]

    def control_modes(self) -> list[str]:
        return [*self._modes]

    def interaction_modes(self) -> list[str]:
        return [*self._stiff]

    def motion_done(self) -> list[bool]:
        return [True] * len(self._at)

    def position_move(self, joints: Sequence[int], positions: Sequence[float]) -> None:
        """Be there; not beyond the limits."""
        for joint, position in zip(joints, positions, strict=True):
            lowest, highest = self.position_limits[joint]
            if not self._braked[joint]:
                self._at[joint] = min(max(position, lowest), highest)

    position_direct = position_move

    def velocity_move(self, joints: Sequence[int], speeds: Sequence[float]) -> None:
        """Stay: nothing moves by itself here."""

    velocity_direct = velocity_move

    def braked(self) -> list[bool]:
        return [*self._braked]

    def apply_brakes(self, joints: Sequence[int], active: Sequence[bool]) -> None:
        """Hold these joints, or release them; what is held does not move."""
        for joint, held in zip(joints, active, strict=True):
            self._braked[joint] = held

    def stop(self, joints: Sequence[int]) -> None:
        """Nothing moves."""

    def switch_control_modes(self, joints: Sequence[int], modes: Sequence[str]) -> None:
        for joint, mode in zip(joints, modes, strict=True):
            self._modes[joint] = "idl" if mode == "fidl" else mode

    def switch_interaction_modes(self, joints: Sequence[int], modes: Sequence[str]) -> None:
        for joint, mode in zip(joints, modes, strict=True):
            self._stiff[joint] = mode


def _measured(number: int, count: int) -> tuple[Read, Read]:
    """Return what reads errors and outputs of the controllers of a kind."""
    first = 1 + number / 10
    return lambda: [number / 10] * count, lambda: [first + 10 * joint for joint in range(count)]
