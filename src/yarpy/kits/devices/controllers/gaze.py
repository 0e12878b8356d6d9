"""GazeController: turns the head and the eyes of a robot to where it shall look.

    with GazeController("/iKinGazeCtrl") as gaze:
        gaze.look_at((-0.5, 0.0, 0.3))
        gaze.wait_motion_done()

Rules: metres and seconds, angles in degrees (azimuth, elevation, vergence), pixels from the upper
left corner; cameras are `left` and `right`. What the controller refuses is a LocalProtocolError.

Source: ClientGazeController of icub-main, version 2.0.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar

from yarpy.data.bottle import Bottle
from yarpy.errors import RemoteProtocolError
from yarpy.kits.devices.controllers.cartesian import HandPose
from yarpy.kits.devices.controllers.client import ControllerClient, numbers, wait_until_done

#: joints of the neck, and where they are in `joints()`: behind the three of the torso
NECK = {"pitch": 3, "roll": 4, "yaw": 5}
VERGENCE = 8


class _Number:
    """A setting that is one number, asked for by a word."""

    def __init__(self, item: str, doc: str) -> None:
        self._item = item
        self.__doc__ = doc

    def __get__(self, owner: GazeController | None, kind: object = None) -> Any:
        return self if owner is None else owner.ask_number("get", self._item)

    def __set__(self, owner: GazeController, value: float) -> None:
        owner.ask("set", self._item, float(value))


class _Switch(_Number):
    """A setting that is on or off."""

    def __get__(self, owner: GazeController | None, kind: object = None) -> Any:
        return self if owner is None else owner.ask_number("get", self._item) > 0

    def __set__(self, owner: GazeController, value: float) -> None:
        owner.ask("set", self._item, int(bool(value)))


class GazeController(ControllerClient):
    """A client of `remote`, such as `/iKinGazeCtrl`; arguments as those of CartesianController."""

    RPC = "rpc"
    COMMANDS = ("xd", "angles", "mono", "stereo")
    STATES = ("x", "angles", "q")
    ONGOING: ClassVar[tuple[Sequence[Any], Sequence[Any]]] = (
        ("register", "ongoing"),
        ("unregister", "ongoing"),
    )
    _tweak = "tweak"

    neck_time = _Number("Tneck", "How many seconds the neck takes.")
    eyes_time = _Number("Teyes", "How many seconds the eyes take.")
    vor_gain = _Number("vor", "How much of the head's turning the eyes make up for.")
    ocr_gain = _Number("ocr", "How much of the head's rolling the eyes make up for.")
    saccade_inhibition = _Number("sinh", "Seconds between two saccades.")
    saccade_angle = _Number("sact", "Degrees from where on the eyes jump.")
    neck_tolerance = _Number("ntol", "Degrees that the neck may leave to the eyes.")
    tracking = _Switch("track", "Whether it stays at its goal when somebody pushes it.")
    stabilization = _Switch("stab", "Whether the picture is kept still.")
    saccades = _Switch("sacc", "Whether the eyes may jump.")

    @staticmethod
    def _words(*words: str) -> list[Any]:
        return [*words]

    # -- where it looks -----------------------------------------------------------------------

    def fixation_point(self) -> tuple[float, ...]:
        """Return where it looks, metres, as that is sent all the time."""
        return self._state("x", 3)

    def angles(self) -> tuple[float, ...]:
        """Return azimuth, elevation and vergence, as they are sent all the time."""
        return self._state("angles", 3)

    def joints(self) -> tuple[float, ...]:
        """Return the joints of torso, neck and eyes, three each, degrees, as they are sent all the
        time."""
        return self._state("q", 9)

    def state_time(self, name: str) -> float:
        """Return the time of the newest `x`, `angles` or `q`."""
        return self._states[name].time()

    def _state(self, name: str, least: int) -> tuple[float, ...]:
        found = self._states[name].value()
        if len(found) < least:
            raise RemoteProtocolError(f'"{self.remote}" sends {len(found)} numbers, not {least}')
        return found

    def pose(self, what: str) -> HandPose:
        """Return where the `left` or `right` eye or the `head` is."""
        words = ("get", "pose", what)
        answer = self.ask(*words)
        try:
            found = tuple(map(float, answer[0]))
            at = float(answer[1][1]) if len(answer) > 1 else 0.0
        except (IndexError, TypeError, ValueError):
            raise self._strange(words, answer) from None
        if len(found) < 7:
            raise self._strange(words, answer)
        return HandPose(found[:3], found[3:], at)

    # -- where it shall look ------------------------------------------------------------------

    def look_at(self, point: Sequence[float], confirmed: bool = False) -> None:
        """Look at a point, metres. `confirmed`: wait until the controller has taken it."""
        self._look("xd", "3D", numbers(point, 3, "a point"), confirmed)

    def turn_to(
        self, angles: Sequence[float], relative: bool = False, confirmed: bool = False
    ) -> None:
        """Look in a direction: azimuth, elevation, vergence; `relative`: from where it looks."""
        how = "rel" if relative else "abs"
        self._look("angles", "ang", [how, *numbers(angles, 3, "a direction")], confirmed)

    def look_at_pixel(
        self,
        camera: str,
        pixel: Sequence[float],
        distance: float = 1.0,
        vergence: float | None = None,
        confirmed: bool = False,
    ) -> None:
        """Look at what is at a pixel, so many metres away, or where the eyes have that vergence."""
        far = [float(distance)] if vergence is None else ["ver", float(vergence)]
        self._look("mono", "mono", [camera, *numbers(pixel, 2, "a pixel"), *far], confirmed)

    def look_at_pixels(
        self, left: Sequence[float], right: Sequence[float], confirmed: bool = False
    ) -> None:
        """Look at what both cameras see at these pixels."""
        both = [*numbers(left, 2, "a pixel"), *numbers(right, 2, "a pixel")]
        self._look("stereo", "stereo", both, confirmed)

    def _look(self, port: str, kind: str, goal: list[Any], confirmed: bool) -> None:
        if confirmed:
            self.ask("look", kind, Bottle(goal))
        else:
            self._out[port].write(Bottle(goal))

    def motion_done(self) -> bool:
        return self.ask_number("get", "done") > 0

    def saccade_done(self) -> bool:
        """Return whether the eyes do not jump now."""
        return self.ask_number("get", "sdon") > 0

    def wait_saccade_done(self, period: float = 0.1, timeout: float = 0.0) -> bool:
        """As `wait_motion_done`, for the eyes."""
        return wait_until_done(self.saccade_done, period, timeout)

    # -- geometry -----------------------------------------------------------------------------

    def pixel(self, camera: str, point: Sequence[float]) -> tuple[float, ...]:
        """Return the pixel where a camera sees a point."""
        goal = Bottle([camera, *numbers(point, 3, "a point")])
        return self.ask_numbers("get", "2D", goal, least=2)

    def point(self, camera: str, pixel: Sequence[float], distance: float) -> tuple[float, ...]:
        """Return the point that a camera sees at a pixel, so many metres away."""
        goal = Bottle([camera, *numbers(pixel, 2, "a pixel"), float(distance)])
        return self.ask_numbers("get", "3D", "mono", goal, least=3)

    def point_on_plane(
        self, camera: str, pixel: Sequence[float], plane: Sequence[float]
    ) -> tuple[float, ...]:
        """Return the point of a plane (ax + by + cz + d = 0) that a camera sees at a pixel."""
        goal = Bottle([camera, *numbers(pixel, 2, "a pixel"), *numbers(plane, 4, "a plane")])
        return self.ask_numbers("get", "3D", "proj", goal, least=3)

    def point_in_direction(
        self, angles: Sequence[float], relative: bool = False
    ) -> tuple[float, ...]:
        """Return the point that it would look at."""
        goal = Bottle(["rel" if relative else "abs", *numbers(angles, 3, "a direction")])
        return self.ask_numbers("get", "3D", "ang", goal, least=3)

    def direction(self, point: Sequence[float]) -> tuple[float, ...]:
        """Return azimuth, elevation and vergence of a point."""
        return self.ask_numbers("get", "ang", Bottle(numbers(point, 3, "a point")), least=3)

    def triangulate(self, left: Sequence[float], right: Sequence[float]) -> tuple[float, ...]:
        """Return the point that both cameras see at these pixels."""
        goal = Bottle([*numbers(left, 2, "a pixel"), *numbers(right, 2, "a pixel")])
        return self.ask_numbers("get", "3D", "stereo", goal, least=3)

    # -- joints -------------------------------------------------------------------------------

    def desired_joints(self) -> tuple[float, ...]:
        """Return where the joints go, degrees."""
        return self.ask_numbers("get", "des")

    def joint_velocities(self) -> tuple[float, ...]:
        """Degrees a second."""
        return self.ask_numbers("get", "vel")

    def bind_neck(self, joint: str, low: float | None = None, high: float | None = None) -> None:
        """Keep `pitch`, `roll` or `yaw` within an angle, at one, or where it is."""
        low = self.joints()[NECK[joint]] if low is None else low
        self.ask("bind", joint, float(low), float(low if high is None else high))

    def neck_range(self, joint: str) -> tuple[float, float]:
        """Return the angles within which a joint of the neck is kept."""
        found = self.ask("get", joint)
        try:
            return float(found[0]), float(found[1])
        except (IndexError, TypeError, ValueError):
            raise self._strange(("get", joint), found) from None

    def bind_eyes(self, vergence: float | None = None) -> None:
        """Keep the vergence, or that of now."""
        at = self.joints()[VERGENCE] if vergence is None else vergence
        self.ask("bind", "eyes", float(at))

    def bound_vergence(self) -> float:
        """Return the vergence that is kept; negative if none is."""
        return self.ask_number("get", "eyes")

    def free(self, joint: str) -> None:
        """Keep `pitch`, `roll`, `yaw` or `eyes` no more."""
        self.ask("clear", joint)

    # -- others -------------------------------------------------------------------------------

    def stereo_options(self) -> Bottle:
        """Return the settings of the loop that looks at two pixels."""
        found = self.ask("get", "pid")
        return found[0] if found and isinstance(found[0], Bottle) else Bottle()

    def change_stereo_options(self, options: Bottle) -> None:
        """Change them: a list of `(name value)`."""
        self.ask("set", "pid", options)
