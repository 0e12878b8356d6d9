"""SimulatedArm: an arm of seven joints that goes where its hand is sent, for a CartesianServer.

Rules: the upper arm and the forearm are 0.2 m each; the arm hangs down from a shoulder at the
origin, x forwards, y to the left, z up. A goal out of reach is approached as far as it goes. Motion
follows the time that it is given, with no mass.
"""

from __future__ import annotations

import threading
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from yarpy import clock
from yarpy.kits.devices.controllers.cartesian import HandPose, Solution
from yarpy.kits.devices.refusal import Refused

if TYPE_CHECKING:
    from numpy.typing import NDArray

#: the axis of each joint, and how far the next one is behind it (metres, at rest)
_CHAIN = (
    ((0, 1, 0), (0, 0, 0)),
    ((1, 0, 0), (0, 0, 0)),
    ((0, 0, 1), (0, 0, -0.2)),
    ((0, 1, 0), (0, 0, 0)),
    ((0, 0, 1), (0, 0, -0.2)),
    ((1, 0, 0), (0, 0, 0)),
    ((0, 1, 0), (0, 0, -0.05)),
)
_STEPS = 200


class SimulatedArm:
    """See CartesianController: it has the same members."""

    def __init__(self) -> None:
        count = len(_CHAIN)
        self.tracking = False
        self.reference_mode = True
        self.priority = "position"
        self.trajectory_time = 1.0
        self.tolerance = 0.001
        self.rest_weights = [0.0] * count
        self.joint_limits = [(-150.0, 150.0)] * count
        self.tip: tuple[Sequence[float], Sequence[float]] = ((0.0,) * 3, (0.0,) * 4)
        self._rest = [0.0] * count
        self._used = [1.0] * count
        self._lock = threading.RLock()
        self._to = [0.0] * count
        self._to[3] = -60.0  # a bent elbow can go everywhere
        self._from = self._to[:]
        self._began, self._takes = 0.0, 0.0

    # -- what is adjusted ---------------------------------------------------------------------

    @property
    def dof(self) -> list[float]:
        """The joints that are used."""
        return [*self._used]

    @dof.setter
    def dof(self, values: Sequence[float]) -> None:
        """Use others; 2 leaves one as it is, as do those that are missing."""
        for joint, value in enumerate([*values][: len(self._used)]):
            if value in (0, 1):
                self._used[joint] = float(value)

    @property
    def rest_position(self) -> list[float]:
        return [*self._rest]

    @rest_position.setter
    def rest_position(self, values: Sequence[float]) -> None:
        if len(values) != len(self._rest):
            raise Refused(f"there are {len(self._rest)} joints")
        self._rest = [float(value) for value in values]

    def limits(self, axis: int) -> tuple[float, float]:
        return self.joint_limits[self._joint(axis)]

    def change_limits(self, axis: int, low: float, high: float) -> None:
        if not low <= high:
            raise Refused("the lower limit is above the upper one")
        limits = [*self.joint_limits]
        limits[self._joint(axis)] = (low, high)
        self.joint_limits = limits

    def _joint(self, axis: int) -> int:
        if not 0 <= axis < len(_CHAIN):
            raise Refused(f"no axis {axis}: there are {len(_CHAIN)}")
        return axis

    # -- motion -------------------------------------------------------------------------------

    def joints(self) -> list[float]:
        """Return the positions of the joints, degrees."""
        with self._lock:
            done = self._smooth(self.progress())
            pairs = zip(self._from, self._to, strict=True)
            return [a + (b - a) * done for a, b in pairs]

    def progress(self) -> float:
        """Return which share of the time has passed, from 0 to 1."""
        passed = clock.current().monotonic() - self._began
        return min(passed / self._takes, 1.0) if self._takes > 0 else 1.0

    @staticmethod
    def _smooth(share: float) -> float:
        """The share of the way at a share of the time, with the least jerk."""
        return share**3 * (10 - 15 * share + 6 * share**2)

    def motion_done(self) -> bool:
        return self.progress() >= 1.0

    def is_on(self) -> bool:
        return True

    def go_to(
        self,
        position: Sequence[float],
        orientation: Sequence[float] | None = None,
        seconds: float = 0.0,
    ) -> None:
        found = self.solve(position, orientation)
        self._begin([*found.joints], seconds or self.trajectory_time)

    def move(self, velocity: Sequence[float], turning: Sequence[float]) -> None:
        """Move at a velocity for a second: as long as it is told again, it goes on."""
        here = self.pose()
        goal = [a + b for a, b in zip(here.position, velocity, strict=True)]
        self._begin([*self.solve(goal).joints], 1.0)

    def stop(self) -> None:
        with self._lock:
            here = self.joints()
            self._from, self._to, self._takes = here, here, 0.0

    def _begin(self, goal: list[float], seconds: float) -> None:
        with self._lock:
            self._from, self._to = self.joints(), goal
            self._began, self._takes = clock.current().monotonic(), max(seconds, 0.0)

    # -- where it is --------------------------------------------------------------------------

    def pose(self, axis: int | None = None) -> HandPose:
        frames = _forward(self.joints())
        found = frames[-1] @ self._tip() if axis is None else frames[self._joint(axis)]
        return HandPose(tuple(found[:3, 3]), _axis_angle(found[:3, :3]), clock.now())

    def state(self) -> tuple[float, ...]:
        """Seven numbers: where the hand is."""
        found = self.pose()
        return (*found.position, *found.orientation)

    def desired(self) -> Solution:
        return self._told(self._to)

    def joint_velocities(self) -> list[float]:
        share = self.progress()
        if share >= 1.0:
            return [0.0] * len(self._to)
        slope = 30 * share**2 * (1 - share) ** 2 / self._takes
        return [(b - a) * slope for a, b in zip(self._from, self._to, strict=True)]

    def task_velocities(self) -> tuple[Sequence[float], Sequence[float]]:
        import numpy as np

        _, jacobian = _reach(np.radians(self.joints()), self._tip())
        found = jacobian @ np.radians(self.joint_velocities())
        turning = float(np.linalg.norm(found[3:]))
        axis = found[3:] / turning if turning else found[3:]
        return tuple(found[:3]), (*axis, turning)

    def solve(
        self,
        position: Sequence[float],
        orientation: Sequence[float] | None = None,
        start: Sequence[float] | None = None,
    ) -> Solution:
        """Follow the error down the damped inverse of the Jacobian (Nakamura, Hanafusa 1986)."""
        import numpy as np

        joints = np.radians(self.joints() if start is None else [*start])
        if joints.shape != (len(_CHAIN),) or not np.isfinite([*joints, *position]).all():
            raise Refused(f"a goal is finite, and there are {len(_CHAIN)} joints")
        low, high = np.radians(np.array(self.joint_limits).T)
        turned = None if orientation is None else _rotation(orientation)
        used = np.array(self._used)
        for _ in range(_STEPS):
            frame, jacobian = _reach(joints, self._tip())
            error = np.zeros(6)
            error[:3] = np.array(position) - frame[:3, 3]
            if turned is not None:
                *axis, angle = _axis_angle(turned @ frame[:3, :3].T)
                error[3:] = np.array(axis) * angle
            rows = 3 if turned is None else 6
            j = (jacobian * used)[:rows]
            if np.linalg.norm(error[:rows]) < 1e-6:
                break
            step = j.T @ np.linalg.solve(j @ j.T + 1e-4 * np.eye(rows), error[:rows])
            joints = np.clip(joints + np.clip(step, -0.3, 0.3), low, high)
        return self._told(np.degrees(joints).tolist())

    def _told(self, joints: Sequence[float]) -> Solution:
        frame = _forward(joints)[-1] @ self._tip()
        return Solution(tuple(frame[:3, 3]), _axis_angle(frame[:3, :3]), tuple(joints))

    def _tip(self) -> NDArray[Any]:
        import numpy as np

        frame = np.eye(4)
        frame[:3, :3], frame[:3, 3] = _rotation(self.tip[1]), self.tip[0]
        return frame


