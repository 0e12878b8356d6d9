"""ICartesianControl: where a hand is and shall be; what it shares with IGazeControl.

Rules: Vectors that take results get their size. A method without a place for its result returns it,
as the bindings do. What the controller refuses is False.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import yarpy
from yarp._bottle import Bottle
from yarp._log import say
from yarp._numbers import store
from yarp._view import View

#: what `storeContext` returns when nothing was stored
BAD_CONTEXT = -1000


class _Parameters:
    """Which event is wanted: `motion-done`, `motion-ongoing` at a share of the way, `*`."""

    def __init__(self) -> None:
        self.type = ""
        self.motionOngoingCheckPoint = -1.0


class _Variables:
    """The event that came."""

    def __init__(self) -> None:
        self.type = ""
        self.motionOngoingCheckPoint = -1.0
        self.time = 0.0


class CartesianEventParameters(_Parameters):
    """Of a CartesianEvent."""


class CartesianEventVariables(_Variables):
    """Of a CartesianEvent."""


class CartesianEvent:
    """Hears of motion: a subclass defines `cartesianEventCallback`."""

    def __init__(self) -> None:
        self.cartesianEventParameters = CartesianEventParameters()
        self.cartesianEventVariables = CartesianEventVariables()

    def cartesianEventCallback(self) -> None:
        """Called with each event."""


class ControllerView(View):
    """Contexts, events and motion, which both controllers have."""

    _event_kind = ""

    def _tell(self, action: Callable[[], object]) -> bool:
        try:
            return super()._tell(action)
        except ValueError as error:  # too few numbers
            say("ERROR", f"|yarp.dev.{type(self).__name__}| {error}")
            return False

    def _numbers(self, target: Any, get: Callable[[], Any]) -> bool:
        """Put numbers into a Vector, which gets their size."""
        return self._tell(lambda: fill(target, get()))

    def _number(self, places: tuple[Any, ...], get: Callable[[], Any], bad: Any) -> Any:
        """Put one number where it goes; without a place, return it, or `bad`."""
        if places:
            return self._tell(lambda: store(places[0], [get()]))
        found: list[Any] = [bad]
        self._tell(lambda: store(found, [get()]))
        return found[0]

    def _set(self, member: str, value: Any) -> bool:
        return self._tell(lambda: setattr(self._board, member, value))

    def setTrackingMode(self, f: bool) -> bool:
        """Stay at the goal when somebody pushes."""
        return self._set("tracking", bool(f))

    def getTrackingMode(self, *f: Any) -> bool:
        return bool(self._number(f, lambda: self._board.tracking, False))

    def checkMotionDone(self, *f: Any) -> bool:
        """Return whether it has arrived; with a BVector, whether that was stored there."""
        return bool(self._number(f, lambda: self._board.motion_done(), False))

    def waitMotionDone(self, period: float = 0.1, timeout: float = 0.0) -> bool:
        """Wait until it has arrived, at most `timeout` seconds if that is not 0."""
        return self._tell(lambda: self._board.wait_motion_done(period, timeout))

    def stopControl(self) -> bool:
        return self._tell(lambda: self._board.stop())

    def storeContext(self, *id: Any) -> int:
        """Keep the settings; return their number, -1000 if that fails."""
        found: int = self._number(id, lambda: self._board.store_context(), BAD_CONTEXT)
        return found

    def restoreContext(self, id: int) -> bool:
        """Take settings back."""
        return self._tell(lambda: self._board.restore_context(id))

    def deleteContext(self, id: int) -> bool:
        """Forget settings."""
        return self._tell(lambda: self._board.delete_context(id))

    def getInfo(self, info: Bottle) -> bool:
        """Store what the controller says of itself."""

        def read() -> None:
            pairs = [yarpy.Bottle([key, value]) for key, value in self._board.info().items()]
            info._native[:] = pairs

        return self._tell(read)

    def tweakSet(self, options: Bottle) -> bool:
        """Change settings that have no method."""
        return self._tell(lambda: self._board.tweak(options._native))

    def tweakGet(self, options: Bottle) -> bool:
        """Store those settings."""

        def read() -> None:
            options._native[:] = self._board.tweaks()

        return self._tell(read)

    def registerEvent(self, event: Any) -> bool:
        """Call an event's callback with such events."""
        wanted = getattr(event, f"{self._event_kind}EventParameters")
        came = getattr(event, f"{self._event_kind}EventVariables")
        call = getattr(event, f"{self._event_kind}EventCallback")

        def hear(found: Any) -> None:
            came.type, came.time = found.kind, found.time
            if found.share is not None:
                came.motionOngoingCheckPoint = found.share
            call()

        return self._tell(lambda: self._board.on_event(wanted.type, hear, _share(wanted)))

    def unregisterEvent(self, event: Any) -> bool:
        """Call it no more."""
        wanted = getattr(event, f"{self._event_kind}EventParameters")
        return self._tell(lambda: self._board.off_event(wanted.type, _share(wanted)))


