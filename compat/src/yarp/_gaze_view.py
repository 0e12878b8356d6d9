"""IGazeControl: where a robot looks. Metres, degrees, pixels; camera 0 is the left one.

Rules: those of ICartesianControl.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from yarp._bottle import Bottle
from yarp._controller_view import ControllerView, _Parameters, _Variables, fill
from yarp._numbers import store


class GazeEventParameters(_Parameters):
    """Of a GazeEvent."""


class GazeEventVariables(_Variables):
    """Of a GazeEvent."""


class GazeEvent:
    """Hears of motion: a subclass defines `gazeEventCallback`."""

    def __init__(self) -> None:
        self.gazeEventParameters = GazeEventParameters()
        self.gazeEventVariables = GazeEventVariables()

    def gazeEventCallback(self) -> None:
        """Called with each event."""


def _camera(number: int) -> str:
    return "left" if number == 0 else "right"


class IGazeControl(ControllerView):
    """Where a robot looks, and where it shall look."""

    _event_kind = "gaze"

    # -- where it looks -----------------------------------------------------------------------

    def getFixationPoint(self, fp: Any, stamp: Any = None) -> bool:
        return self._state(fp, stamp, "x", lambda: self._board.fixation_point())

    def getAngles(self, ang: Any, stamp: Any = None) -> bool:
        """Azimuth, elevation, vergence."""
        return self._state(ang, stamp, "angles", lambda: self._board.angles())

    def _state(self, place: Any, stamp: Any, name: str, get: Callable[[], Any]) -> bool:
        def read() -> None:
            fill(place, get())
            if stamp is not None:
                stamp.update(self._board.state_time(name))

        return self._tell(read)

    def getLeftEyePose(self, x: Any, o: Any, stamp: Any = None) -> bool:
        return self._pose("left", x, o, stamp)

    def getRightEyePose(self, x: Any, o: Any, stamp: Any = None) -> bool:
        return self._pose("right", x, o, stamp)

    def getHeadPose(self, x: Any, o: Any, stamp: Any = None) -> bool:
        return self._pose("head", x, o, stamp)

    def _pose(self, what: str, x: Any, o: Any, stamp: Any) -> bool:
        def read() -> None:
            found = self._board.pose(what)
            fill(x, found.position)
            fill(o, found.orientation)
            if stamp is not None:
                stamp.update(found.time)

        return self._tell(read)

    # -- where it shall look ------------------------------------------------------------------

    def _look(self, sync: bool, point: Any) -> bool:
        return self._tell(lambda: self._board.look_at([*point], confirmed=sync))

    def lookAtFixationPoint(self, fp: Any) -> bool:
        return self._look(False, fp)

    def lookAtFixationPointSync(self, fp: Any) -> bool:
        """The same; True when the controller has taken it."""
        return self._look(True, fp)

    def _turn(self, ang: Any, relative: bool, sync: bool) -> bool:
        return self._tell(lambda: self._board.turn_to([*ang], relative=relative, confirmed=sync))

    def lookAtAbsAngles(self, ang: Any) -> bool:
        return self._turn(ang, False, False)

    def lookAtAbsAnglesSync(self, ang: Any) -> bool:
        return self._turn(ang, False, True)

    def lookAtRelAngles(self, ang: Any) -> bool:
        return self._turn(ang, True, False)

    def lookAtRelAnglesSync(self, ang: Any) -> bool:
        return self._turn(ang, True, True)

    def _at_pixel(self, camera: int, px: Any, sync: bool, **how: float) -> bool:
        return self._tell(
            lambda: self._board.look_at_pixel(_camera(camera), [*px][:2], confirmed=sync, **how)
        )

    def lookAtMonoPixel(self, camSel: int, px: Any, z: float = 1.0) -> bool:
        """Look at what is at a pixel, so many metres away."""
        return self._at_pixel(camSel, px, False, distance=z)

    def lookAtMonoPixelSync(self, camSel: int, px: Any, z: float = 1.0) -> bool:
        return self._at_pixel(camSel, px, True, distance=z)

    def lookAtMonoPixelWithVergence(self, camSel: int, px: Any, ver: float) -> bool:
        return self._at_pixel(camSel, px, False, vergence=ver)

    def lookAtMonoPixelWithVergenceSync(self, camSel: int, px: Any, ver: float) -> bool:
        return self._at_pixel(camSel, px, True, vergence=ver)

    def lookAtStereoPixels(self, pxl: Any, pxr: Any) -> bool:
        return self._tell(lambda: self._board.look_at_pixels([*pxl][:2], [*pxr][:2]))

    def lookAtStereoPixelsSync(self, pxl: Any, pxr: Any) -> bool:
        return self._tell(lambda: self._board.look_at_pixels([*pxl][:2], [*pxr][:2], True))

    def checkSaccadeDone(self, *f: Any) -> bool:
        return bool(self._number(f, lambda: self._board.saccade_done(), False))

    def waitSaccadeDone(self, period: float = 0.1, timeout: float = 0.0) -> bool:
        return self._tell(lambda: self._board.wait_saccade_done(period, timeout))

    # -- geometry -----------------------------------------------------------------------------

    def get2DPixel(self, camSel: int, x: Any, px: Any) -> bool:
        """Where a camera sees a point."""
        return self._numbers(px, lambda: self._board.pixel(_camera(camSel), [*x][:3]))

    def get3DPoint(self, camSel: int, px: Any, z: float, x: Any) -> bool:
        """Return the point that a camera sees at a pixel, so many metres away."""
        return self._numbers(x, lambda: self._board.point(_camera(camSel), [*px][:2], z))

    def get3DPointOnPlane(self, camSel: int, px: Any, plane: Any, x: Any) -> bool:
        return self._numbers(
            x, lambda: self._board.point_on_plane(_camera(camSel), [*px][:2], [*plane][:4])
        )

    def get3DPointFromAngles(self, mode: int, ang: Any, x: Any) -> bool:
        """Return the point that it would look at; mode 0: absolute angles, 1: relative ones."""
        return self._numbers(x, lambda: self._board.point_in_direction([*ang][:3], mode != 0))

    def getAnglesFrom3DPoint(self, x: Any, ang: Any) -> bool:
        return self._numbers(ang, lambda: self._board.direction([*x][:3]))

    def triangulate3DPoint(self, pxl: Any, pxr: Any, x: Any) -> bool:
        return self._numbers(x, lambda: self._board.triangulate([*pxl][:2], [*pxr][:2]))

    # -- joints -------------------------------------------------------------------------------

    def getJointsDesired(self, qdes: Any) -> bool:
        return self._numbers(qdes, lambda: self._board.desired_joints())

    def getJointsVelocities(self, qdot: Any) -> bool:
        return self._numbers(qdot, lambda: self._board.joint_velocities())

    def _bind(self, joint: str, *angles: float) -> bool:
        return self._tell(lambda: self._board.bind_neck(joint, *angles))

    def _range(self, joint: str, min: Any, max: Any) -> bool:
        def read() -> None:
            low, high = self._board.neck_range(joint)
            store(min, [low])
            store(max, [high])

        return self._tell(read)

    def _free(self, joint: str) -> bool:
        return self._tell(lambda: self._board.free(joint))

    def bindNeckPitch(self, min: float, max: float) -> bool:
        return self._bind("pitch", min, max)

    def bindNeckRoll(self, min: float, max: float) -> bool:
        return self._bind("roll", min, max)

    def bindNeckYaw(self, min: float, max: float) -> bool:
        return self._bind("yaw", min, max)

    def blockNeckPitch(self, *val: float) -> bool:
        """Keep it at an angle; without one, where it is."""
        return self._bind("pitch", *val)

    def blockNeckRoll(self, *val: float) -> bool:
        return self._bind("roll", *val)

    def blockNeckYaw(self, *val: float) -> bool:
        return self._bind("yaw", *val)

    def blockEyes(self, *ver: float) -> bool:
        """Keep the vergence; without one, that of now."""
        return self._tell(lambda: self._board.bind_eyes(*ver))

    def getNeckPitchRange(self, min: Any, max: Any) -> bool:
        return self._range("pitch", min, max)

    def getNeckRollRange(self, min: Any, max: Any) -> bool:
        return self._range("roll", min, max)

    def getNeckYawRange(self, min: Any, max: Any) -> bool:
        return self._range("yaw", min, max)

    def getBlockedVergence(self, *ver: Any) -> Any:
        return self._number(ver, lambda: self._board.bound_vergence(), -1.0)

    def clearNeckPitch(self) -> bool:
        return self._free("pitch")

    def clearNeckRoll(self) -> bool:
        return self._free("roll")

    def clearNeckYaw(self) -> bool:
        return self._free("yaw")

    def clearEyes(self) -> bool:
        return self._free("eyes")

    # -- settings -----------------------------------------------------------------------------

    def getStereoOptions(self, options: Bottle) -> bool:
        def read() -> None:
            options._native[:] = self._board.stereo_options()

        return self._tell(read)

    def setStereoOptions(self, options: Bottle) -> bool:
        return self._tell(lambda: self._board.change_stereo_options(options._native))


#: the settings that are one value: how C++ calls them -> members
SETTINGS = {
    "NeckTrajTime": "neck_time",
    "EyesTrajTime": "eyes_time",
    "VORGain": "vor_gain",
    "OCRGain": "ocr_gain",
    "SaccadesMode": "saccades",
    "SaccadesInhibitionPeriod": "saccade_inhibition",
    "SaccadesActivationAngle": "saccade_angle",
    "NeckAngleUserTolerance": "neck_tolerance",
    "StabilizationMode": "stabilization",
}


def _pair(member: str) -> tuple[Callable[..., Any], Callable[..., Any]]:
    def get(self: IGazeControl, *place: Any) -> Any:
        return self._number(place, lambda: getattr(self._board, member), -1.0)

    def change(self: IGazeControl, value: Any) -> bool:
        return self._set(member, value)

    return get, change


for _name, _member in SETTINGS.items():
    for _verb, _method in zip(("get", "set"), _pair(_member), strict=True):
        _method.__name__ = f"{_verb}{_name}"
        setattr(IGazeControl, _method.__name__, _method)