def _rotation(axis_angle: Sequence[float]) -> NDArray[Any]:
    """The matrix of an axis and an angle (Rodrigues)."""
    import numpy as np

    axis = np.array(axis_angle[:3], float)
    size = float(np.linalg.norm(axis))
    if not size:
        return np.eye(3)
    x, y, z = axis / size
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = float(axis_angle[3])
    found: NDArray[Any] = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return found


def _axis_angle(m: NDArray[Any]) -> tuple[float, ...]:
    """The axis and angle of a matrix, the angle from 0 to pi."""
    import numpy as np

    axis = np.array([m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]])
    size = float(np.linalg.norm(axis))
    angle = float(np.arctan2(size, np.trace(m) - 1))
    if size < 1e-9:
        if angle < 1.0:
            return 1.0, 0.0, 0.0, 0.0
        column = int(np.argmax(np.diag(m)))  # half a turn
        axis = m[:, column] + np.eye(3)[:, column]
        size = float(np.linalg.norm(axis))
    return (*map(float, axis / size), angle)


def _forward(joints: Sequence[float]) -> list[NDArray[Any]]:
    """Return the frame of each joint, a 4 x 4 matrix; joints in degrees."""
    import numpy as np

    frames, frame = [], np.eye(4)
    for (axis, behind), angle in zip(_CHAIN, joints, strict=True):
        step = np.eye(4)
        step[:3, :3] = _rotation((*axis, float(np.radians(angle))))
        frame = frame @ step
        step = np.eye(4)
        step[:3, 3] = behind
        frame = frame @ step
        frames.append(frame)
    return frames


def _reach(joints: NDArray[Any], tip: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return the frame of the tip, and the Jacobian (how it moves with each joint): metres and
    radians."""
    import numpy as np

    frames = _forward(np.degrees(joints).tolist())
    end = frames[-1] @ tip
    jacobian = np.zeros((6, len(_CHAIN)))
    before = np.eye(4)
    for at, ((axis, _), frame) in enumerate(zip(_CHAIN, frames, strict=True)):
        around = before[:3, :3] @ np.array(axis, float)
        jacobian[:3, at] = np.cross(around, end[:3, 3] - before[:3, 3])
        jacobian[3:, at] = around
        before = frame
    return end, jacobian