def _share(wanted: Any) -> float | None:
    return wanted.motionOngoingCheckPoint if wanted.type == "motion-ongoing" else None


def fill(target: Any, values: Any) -> None:
    """Put numbers into a Vector, which gets their size."""
    found = [*values]
    if hasattr(target, "resize"):
        target.resize(len(found))
    store(target, found)


class ICartesianControl(ControllerView):
    """Where a hand is, and where it shall be: metres; axis and angle; joints in degrees."""

    _event_kind = "cartesian"

    def getPose(self, *arguments: Any) -> bool:
        """`(x, o)`, `(x, o, stamp)`, or an axis in front of them: where it is."""
        axis, (x, o, *stamp) = None, arguments
        if isinstance(arguments[0], int):
            axis, x, o, *stamp = arguments

        def read() -> None:
            found = self._board.pose() if axis is None else self._board.pose(axis)
            fill(x, found.position)
            fill(o, found.orientation)
            for each in stamp:
                each.update(found.time)

        return self._tell(read)

    def goToPose(self, xd: Any, od: Any, t: float = 0.0) -> bool:
        """Go there and turn so."""
        return self._tell(lambda: self._board.go_to([*xd][:3], [*od][:4], t))

    def goToPosition(self, xd: Any, t: float = 0.0) -> bool:
        """Go there, however it is turned."""
        return self._tell(lambda: self._board.go_to([*xd][:3], None, t))

    def goToPoseSync(self, xd: Any, od: Any, t: float = 0.0) -> bool:
        """The same; True when the solver has taken it."""
        return self._tell(lambda: self._board.go_to([*xd][:3], [*od][:4], t, True))

    def goToPositionSync(self, xd: Any, t: float = 0.0) -> bool:
        """The same; True when the solver has taken it."""
        return self._tell(lambda: self._board.go_to([*xd][:3], None, t, True))

    def getDesired(self, xdhat: Any, odhat: Any, qdhat: Any) -> bool:
        """Store where it goes."""
        return self._solution((xdhat, odhat, qdhat), lambda: self._board.desired())

    def askForPose(self, *arguments: Any) -> bool:
        """`(xd, od, xdhat, odhat, qdhat)`, or joints to begin with in front of them: how near it
        could come."""
        start, (xd, od, *places) = None, arguments
        if len(arguments) == 6:
            start, xd, od, *places = arguments
        first = None if start is None else [*start]
        return self._solution(places, lambda: self._board.solve([*xd], [*od], first))

    def askForPosition(self, *arguments: Any) -> bool:
        """`(xd, xdhat, odhat, qdhat)`, or joints to begin with in front of them."""
        start, (xd, *places) = None, arguments
        if len(arguments) == 5:
            start, xd, *places = arguments
        first = None if start is None else [*start]
        return self._solution(places, lambda: self._board.solve([*xd], None, first))

    def _solution(self, places: Any, get: Callable[[], Any]) -> bool:
        def read() -> None:
            for place, values in zip(places, get(), strict=True):
                fill(place, values)

        return self._tell(read)

    def _exchange(self, member: str, wanted: Any, now: Any) -> bool:
        """Change numbers, and store what they are now."""

        def change() -> None:
            setattr(self._board, member, [*wanted])
            fill(now, getattr(self._board, member))

        return self._tell(change)

    def getDOF(self, curDof: Any) -> bool:
        """Which joints are used."""
        return self._numbers(curDof, lambda: self._board.dof)

    def setDOF(self, newDof: Any, curDof: Any) -> bool:
        return self._exchange("dof", newDof, curDof)

    def getRestPos(self, curRestPos: Any) -> bool:
        return self._numbers(curRestPos, lambda: self._board.rest_position)

    def setRestPos(self, newRestPos: Any, curRestPos: Any) -> bool:
        return self._exchange("rest_position", newRestPos, curRestPos)

    def getRestWeights(self, curRestWeights: Any) -> bool:
        return self._numbers(curRestWeights, lambda: self._board.rest_weights)

    def setRestWeights(self, newRestWeights: Any, curRestWeights: Any) -> bool:
        return self._exchange("rest_weights", newRestWeights, curRestWeights)

    def getLimits(self, axis: int, min: Any, max: Any) -> bool:
        """How far a joint may go."""

        def read() -> None:
            low, high = self._board.limits(axis)
            store(min, [low])
            store(max, [high])

        return self._tell(read)

    def setLimits(self, axis: int, min: float, max: float) -> bool:
        return self._tell(lambda: self._board.change_limits(axis, min, max))

    def getTrajTime(self, *t: Any) -> Any:
        """Seconds of a movement."""
        return self._number(t, lambda: self._board.trajectory_time, -1.0)

    def setTrajTime(self, t: float) -> bool:
        return self._set("trajectory_time", t)

    def getInTargetTol(self, *tol: Any) -> Any:
        """How near is near enough."""
        return self._number(tol, lambda: self._board.tolerance, -1.0)

    def setInTargetTol(self, tol: float) -> bool:
        return self._set("tolerance", tol)

    def setReferenceMode(self, f: bool) -> bool:
        return self._set("reference_mode", bool(f))

    def getReferenceMode(self, *f: Any) -> bool:
        return bool(self._number(f, lambda: self._board.reference_mode, False))

    def setPosePriority(self, p: str) -> bool:
        """`position` or `orientation`."""
        return self._set("priority", p)

    def getPosePriority(self, *p: Any) -> Any:
        """Store it in an SVector; without one, return it."""
        return self._number(p, lambda: self._board.priority, "")

    def getJointsVelocities(self, qdot: Any) -> bool:
        return self._numbers(qdot, lambda: self._board.joint_velocities())

    def getTaskVelocities(self, xdot: Any, odot: Any) -> bool:
        def read() -> None:
            velocity, turning = self._board.task_velocities()
            fill(xdot, velocity)
            fill(odot, turning)

        return self._tell(read)

    def setTaskVelocities(self, xdot: Any, odot: Any) -> bool:
        return self._tell(lambda: self._board.move([*xdot], [*odot]))

    def attachTipFrame(self, x: Any, o: Any) -> bool:
        """Move a frame that is fixed to the hand."""
        return self._set("tip", ([*x], [*o]))

    def getTipFrame(self, x: Any, o: Any) -> bool:
        def read() -> None:
            position, orientation = self._board.tip
            fill(x, position)
            fill(o, orientation)

        return self._tell(read)

    def removeTipFrame(self) -> bool:
        """Move the hand itself again."""
        return self._set("tip", ((0.0,) * 3, (0.0,) * 4))

    def isMotionDone(self) -> bool:
        """Return whether it has arrived; True if nobody knows."""
        return bool(self._number((), lambda: self._board.motion_done(), True))
