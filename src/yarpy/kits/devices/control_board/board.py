"""A user's control board: its joints, its controllers and the last commands.

Rules: those of `access`. Targets that a device does not remember itself are remembered here.
"""

from __future__ import annotations

import threading
from collections.abc import Mapping, Sequence
from typing import Any, Final

from yarpy import clock
from yarpy.kits.devices.access import Access
from yarpy.kits.devices.kind import FLOAT, JOINT_TYPE, Kind
from yarpy.kits.devices.refusal import DeviceErrorLog, Refused

#: Member with the last targets -> the method that sets them.
TARGETS: Final = {
    "position_targets": "position_move",
    "direct_targets": "position_direct",
    "velocity_targets": "velocity_move",
    "direct_velocity_targets": "velocity_direct",
    "torque_targets": "apply_torques",
    "current_targets": "apply_currents",
    "duty_cycle_targets": "apply_duty_cycles",
}
_COMMANDED: Final = {command: targets for targets, command in TARGETS.items()}


class Board(Access):
    """A control board. Remembers the last targets for devices that do not."""

    def __init__(self, device: object, name: str) -> None:
        super().__init__(device, 0, DeviceErrorLog(name), threading.Lock())
        self.name = name
        names = self.ask("axis_names") if self.has("axis_names") else None
        if isinstance(names, str) or names is None or not len(names):
            raise ValueError(f"{name}: the device needs axis_names, a list with all its joints")
        if not self.has("encoders"):
            raise ValueError(f"{name}: the device needs encoders(), the positions of its joints")
        self.count = len(names)
        self._memory: dict[str, list[float]] = {}

    def pid(self, kind: str) -> Access:
        """The controllers of one kind."""
        controllers = self.ask("pids")
        found = controllers.get(kind) if isinstance(controllers, Mapping) else None
        if found is None:
            raise Refused(f"the device has no {kind} controllers")
        return Access(found, self.count, self._complain, self._lock)

    def values(self, member: str, kind: Kind = FLOAT) -> list[Any]:
        command = TARGETS.get(member)
        if not self.has(member):
            if command is not None and self.has(command):
                return self._remembered(member)
            if kind is JOINT_TYPE:
                return ["revolute"] * self.count
        return super().values(member, kind)

    def timestamps(self) -> list[float]:
        """Return the times when the encoders were read, seconds."""
        if self.has("timestamps"):
            return super().values("timestamps")
        return [clock.now()] * self.count

    def apply(self, member: str, joints: Sequence[int], values: Sequence[Any] | None) -> None:
        if member == "relative_move" and values is not None:
            self._move_by(joints, values)
            return
        super().apply(member, joints, values)
        targets = _COMMANDED.get(member)
        if targets is not None and values is not None:
            self._remember(targets, joints, values)
        elif member == "stop":
            for member in ("velocity_targets", "direct_velocity_targets"):
                self._remember(member, joints, [0.0] * len(joints))

    def _move_by(self, joints: Sequence[int], values: Sequence[float]) -> None:
        own = self.has("relative_move")
        if own and self.has("position_targets"):
            super().apply("relative_move", joints, values)
            return
        self._check(joints)
        here = self.values("encoders")
        there = [here[joint] + value for joint, value in zip(joints, values, strict=True)]
        if own:
            super().apply("relative_move", joints, values)
            self._remember("position_targets", joints, there)
        else:
            self.apply("position_move", joints, there)

    def _remembered(self, targets: str) -> list[float]:
        known = self._memory.get(targets)
        if known is not None:
            return [*known]
        if targets in ("position_targets", "direct_targets"):
            return self.values("encoders")  # not moved yet: its target is where it is
        return [0.0] * self.count

    def _remember(self, targets: str, joints: Sequence[int], values: Sequence[float]) -> None:
        try:
            known = self._remembered(targets)
        except Refused:  # the move itself succeeded
            known = [0.0] * self.count
        for joint, value in zip(joints, values, strict=True):
            known[joint] = value
        self._memory[targets] = known
