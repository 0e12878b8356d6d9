"""A user's device, used by the rules that `control_board` states.

Rules: one thread at a time, but for what may take long. Nothing gets to the device that was not
checked, nothing from it goes on that is not what was promised. Whatever a device raises becomes
`Refused`, with one line in the log; NotImplementedError means that it does not have this, and
needs none.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Final, TypeVar

from yarpy.devices.kind import FLOAT, JOINT_TYPE, Kind
from yarpy.devices.refusal import Complaints, Refused
from yarpy.errors import LocalProtocolError

T = TypeVar("T")

#: What may take long is called beside everything else.
_LONG: Final = frozenset(
    ("calibrate", "calibrate_joint", "home", "park", "quit_calibration", "quit_parking")
)

#: What was commanded -> the method that commands it.
TARGETS: Final = {
    "position_targets": "position_move",
    "direct_targets": "position_direct",
    "velocity_targets": "velocity_move",
    "torque_targets": "apply_torques",
    "current_targets": "apply_currents",
    "duty_cycle_targets": "apply_duty_cycles",
}
_COMMANDED: Final = {command: targets for targets, command in TARGETS.items()}

_MISSING: Final[Any] = object()


class Part:
    """An object with methods and attributes for `count` joints; all of it may be missing."""

    def __init__(
        self, target: object, count: int, complain: Complaints, lock: threading.Lock
    ) -> None:
        self.target = target
        self.count = count
        self._complain = complain
        # Users write classes without a thought of threads: requests, commands and the publisher
        # come from different ones.
        self._lock = lock

    def has(self, member: str) -> bool:
        """Whether the device can do this, or has it."""
        # A property of the class is there even if it fails now; looking at it could run long.
        return hasattr(type(self.target), member) or hasattr(self.target, member)

    def offers(self, members: Iterable[str]) -> bool:
        """Whether the device has at least one of these."""
        return any(self.has(member) for member in members)

    def values(self, member: str, kind: Kind = FLOAT) -> list[Any]:
        """The values of all joints. Raises Refused: missing, failed, or not as promised."""

        def check(found: Any) -> list[Any]:
            values = [kind.check(value) for value in (found() if callable(found) else found)]
            if len(values) != self.count:
                raise ValueError(f"{len(values)} values for {self.count} joints")
            return values

        return self.use(member, check)

    def ask(self, member: str, *arguments: object) -> Any:
        """What a method returns, or an attribute. Raises Refused."""
        return self.use(member, lambda found: found(*arguments) if callable(found) else found)

    def use(self, member: str, action: Callable[[Any], T]) -> T:
        """Do something with a member, whatever may happen. Raises Refused."""
        try:
            if member in _LONG:
                return action(self._get(member))
            with self._lock:
                return action(self._get(member))
        except Refused:
            raise
        except (NotImplementedError, LocalProtocolError) as error:
            raise Refused(f"the device has no {member}: {error}") from error
        except Exception as error:
            self._complain(member, error)
            raise Refused(f"{member} failed") from error

    def apply(self, member: str, joints: Sequence[int], values: Sequence[Any] | None) -> None:
        """Call a method for these joints, or change an attribute. Raises Refused."""
        self._check(joints)

        def act(found: Any) -> None:
            if not callable(found):
                self._assign(member, found, joints, values)
            elif values is None:
                found([*joints])
            else:
                found([*joints], [*values])

        self.use(member, act)

    def store(self, member: str, value: object) -> None:
        """Assign to an attribute that the device has. Raises Refused."""
        self.use(member, lambda found: setattr(self.target, member, value))

    def _check(self, joints: Sequence[int]) -> None:
        if not joints:
            raise Refused("no joints are named")
        for joint in joints:
            if not 0 <= joint < self.count:
                raise Refused(f"no joint {joint} (there are 0 to {self.count - 1})")

    def _get(self, member: str) -> Any:
        found = getattr(self.target, member, _MISSING)
        if found is _MISSING:
            raise Refused(f"the device has no {member}")
        return found

    def _assign(
        self, member: str, found: Any, joints: Sequence[int], values: Sequence[Any] | None
    ) -> None:
        if values is None:
            raise Refused(f"{member} is an attribute: it needs values")
        changed = [*found]
        for joint, value in zip(joints, values, strict=True):
            changed[joint] = value
        setattr(self.target, member, changed)


class Board(Part):
    """A control board. What it was told last is remembered, for devices that do not."""

    def __init__(self, device: object, name: str) -> None:
        super().__init__(device, 0, Complaints(name), threading.Lock())
        self.name = name
        names = self.ask("axis_names") if self.has("axis_names") else None
        if isinstance(names, str) or names is None or not len(names):
            raise ValueError(f"{name}: the device needs axis_names, a list with all its joints")
        if not self.has("encoders"):
            raise ValueError(f"{name}: the device needs encoders(), the positions of its joints")
        self.count = len(names)
        self._memory: dict[str, list[float]] = {}

    def pid(self, kind: str) -> Part:
        """The controllers of one kind."""
        controllers = self.ask("pids")
        found = controllers.get(kind) if isinstance(controllers, Mapping) else None
        if found is None:
            raise Refused(f"the device has no {kind} controllers")
        return Part(found, self.count, self._complain, self._lock)

    def values(self, member: str, kind: Kind = FLOAT) -> list[Any]:
        command = TARGETS.get(member)
        if not self.has(member):
            if command is not None and self.has(command):
                return self._remembered(member)
            if kind is JOINT_TYPE:
                return ["revolute"] * self.count
        return super().values(member, kind)

    def timestamps(self) -> list[float]:
        """When the encoders were read, seconds."""
        if self.has("timestamps"):
            return super().values("timestamps")
        return [time.time()] * self.count

    def apply(self, member: str, joints: Sequence[int], values: Sequence[Any] | None) -> None:
        if member == "relative_move" and values is not None:
            self._move_by(joints, values)
            return
        super().apply(member, joints, values)
        targets = _COMMANDED.get(member)
        if targets is not None and values is not None:
            self._remember(targets, joints, values)
        elif member == "stop":
            self._remember("velocity_targets", joints, [0.0] * len(joints))

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
            return self.values("encoders")  # nobody moved it yet: it is meant to be where it is
        return [0.0] * self.count

    def _remember(self, targets: str, joints: Sequence[int], values: Sequence[float]) -> None:
        try:
            known = self._remembered(targets)
        except Refused:  # it moved all the same
            known = [0.0] * self.count
        for joint, value in zip(joints, values, strict=True):
            known[joint] = value
        self._memory[targets] = known
