"""Board: the joints of a body as a control board, for `yarpy.devices.ControlBoardServer`.

Rules: a controller of positions follows the trajectory, moment by moment, and one of speeds how
fast it goes; both put out the acceleration of the joint.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Generic, TypeVar

from yarpy.kits.devices.control_board.interface import ControlMode, InteractionMode
from yarpy.kits.devices.simulated.pids import SimulatedPids
from yarpy.kits.sim.body import Body, J
from yarpy.kits.sim.joint import Joint
from yarpy.kits.sim.reference import Reference

T = TypeVar("T")


class Board(Generic[J]):
    """A control board with position, position-direct, velocity, mixed and idle mode."""

    def __init__(self, body: Body[J]) -> None:
        self._body = body
        with body.present() as joints:
            axes = [joint.axis for joint in joints]
        self.axis_names = [axis.name for axis in axes]
        self.axis_types = [axis.kind for axis in axes]
        self._time = body.time
        count = len(axes)
        self.pids = {
            "pos": SimulatedPids(
                count,
                lambda: self._each(lambda joint: joint.reference.position - joint.position),
                self.encoder_accelerations,
                lambda: self._each(lambda joint: joint.reference.position),
            ),
            "vel": SimulatedPids(
                count,
                lambda: self._each(lambda joint: joint.reference.speed - joint.speed),
                self.encoder_accelerations,
                lambda: self._each(lambda joint: joint.reference.speed),
            ),
        }

    # -- what is measured ---------------------------------------------------------------------

    def encoders(self) -> list[float]:
        with self._body.present() as joints:
            self._time = self._body.time
            return [joint.position for joint in joints]

    def timestamps(self) -> list[float]:
        """Return the times when the encoders were last read."""
        return [self._time] * len(self.axis_names)

    def encoder_speeds(self) -> list[float]:
        return self._each(lambda joint: joint.speed)

    def encoder_accelerations(self) -> list[float]:
        return self._each(lambda joint: joint.acceleration)

    def motor_encoders(self) -> list[float]:
        return self._each(lambda joint: joint.position)  # each joint has its own motor

    def motor_speeds(self) -> list[float]:
        return self.encoder_speeds()

    def motor_accelerations(self) -> list[float]:
        return self.encoder_accelerations()

    def control_modes(self) -> list[str]:
        return self._each(lambda joint: joint.reference.mode)

    def interaction_modes(self) -> list[str]:
        return [InteractionMode.STIFF] * len(self.axis_names)

    def motion_done(self) -> list[bool]:
        return self._each(lambda joint: joint.done)

    # -- what was commanded -------------------------------------------------------------------

    def position_targets(self) -> list[float]:
        return self._each(lambda joint: joint.reference.target)

    def direct_targets(self) -> list[float]:
        return self._each(lambda joint: joint.reference.direct_target)

    def velocity_targets(self) -> list[float]:
        return self._each(lambda joint: joint.reference.wanted_speed)

    # -- what acts ----------------------------------------------------------------------------

    def position_move(self, joints: Sequence[int], positions: Sequence[float]) -> None:
        self._command(joints, positions, Reference.move_to)

    def relative_move(self, joints: Sequence[int], distances: Sequence[float]) -> None:
        self._command(
            joints, distances, lambda reference, way: reference.move_to(reference.position + way)
        )

    def position_direct(self, joints: Sequence[int], positions: Sequence[float]) -> None:
        self._command(joints, positions, Reference.go_to)

    def velocity_move(self, joints: Sequence[int], speeds: Sequence[float]) -> None:
        self._command(joints, speeds, Reference.move_at)

    def stop(self, joints: Sequence[int]) -> None:
        self._command(joints, joints, lambda reference, _: reference.stop())

    def switch_control_modes(self, joints: Sequence[int], modes: Sequence[str]) -> None:
        known = [ControlMode(mode) for mode in modes]
        self._command(joints, known, Reference.switch)

    def home(self, joints: Sequence[int]) -> None:
        """Move to zero, or as close as the limits allow."""

        def go(reference: Reference, _: int) -> None:
            reference.switch(ControlMode.POSITION)
            reference.move_to(0.0)

        self._command(joints, joints, go)

    park = home

    # -- what is adjusted ---------------------------------------------------------------------

    @property
    def reference_speeds(self) -> list[float]:
        return self._each(lambda joint: joint.reference.reference_speed)

    @reference_speeds.setter
    def reference_speeds(self, values: Sequence[float]) -> None:
        with self._body.present() as joints:
            for joint, value in zip(joints, values, strict=True):
                joint.reference.reference_speed = value

    @property
    def reference_accelerations(self) -> list[float]:
        return self._each(lambda joint: joint.reference.reference_acceleration)

    @reference_accelerations.setter
    def reference_accelerations(self, values: Sequence[float]) -> None:
        with self._body.present() as joints:
            for joint, value in zip(joints, values, strict=True):
                joint.reference.reference_acceleration = value

    @property
    def position_limits(self) -> list[tuple[float, float]]:
        return self._each(lambda joint: joint.reference.limits)

    @position_limits.setter
    def position_limits(self, values: Sequence[tuple[float, float]]) -> None:
        for lowest, highest in values:
            if lowest > highest:
                raise ValueError(f"limits from {lowest} to {highest}: the lower one comes first")
        with self._body.present() as joints:
            for joint, (lowest, highest) in zip(joints, values, strict=True):
                joint.reference.limits = (lowest, highest)

    @property
    def velocity_limits(self) -> list[tuple[float, float]]:
        return self._each(lambda joint: (-joint.axis.top_speed, joint.axis.top_speed))

    # -- inside -------------------------------------------------------------------------------

    def _each(self, read: Callable[[Joint], T]) -> list[T]:
        with self._body.present() as joints:
            return [read(joint) for joint in joints]

    def _command(
        self,
        joints: Sequence[int],
        values: Iterable[T],
        act: Callable[[Reference, T], object],
    ) -> None:
        with self._body.present() as all_joints:
            for joint, value in zip(joints, values, strict=True):
                act(all_joints[joint].reference, value)
