"""The frames of the simulated head, from `root_link` by the neck to the eyes.

    root_link - neck_1 (pitch) - neck_2 (roll) - head (yaw) - eyes (tilt) - cam/left, cam/right
                                                 head - head_imu

Rules: root_link is where the robot stands; x forward, y to the left, z up, as all but the cameras.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from yarpy.kits.sim import rotation as of
from yarpy.kits.sim.body import Body
from yarpy.kits.sim.frame import Frame
from yarpy.kits.sim.head import CAMERA, EYES, IMU, NECK, ROLL, SIDES, YAW, eye_place, eye_turn
from yarpy.kits.sim.inertial import NAME as HEAD_IMU
from yarpy.kits.sim.joint import Joint
from yarpy.kits.sim.rotation import Rotation, Vector

ROOT: Final = "root_link"
_STRAIGHT: Final = of.about_x(0.0)


class HeadFrames:
    """The frames of a head whose six joints are those of `body`."""

    def __init__(self, body: Body[Joint]) -> None:
        self._body = body

    def frames(self) -> tuple[float, list[Frame]]:
        """Return the time, in seconds, and the frames as they are then."""
        with self._body.present() as joints:
            return self._body.time, head_frames([joint.position for joint in joints])


def head_frames(angles: Sequence[float]) -> list[Frame]:
    """Return the frames with the six joints at `angles` (degrees)."""
    pitch, roll, yaw, tilt, version, vergence = angles
    found = [
        _frame("neck_1", ROOT, NECK, of.about_y(-pitch)),
        _frame("neck_2", "neck_1", ROLL, of.about_x(roll)),
        _frame("head", "neck_2", YAW, of.about_z(yaw)),
        _frame(HEAD_IMU, "head", IMU, _STRAIGHT),
        _frame("eyes", "head", EYES, of.about_y(-tilt)),
    ]
    for side in SIDES:
        turned = of.after(of.about_z(eye_turn(version, vergence, side)), CAMERA)
        found.append(_frame(f"cam/{side}", "eyes", eye_place(side), turned))
    return found


def _frame(name: str, parent: str, origin: Vector, turned: Rotation) -> Frame:
    return Frame(name, parent, origin, of.quaternion(turned))
