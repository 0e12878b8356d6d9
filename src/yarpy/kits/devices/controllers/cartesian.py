"""CartesianController: moves the hand (or foot) of a robot to a place in space.

    with CartesianController("/icub/cartesianController/left_arm") as arm:
        arm.go_to((-0.3, -0.1, 0.1))
        arm.wait_motion_done()

Rules: metres and seconds; a rotation is an axis and an angle in radians, four numbers; joints are
in degrees. Numbers of axes count from the base. What the controller refuses is a
LocalProtocolError.

Source: ClientCartesianController of icub-main, version 2.0.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar, NamedTuple

from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.errors import RemoteProtocolError
from yarpy.kits.devices.controllers.client import ControllerClient, numbers
from yarpy.kits.devices.kind import word


class HandPose(NamedTuple):
    """The pose of a hand: metres; axis and angle, radians; the controller's time."""

    position: tuple[float, ...]
    orientation: tuple[float, ...]
    time: float


class Solution(NamedTuple):
    """The pose nearest to a wish: metres; axis and angle; the joints, degrees."""

    position: tuple[float, ...]
    orientation: tuple[float, ...]
    joints: tuple[float, ...]


class CartesianController(ControllerClient):
    """A client of `remote`, such as `/icub/cartesianController/left_arm`.

    local: the prefix of its own ports; "" for a unique one.
    carrier: that of commands and of the pose; C++ takes udp.
    timeout: seconds after which a pose no longer counts.
    Raises UnknownName, Timeout (nobody answers), RemoteProtocolError (another version).
    """

    RPC = "rpc:i"
    COMMANDS = ("command",)
    STATES = ("state",)
    ONGOING: ClassVar[tuple[Sequence[Any], Sequence[Any]]] = (
        (Vocab("even"), Vocab("regi"), Vocab("ogoi")),
        (Vocab("even"), Vocab("unre"), Vocab("ogoi")),
    )
    _tweak = "twea"

    # -- where it is --------------------------------------------------------------------------

    def pose(self, axis: int | None = None) -> HandPose:
        """Return where the hand is, as it is sent all the time; with an axis, where that is."""
        if axis is None:
            state = self._states["state"]
            found = state.value()
            if len(found) < 7:
                raise RemoteProtocolError(f'"{self.remote}" sends {len(found)} numbers, not 7')
            return HandPose(found[:3], found[3:], state.time())
        words = (*self._words("get", "pose"), int(axis))
        answer = self.ask(*words)
        try:
            found = tuple(map(float, answer[0]))
            at = float(answer[1][1]) if len(answer) > 1 else 0.0
        except (IndexError, TypeError, ValueError):
            raise self._strange(words, answer) from None
        return HandPose(found[:3], found[3:], at)

    def is_on(self) -> bool:
        """Return whether its solver is there."""
        return self._flag("ison")

    # -- where it goes ------------------------------------------------------------------------

    def go_to(
        self,
        position: Sequence[float],
        orientation: Sequence[float] | None = None,
        seconds: float = 0.0,
        confirmed: bool = False,
    ) -> None:
        """Go to a place, and turn if an orientation is given. `seconds`: how long that takes, 0 for
        `trajectory_time`. `confirmed`: wait until the solver has taken it."""
        goal = numbers(position, 3, "a position")
        if orientation is not None:
            goal += numbers(orientation, 4, "an orientation (axis and angle)")
        kind = "xyz" if orientation is None else "full"
        words = (*self._words("go", kind), float(seconds), Bottle(goal))
        if confirmed:
            self.ask(*words)
        else:
            self._out["command"].write(Bottle(words))

    def move(self, velocity: Sequence[float], turning: Sequence[float]) -> None:
        """Move at a velocity, m/s, and turn: axis and rad/s; until `stop`."""
        goal = [*numbers(velocity, 3, "a velocity"), *numbers(turning, 4, "turning")]
        self._out["command"].write(Bottle([Vocab("tvel"), Bottle(goal)]))

    def desired(self) -> Solution:
        """Return where it goes, as near as the arm can come."""
        return self._solution(*self._words("get", "des"))

    def solve(
        self,
        position: Sequence[float],
        orientation: Sequence[float] | None = None,
        start: Sequence[float] | None = None,
    ) -> Solution:
        """Return how near the arm could come, without moving. `start`: joints to begin with,
        degrees."""
        goal = numbers(position, 3, "a position")
        if orientation is not None:
            goal += numbers(orientation, 4, "an orientation (axis and angle)")
        words: list[Any] = [Vocab("ask"), Bottle([Vocab("xd"), Bottle(goal)])]
        if start is not None:
            words.append(Bottle([Vocab("q"), Bottle(map(float, start))]))
        kind = "xyz" if orientation is None else "full"
        words.append(Bottle([Vocab("pose"), Vocab(kind)]))
        return self._solution(*words)

    def _solution(self, *words: Any) -> Solution:
        answer = self.ask(*words)
        try:
            found = {word(pair[0]): tuple(map(float, pair[1])) for pair in answer}
            place = found["x"]
            return Solution(place[:3], place[3:], found["q"])
        except (IndexError, KeyError, TypeError, ValueError):
            raise self._strange(words, answer) from None

    def motion_done(self) -> bool:
        return self._flag("done")

    def joint_velocities(self) -> tuple[float, ...]:
        """Degrees a second."""
        return self.ask_numbers(*self._words("get", "qdot"))

    def task_velocities(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """m/s, and axis and rad/s."""
        found = self.ask_numbers(*self._words("get", "xdot"), least=7)
        return found[:3], found[3:]

    # -- how it goes --------------------------------------------------------------------------

    @property
    def trajectory_time(self) -> float:
        """The duration of a movement, seconds."""
        return self.ask_number(*self._words("get", "time"))

    @trajectory_time.setter
    def trajectory_time(self, seconds: float) -> None:
        self.ask(*self._words("set", "time"), float(seconds))

    @property
    def tolerance(self) -> float:
        """The distance from its goal at which a movement is done."""
        return self.ask_number(*self._words("get", "tol"))

    @tolerance.setter
    def tolerance(self, value: float) -> None:
        self.ask(*self._words("set", "tol"), float(value))

    @property
    def tracking(self) -> bool:
        """Return whether it stays at its goal when somebody pushes it."""
        found = self.ask(*self._words("get", "mode"))
        return word(found[0]) == "cont" if found else False

    @tracking.setter
    def tracking(self, value: bool) -> None:
        self.ask(*self._words("set", "mode", "cont" if value else "shot"))

    @property
    def reference_mode(self) -> bool:
        """Return whether it goes on from where joints were sent, not from where they are."""
        return self._flag("refe")

    @reference_mode.setter
    def reference_mode(self, value: bool) -> None:
        self.ask(*self._words("set", "refe", "true" if value else "fals"))

    @property
    def priority(self) -> str:
        """Return which counts more, `position` or `orientation`."""
        found = self.ask(*self._words("get", "prio"))
        return str(found[0]) if found else ""

    @priority.setter
    def priority(self, value: str) -> None:
        self.ask(*self._words("set", "prio"), str(value))

    @property
    def dof(self) -> tuple[float, ...]:
        """The joints that are used: 1 or 0 for each."""
        return self.ask_numbers(*self._words("get", "dof"))

    @dof.setter
    def dof(self, values: Sequence[float]) -> None:
        self.ask(*self._words("set", "dof"), Bottle(int(value) for value in values))

    @property
    def rest_position(self) -> tuple[float, ...]:
        """The positions that joints take where the goal leaves a choice, degrees."""
        return self.ask_numbers(*self._words("get", "resp"))

    @rest_position.setter
    def rest_position(self, values: Sequence[float]) -> None:
        self.ask(*self._words("set", "resp"), Bottle(map(float, values)))

    @property
    def rest_weights(self) -> tuple[float, ...]:
        """The weight of each joint's rest position."""
        return self.ask_numbers(*self._words("get", "resw"))

    @rest_weights.setter
    def rest_weights(self, values: Sequence[float]) -> None:
        self.ask(*self._words("set", "resw"), Bottle(map(float, values)))

    def limits(self, axis: int) -> tuple[float, float]:
        """Return the range of a joint, degrees."""
        words = (*self._words("get", "lim"), int(axis))
        found = self.ask(*words)
        try:
            return float(found[0]), float(found[1])
        except (IndexError, TypeError, ValueError):
            raise self._strange(words, found) from None

    def change_limits(self, axis: int, low: float, high: float) -> None:
        """Let a joint go so far, degrees."""
        self.ask(*self._words("set", "lim"), int(axis), float(low), float(high))

    @property
    def tip(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Return the point that is moved, seen from the hand: metres, and axis and angle."""
        found = self.ask_numbers(*self._words("get", "tip"), least=7)
        return found[:3], found[3:]

    @tip.setter
    def tip(self, frame: tuple[Sequence[float], Sequence[float]]) -> None:
        goal = [*numbers(frame[0], 3, "a position"), *numbers(frame[1], 4, "an orientation")]
        self.ask(*self._words("set", "tip"), Bottle(goal))
        self._states["state"].renew()

    def _flag(self, item: str) -> bool:
        found = self.ask(*self._words("get", item))
        return bool(found) and word(found[0]) == "true"
