"""IBattery and IFrameTransform: views of a battery, and of a server of frames.

Rules: methods without a place for the result return it, as the bindings do: 0, "" or an empty list
where there is none.
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable
from math import atan2, cos, hypot, sin
from operator import mul
from typing import Any

import yarpy
from yarp._matrix import Matrix
from yarp._numbers import store
from yarp._view import FAILURES, View
from yarpy.kits import devices


class IBattery(View):
    """The state of a battery."""

    (
        BATTERY_OK_STANDBY,
        BATTERY_OK_IN_CHARGE,
        BATTERY_OK_IN_USE,
        BATTERY_GENERAL_ERROR,
        BATTERY_TIMEOUT,
        BATTERY_LOW_WARNING,
        BATTERY_CRITICAL_WARNING,
    ) = range(7)

    def getBatteryVoltage(self) -> float:
        """V."""
        return self._number("voltage")

    def getBatteryCurrent(self) -> float:
        """A."""
        return self._number("current")

    def getBatteryCharge(self) -> float:
        """Percent."""
        return self._number("charge")

    def getBatteryTemperature(self) -> float:
        """Degrees Celsius."""
        return self._number("temperature")

    def getBatteryStatus(self) -> int:
        """The number of its status: standby, in charge, in use, error, timeout, low, critical."""
        found: list[Any] = []
        if self._tell(lambda: found.append(self._board.status())) and found[0] in devices.BATTERY:
            return devices.BATTERY.index(found[0])
        return devices.BATTERY.index("error")

    def getBatteryInfo(self) -> str:
        """Return the description of the battery; "" without one."""
        found: list[str] = []
        return found[0] if self._tell(lambda: found.append(str(self._board.info))) else ""

    def _number(self, member: str) -> float:
        found: list[float] = []
        ok = self._tell(lambda: found.append(float(getattr(self._board, member)())))
        return found[0] if ok else 0.0


class IFrameTransform(View):
    """Frames, and where they are. A transform is where `target` is, seen from `source`."""

    TRANSFORM_OK, TRANSFORM_GENERAL_ERROR, TRANSFORM_TIMEOUT = range(3)

    def allFramesAsString(self) -> str:
        """The names of all frames."""
        return " ".join(self.getAllFrameIds())

    def getAllFrameIds(self) -> list[str]:
        """The names of all frames."""
        found: list[str] = []
        return found if self._tell(lambda: found.extend(self._board.frames())) else []

    def getParent(self, frame_id: str) -> str:
        """From where a frame is seen; "unknown" if nobody has told."""
        with contextlib.suppress(*FAILURES):
            for each in self._board.all():
                if each.target == frame_id:
                    return str(each.source)
        return "unknown"

    def frameExists(self, frame_id: str) -> bool:
        """Return whether somebody has told of a frame."""
        return frame_id in self.getAllFrameIds()

    def canTransform(self, target_frame: str, source_frame: str) -> bool:
        """Return whether it is known where one is, seen from the other."""
        with contextlib.suppress(*FAILURES, LookupError, ValueError):
            return self._board.pose(target_frame, source_frame) is not None
        return False

    def getTransform(self, target_frame_id: str, source_frame_id: str, transform: Matrix) -> bool:
        """Store where the target is, 4 x 4."""

        def get() -> None:
            found = yarpy.Matrix(self._board.pose(target_frame_id, source_frame_id))
            transform._rows, transform._cols = found.array.tolist(), 4

        return self._try(get)

    def setTransform(self, target_frame_id: str, source_frame_id: str, transform: Matrix) -> bool:
        """Tell where the target is, 4 x 4; it is forgotten soon."""
        return self._place(target_frame_id, source_frame_id, transform, False)

    def setTransformStatic(
        self, target_frame_id: str, source_frame_id: str, transform: Matrix
    ) -> bool:
        """Tell where the target is, 4 x 4, for good."""
        return self._place(target_frame_id, source_frame_id, transform, True)

    def waitForTransform(self, target_frame_id: str, source_frame_id: str, timeout: float) -> bool:
        """Wait until it is known where one is, seen from the other, so many seconds at most."""
        until = time.monotonic() + timeout
        while not self.canTransform(target_frame_id, source_frame_id):
            if time.monotonic() >= until:
                return False
            time.sleep(0.02)
        return True

    def transformPoint(
        self,
        target_frame_id: str,
        source_frame_id: str,
        input_point: Any,
        transformed_point: Any,
    ) -> bool:
        """Multiply a point, three numbers, by where the target is, seen from the source."""
        matrix, point = Matrix(), [*input_point]
        if len(point) != 3 or not self.getTransform(target_frame_id, source_frame_id, matrix):
            return False
        found = [
            sum(a * b for a, b in zip(row, (*point, 1.0), strict=True)) for row in matrix._rows
        ]
        _give(transformed_point, found[:3])
        return True

    def transformPose(
        self, target_frame_id: str, source_frame_id: str, input_pose: Any, transformed_pose: Any
    ) -> bool:
        """Multiply a pose, metres and radians (x y z roll pitch yaw), by where the target is, seen
        from the source."""
        matrix, pose = Matrix(), [*map(float, input_pose)]
        if len(pose) != 6 or not self.getTransform(target_frame_id, source_frame_id, matrix):
            return False
        placed = [[*row, at] for row, at in zip(_of_angles(*pose[3:]), pose[:3], strict=True)]
        found = _product(matrix._rows, [*placed, [0.0, 0.0, 0.0, 1.0]])
        _give(transformed_pose, [*(row[3] for row in found[:3]), *_angles(found)])
        return True

    def transformQuaternion(
        self,
        target_frame_id: str,
        source_frame_id: str,
        input_quaternion: Any,
        transformed_quaternion: Any,
    ) -> bool:
        """Multiply a rotation, four numbers x y z w, by that of the target, seen from the
        source."""
        matrix, given = Matrix(), [*map(float, input_quaternion)]
        if len(given) != 4 or not self.getTransform(target_frame_id, source_frame_id, matrix):
            return False
        turned = _quaternion_product(_quaternion([row[:3] for row in matrix._rows[:3]]), given)
        _give(transformed_quaternion, turned)
        return True

    def deleteTransform(self, target_frame_id: str, source_frame_id: str) -> bool:
        """Forget where the target is."""
        return self._try(lambda: self._board.remove(target_frame_id, source_frame_id))

    def clear(self) -> bool:
        """Forget everything."""
        return self._try(self._board.clear)

    def _place(self, target: str, source: str, transform: Matrix, constant: bool) -> bool:
        if (transform.rows(), transform.cols()) != (4, 4):
            return False
        rows = transform._rows
        position = [row[3] for row in rows[:3]]
        rotation = _quaternion([row[:3] for row in rows[:3]])
        return self._try(
            lambda: self._board.place(target, source, position, rotation, constant=constant)
        )

    def _try(self, action: Callable[[], object]) -> bool:
        try:
            return self._tell(action)
        except (LookupError, ValueError):
            return False


def _quaternion(m: list[list[float]]) -> list[float]:
    """The rotation of a matrix as x y z w, from its largest component."""
    trace = m[0][0] + m[1][1] + m[2][2]
    squares = [1 + 2 * m[i][i] - trace for i in range(3)] + [1 + trace]
    at = squares.index(max(squares))
    if at == 3:
        parts = [m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1], squares[3]]
    else:
        j, k = (at + 1) % 3, (at + 2) % 3
        parts = [0.0] * 4
        parts[at], parts[3] = squares[at], m[k][j] - m[j][k]
        parts[j], parts[k] = m[j][at] + m[at][j], m[k][at] + m[at][k]
    size = sum(each * each for each in parts) ** 0.5 or 1.0
    return [each / size for each in parts]


def _of_angles(roll: float, pitch: float, yaw: float) -> list[list[float]]:
    """The rotation of three angles, first around x, then y, then z."""
    (sr, sp, sy), (cr, cp, cy) = ([f(a) for a in (roll, pitch, yaw)] for f in (sin, cos))
    return [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]


def _angles(m: list[list[float]]) -> tuple[float, float, float]:
    """Roll, pitch and yaw of a rotation; straight up or down, all of its turn is yaw."""
    pitch = atan2(-m[2][0], hypot(m[2][1], m[2][2]))
    if hypot(m[2][1], m[2][2]) < 1e-9:
        return 0.0, pitch, atan2(-m[0][1], m[1][1])
    return atan2(m[2][1], m[2][2]), pitch, atan2(m[1][0], m[0][0])


def _product(a: list[list[float]], b: list[list[float]]) -> list[list[float]]:
    columns = [*zip(*b, strict=True)]
    return [[sum(map(mul, row, column)) for column in columns] for row in a]


def _quaternion_product(a: list[float], b: list[float]) -> list[float]:
    (ax, ay, az, aw), (bx, by, bz, bw) = a, b
    return [
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    ]


def _give(place: Any, values: list[float]) -> None:
    if hasattr(place, "resize"):
        place.resize(len(values))
    store(place, values)
