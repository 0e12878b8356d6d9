"""SimulatedHead: a head with two eyes that looks where it is sent, for a GazeServer.

Rules: x points backwards, y to the right, z up, as in the iCub; the eyes are 0.3 m above the
origin and 68 mm apart. Both cameras look along the gaze: 320 x 240 pixels, 250 pixels of focal
length. Angles are degrees: azimuth to the right, elevation, vergence.
"""

from __future__ import annotations

import threading
from collections.abc import Sequence
from math import atan2, cos, degrees, hypot, radians, sin, tan
from typing import Any, ClassVar

from yarpy import clock
from yarpy.data.bottle import Bottle
from yarpy.kits.devices.controllers.cartesian import HandPose
from yarpy.kits.devices.refusal import Refused

HEIGHT = 0.3
BASELINE = 0.068
FOCAL, CENTRE = 250.0, (160.0, 120.0)
_SIDES = {"left": -0.5, "right": 0.5, "head": 0.0}

Point = tuple[float, float, float]


class SimulatedHead:
    """See GazeController: it has the same members."""

    RANGES: ClassVar = {"pitch": (-40.0, 30.0), "roll": (-60.0, 60.0), "yaw": (-55.0, 55.0)}

    def __init__(self) -> None:
        self.neck_time, self.eyes_time = 0.75, 0.25
        self.vor_gain, self.ocr_gain = 1.0, 0.0
        self.saccade_inhibition, self.saccade_angle = 0.3, 10.0
        self.neck_tolerance = 0.0
        self.tracking = self.stabilization = False
        self.saccades = True
        self.ranges = dict(self.RANGES)
        self.kept_vergence = -1.0
        self._options = Bottle()
        self._lock = threading.RLock()
        self._from = self._to = (0.0, 0.0, 5.0)
        self._began, self._takes = 0.0, 0.0

    # -- motion -------------------------------------------------------------------------------

    def progress(self) -> float:
        """Return which share of the time has passed, from 0 to 1."""
        passed = clock.current().monotonic() - self._began
        return min(passed / self._takes, 1.0) if self._takes > 0 else 1.0

    def motion_done(self) -> bool:
        return self.progress() >= 1.0

    def saccade_done(self) -> bool:
        return clock.current().monotonic() - self._began >= min(self.eyes_time, self._takes)

    def angles(self) -> Point:
        with self._lock:
            share = self.progress()
            done = share**3 * (10 - 15 * share + 6 * share**2)
            a, e, v = (p + (q - p) * done for p, q in zip(self._from, self._to, strict=True))
        return a, e, v

    def look_at(self, point: Sequence[float]) -> None:
        self.turn_to(self.direction(point))

    def turn_to(self, angles: Sequence[float], relative: bool = False) -> None:
        with self._lock:
            here = self.angles()
            goal = [*angles]
            if relative:
                goal = [a + b for a, b in zip(here, goal, strict=True)]
            if self.kept_vergence >= 0:
                goal[2] = self.kept_vergence
            self._from = here
            self._to = (goal[0], min(max(goal[1], -89.0), 89.0), max(goal[2], 0.0))
            self._began, self._takes = clock.current().monotonic(), self.neck_time

    def stop(self) -> None:
        with self._lock:
            self._from = self._to = self.angles()
            self._takes = 0.0

    # -- geometry -----------------------------------------------------------------------------

    def fixation_point(self) -> Point:
        return self.point_in_direction(self.angles())

    def distance(self, vergence: float) -> float:
        """Return how far away the eyes meet."""
        return BASELINE / 2 / tan(radians(max(vergence, 0.01)) / 2)

    def point_in_direction(self, angles: Sequence[float], relative: bool = False) -> Point:
        if relative:
            angles = [a + b for a, b in zip(self.angles(), angles, strict=True)]
        far, (azimuth, elevation) = self.distance(angles[2]), map(radians, angles[:2])
        flat = far * cos(elevation)
        return -flat * cos(azimuth), flat * sin(azimuth), HEIGHT + far * sin(elevation)

    def direction(self, point: Sequence[float]) -> Point:
        x, y, z = point
        flat, up = hypot(x, y), z - HEIGHT
        far = hypot(flat, up)
        if far < 0.01:
            raise Refused("this point is between the eyes")
        vergence = 2 * atan2(BASELINE / 2, far)
        return degrees(atan2(y, -x)), degrees(atan2(up, flat)), degrees(vergence)

    def _camera(self, camera: str) -> tuple[Any, Any]:
        """Return the position of a camera, and its axes: right, down, forwards."""
        import numpy as np

        azimuth, elevation, _ = map(radians, self.angles())
        ahead = np.array(
            [-cos(elevation) * cos(azimuth), cos(elevation) * sin(azimuth), sin(elevation)]
        )
        right = np.array([sin(azimuth), cos(azimuth), 0.0])
        axes = np.array([right, np.cross(ahead, right), ahead])
        if camera not in _SIDES:
            raise Refused("cameras are left and right")
        return np.array([0.0, 0.0, HEIGHT]) + _SIDES[camera] * BASELINE * right, axes

    def pixel(self, camera: str, point: Sequence[float]) -> tuple[float, float]:
        import numpy as np

        at, axes = self._camera(camera)
        x, y, z = axes @ (np.array(point) - at)
        if z <= 0:
            raise Refused("this point is behind the cameras")
        return CENTRE[0] + FOCAL * x / z, CENTRE[1] + FOCAL * y / z

    def _ray(self, camera: str, pixel: Sequence[float]) -> tuple[Any, Any]:
        """Return the position of a camera, and the vector from there to what a pixel shows one
        metre ahead."""
        import numpy as np

        at, axes = self._camera(camera)
        u, v = ((a - b) / FOCAL for a, b in zip(pixel, CENTRE, strict=True))
        return at, np.array([u, v, 1.0]) @ axes

    def point(self, camera: str, pixel: Sequence[float], distance: float) -> Point:
        at, ray = self._ray(camera, pixel)
        return _point(at + distance * ray)

    def point_on_plane(self, camera: str, pixel: Sequence[float], plane: Sequence[float]) -> Point:
        import numpy as np

        at, ray = self._ray(camera, pixel)
        slope = float(np.dot(plane[:3], ray))
        if not slope:
            raise Refused("the plane lies along the view")
        return _point(at - (float(np.dot(plane[:3], at)) + plane[3]) / slope * ray)

    def triangulate(self, left: Sequence[float], right: Sequence[float]) -> Point:
        """The middle of where both rays are nearest to each other."""
        import numpy as np

        (a, p), (b, q) = self._ray("left", left), self._ray("right", right)
        found, *_ = np.linalg.lstsq(np.array([p, -q]).T, b - a, rcond=None)
        return _point((a + found[0] * p + b + found[1] * q) / 2)

    def pose(self, what: str) -> HandPose:
        import numpy as np

        at, axes = self._camera(what)
        m = axes.T
        twist = np.array([m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]])
        size = float(np.linalg.norm(twist))
        angle = atan2(size, float(np.trace(m)) - 1)
        axis = twist / size if size > 1e-9 else np.array([1.0, 0.0, 0.0])
        return HandPose(_point(at), (*map(float, axis), angle), clock.now())

    # -- joints -------------------------------------------------------------------------------

    def joints(self) -> tuple[float, ...]:
        return self._joints(self.angles())

    def desired_joints(self) -> tuple[float, ...]:
        return self._joints(self._to)[3:]

    def _joints(self, angles: Point) -> tuple[float, ...]:
        """The neck goes as far as it may, the eyes the rest: torso, neck, eyes."""
        azimuth, elevation, vergence = angles
        roll = min(max(0.0, self.ranges["roll"][0]), self.ranges["roll"][1])
        pitch = min(max(elevation, self.ranges["pitch"][0]), self.ranges["pitch"][1])
        yaw = min(max(-azimuth, self.ranges["yaw"][0]), self.ranges["yaw"][1])
        return 0.0, 0.0, 0.0, pitch, roll, yaw, elevation - pitch, azimuth + yaw, vergence

    def joint_velocities(self) -> tuple[float, ...]:
        share = self.progress()
        before, behind = self._joints(self._from)[3:], self._joints(self._to)[3:]
        slope = 30 * share**2 * (1 - share) ** 2 / self._takes if share < 1.0 else 0.0
        return tuple((b - a) * slope for a, b in zip(before, behind, strict=True))

    def bind_neck(self, joint: str, low: float, high: float) -> None:
        least, most = self.RANGES[joint]
        if not low <= high:
            raise Refused("the lower limit is above the upper one")
        bound = (min(max(low, least), most), min(max(high, least), most))
        self.ranges = {**self.ranges, joint: bound}

    def neck_range(self, joint: str) -> tuple[float, float]:
        found: tuple[float, float] = self.ranges[joint]
        return found

    def bind_eyes(self, vergence: float) -> None:
        self.kept_vergence = max(vergence, 0.0)

    def bound_vergence(self) -> float:
        return self.kept_vergence

    def free(self, joint: str) -> None:
        if joint == "eyes":
            self.kept_vergence = -1.0
        else:
            self.ranges = {**self.ranges, joint: self.RANGES[joint]}

    def stereo_options(self) -> Bottle:
        return self._options

    def change_stereo_options(self, options: Bottle) -> None:
        self._options = options


def _point(found: Any) -> Point:
    x, y, z = map(float, found)
    return x, y, z
