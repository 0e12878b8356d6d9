"""The pose of the base of a MuJoCo model, for `Odometry2D` and `Localization2D` of `yarpy.devices`.

Rules: the base is the first body with a free joint. Its place is the true one, in the map `world`;
odometry counts from where it began, or was told to begin anew.
"""

from __future__ import annotations

from math import atan2, cos, degrees, sin
from typing import Final

from yarpy.kits.devices.interfaces.place import Odometry, Place
from yarpy.kits.sim.mujoco.model import Model, mujoco

#: The map in which places are.
WORLD: Final = "world"


class Base:
    """A base that moves freely; metres, degrees, seconds."""

    def __init__(self, model: Model, joint: int) -> None:
        self._model = model
        self._joint = joint
        self._start = self._now()[0]

    def position(self) -> Place:
        """Return where it is."""
        x, y, theta = self._now()[0]
        return Place(WORLD, x, y, degrees(theta))

    def estimates(self) -> list[Place]:
        """Return the places where it may be: the one where it is."""
        return [self.position()]

    def localization_status(self) -> str:
        """Return the status in C++'s word: the pose is always known."""
        return "locy"

    def odometry(self) -> Odometry:
        """Return how it has moved since it began, and its speed."""
        (x, y, theta), (ahead, left, turning) = self._now()
        begin_x, begin_y, begin = self._start
        (far, wide), (vx, vy) = (
            _turned(*each, -begin) for each in ((x - begin_x, y - begin_y), (ahead, left))
        )
        base_x, base_y = _turned(ahead, left, -theta)
        turned = (degrees(theta - begin) + 180.0) % 360.0 - 180.0
        speed = degrees(turning)
        return Odometry(far, wide, turned, base_x, base_y, speed, vx, vy, speed)

    def reset_odometry(self) -> None:
        """Begin anew, at 0."""
        self._start = self._now()[0]

    def _now(self) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
        """Return place and speed in the world: x, y, and the angle in radians."""
        with self._model.present():
            model, data = self._model.model, self._model.data
            at, freedom = int(model.jnt_qposadr[self._joint]), int(model.jnt_dofadr[self._joint])
            x, y, _, w, i, j, k = data.qpos[at : at + 7].tolist()
            # MuJoCo has the speed of a free body in the world, and its turning in the body.
            ahead, left, _, *turning = data.qvel[freedom : freedom + 6].tolist()
        theta = atan2(2 * (w * k + i * j), 1 - 2 * (j * j + k * k))
        # The third row of the rotation takes the turning about the body's axes to that about z.
        row = (2 * (i * k - w * j), 2 * (j * k + w * i), 1 - 2 * (i * i + j * j))
        about = sum(part * speed for part, speed in zip(row, turning, strict=True))
        return (x, y, theta), (ahead, left, about)


def base_of(model: Model) -> Base | None:
    """Return the base of a model; None if nothing in it moves freely."""
    free = int(mujoco().mjtJoint.mjJNT_FREE)
    for joint in range(model.model.njnt):
        if int(model.model.jnt_type[joint]) == free:
            return Base(model, joint)
    return None


def _turned(x: float, y: float, angle: float) -> tuple[float, float]:
    return x * cos(angle) - y * sin(angle), x * sin(angle) + y * cos(angle)
