"""The server of an action of ROS 1: takes goals, carries each out, and says how it goes.

    server = yarpy.ros.ActionServer(node, "/count", "actionlib_tutorials/Fibonacci", count)

Rules: what `execute(goal)` returns is the result, and the goal has succeeded; what it raises aborts
the goal. Where somebody wants it canceled `goal.canceling` is true: `return
goal.preempted(result)`. With `single`, as of actionlib's simple servers, a new goal asks for the
end of the one before and waits for that. The status of all goals is told at once when it changes,
and five times a second.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any, Final

from yarpy.errors import PortClosed
from yarpy.limit import ROS_FRAME_NAME, ROS_GOALS
from yarpy.log import log_failure, logger
from yarpy.monitors.base import FAILURES
from yarpy.peers.ros.action.status import (
    CANCEL_TYPE,
    STATUS_TYPE,
    Status,
    made,
    stamp_of,
    types_of,
)
from yarpy.peers.ros.message.library import default_library

log = logger("yarpy.ros")

EVERY: Final = 0.2  # seconds between two messages that tell the status
REMEMBERED: Final = 5.0  # seconds that goals which are over are told of


class Ended:
    """The outcome that `Goal.preempted` and `Goal.aborted` return, for `execute` to return."""

    def __init__(self, status: Status, result: object, text: str) -> None:
        self.status, self.result, self.text = status, result, text


class Goal:
    """A goal under way. `request`: an object of the action's Goal."""

    def __init__(self, server: ActionServer, id_: str, stamp: float, request: Any) -> None:
        self.id = id_
        self.stamp = stamp  # seconds
        self.request = request
        self.status = Status.PENDING
        self.text = ""
        self.over_at = 0.0
        self._server = server

    @property
    def canceling(self) -> bool:
        """Return whether somebody wants it canceled, or the server closes."""
        return self.status in (Status.PREEMPTING, Status.RECALLING) or self._server.closing.is_set()

    def wait(self, seconds: float) -> bool:
        """Sleep; return True at once when it is to be canceled, False after the time."""
        with self._server.changed:
            return self._server.changed.wait_for(lambda: self.canceling, seconds)

    def feedback(self, value: object) -> None:
        """Tell who listens how far it is: an object of the action's Feedback, or a list or dict of
        its fields. Raises TypeError, ValueError, DecodeError for what is none."""
        self._server.tell_feedback(self, value)

    def preempted(self, result: object = None, text: str = "") -> Ended:
        """Return what says that it was given up, as was asked for."""
        return Ended(Status.PREEMPTED, result, text)

    def aborted(self, result: object = None, text: str = "") -> Ended:
        """Return what says that it has failed."""
        return Ended(Status.ABORTED, result, text)


class ActionServer:
    """Of the node `node`; its topics are closed with that, or by `close`.

    execute(goal): in a thread of its own. accept(request): whether a goal is taken. Raises
    AddressError, UnknownType.
    """

    def __init__(
        self,
        node: Any,
        name: str,
        type_: str,
        execute: Callable[[Goal], object],
        *,
        accept: Callable[[Any], bool] = lambda request: True,
        single: bool = False,
    ) -> None:
        self.name = node.resolve(name)
        self.types = types = types_of(type_)
        self.closing = threading.Event()
        self.changed = threading.Condition(threading.RLock())
        self._node = node
        self._execute = execute
        self._accept = accept
        self._single = single
        self._goals: dict[str, Goal] = {}
        self._recalled: dict[str, float] = {}  # goals that were canceled before they came
        self._last_cancel = 0.0
        self._count = 0
        self._states = default_library().message(STATUS_TYPE)

        def place(what: str) -> str:
            return f"{self.name}/{what}"

        self._status = node.publisher(place("status"), STATUS_TYPE, latch=True, queue_size=50)
        self._result = node.publisher(place("result"), types.ActionResult, queue_size=50)
        self._feedback = node.publisher(place("feedback"), types.ActionFeedback, queue_size=50)
        self._heard = [
            node.subscriber(place("cancel"), CANCEL_TYPE, self._cancel),
            node.subscriber(place("goal"), types.ActionGoal, self._take),
        ]
        self._thread = threading.Thread(
            target=self._tell_often, name=f"yarpy action {self.name}", daemon=True
        )
        self._thread.start()

    @property
    def goals(self) -> list[Goal]:
        """Return the goals that are known: under way, or over not long ago."""
        with self.changed:
            return [*self._goals.values()]

    def close(self) -> None:
        """Cancel what is under way, and close the topics. Idempotent."""
        with self.changed:
            self.closing.set()
            self.changed.notify_all()
            self.changed.wait_for(lambda: all(g.status.is_over for g in self._goals.values()), 1.0)
        for port in (*self._heard, self._status, self._result, self._feedback):
            port.close()

    # -- what comes -------------------------------------------------------------------------------

    def _take(self, message: Any) -> None:
        """A goal has come."""
        now = self._node.now()
        id_, stamp = message.goal_id.id, message.goal_id.stamp.to_sec()
        with self.changed:
            self._count += 1
            id_ = id_ or f"{self._node.name}-{self._count}-{now:.9f}"
            under_way = [goal for goal in self._goals.values() if not goal.status.is_over]
            if id_ in self._goals or self.closing.is_set():
                return
            goal = Goal(self, id_, stamp or now, message.goal)
            recalled = id_ in self._recalled or 0.0 < stamp <= self._last_cancel
            self._recalled.pop(id_, None)
            full = len(under_way) >= ROS_GOALS or len(id_) > ROS_FRAME_NAME
            if not full:
                self._goals[id_] = goal
        if recalled:
            self._end(goal, Ended(Status.RECALLED, None, "it was canceled before it came"))
        elif full or (why := self._refusal(goal)):
            why = "there are too many" if full else why
            self._end(goal, Ended(Status.REJECTED, None, why))
        else:
            before = under_way if self._single else []
            name = f"yarpy goal of {self.name}"
            threading.Thread(target=self._run, args=(goal, before), name=name, daemon=True).start()

    def _refusal(self, goal: Goal) -> str:
        """Return why a goal is not accepted; "" if it is."""
        try:
            return "" if self._accept(goal.request) else "it is not accepted"
        except FAILURES as error:
            log_failure(log, error, "%s: what accepts goals failed", self.name)
            return f"{type(error).__name__}: {error}"

    def _cancel(self, message: Any) -> None:
        """Somebody wants goals to be given up: one, all up to a moment, or all."""
        id_, stamp = message.id, message.stamp.to_sec()
        with self.changed:
            for goal in self._goals.values():
                everything = not id_ and not stamp
                if everything or goal.id == id_ or (stamp and goal.stamp <= stamp):
                    self._ask_to_end(goal)
            if id_ and id_ not in self._goals and len(self._recalled) < ROS_GOALS:
                self._recalled[id_[:ROS_FRAME_NAME]] = self._node.now()
            self._last_cancel = max(self._last_cancel, stamp)
            self.changed.notify_all()
        self._tell()

    def _ask_to_end(self, goal: Goal) -> None:
        if goal.status == Status.PENDING:
            goal.status = Status.RECALLING
        elif goal.status == Status.ACTIVE:
            goal.status = Status.PREEMPTING

    # -- a goal -----------------------------------------------------------------------------------

    def _run(self, goal: Goal, before: list[Goal]) -> None:
        """Carry a goal out, in a thread of its own, once those `before` it are over."""
        with self.changed:
            for other in before:
                self._ask_to_end(other)
            self.changed.notify_all()
            self.changed.wait_for(
                lambda: goal.canceling or all(other.status.is_over for other in before)
            )
            begins = not goal.canceling
            if begins:
                goal.status = Status.ACTIVE
        if not begins:
            self._end(goal, Ended(Status.RECALLED, None, "it was canceled before it began"))
            return
        self._tell()
        try:
            found = self._execute(goal)
            if not isinstance(found, Ended):
                found = Ended(Status.SUCCEEDED, found, "")
            found.result = made(self.types.Result, found.result)
        except FAILURES as error:
            log_failure(log, error, "%s: a goal failed", self.name)
            found = Ended(Status.ABORTED, None, f"{type(error).__name__}: {error}")
        self._end(goal, found)

    def _end(self, goal: Goal, found: Ended) -> None:
        """A goal is over: tell what came of it."""
        message: Any = self.types.ActionResult()
        message.result = made(self.types.Result, found.result)
        with self.changed:
            goal.status, goal.text = found.status, found.text
            goal.over_at = self._node.now()
            self._note(message.status, goal)
            self.changed.notify_all()
        self._write(self._result, message)
        self._tell()

    def tell_feedback(self, goal: Goal, value: object) -> None:
        """Publish how far a goal is."""
        message: Any = self.types.ActionFeedback()
        message.feedback = made(self.types.Feedback, value)
        self._note(message.status, goal)
        self._write(self._feedback, message)

    def _note(self, status: Any, goal: Goal) -> None:
        status.goal_id.id, status.goal_id.stamp = goal.id, stamp_of(goal.stamp)
        status.status, status.text = int(goal.status), goal.text

    def _tell_often(self) -> None:
        while not self.closing.wait(EVERY):
            self._tell()

    def _tell(self) -> None:
        """Publish the status of all goals, and forget those that are over for long."""
        now = self._node.now()
        message: Any = self._states()
        kind: Any = default_library().message("actionlib_msgs/GoalStatus")
        with self.changed:
            for goal in [*self._goals.values()]:
                if goal.status.is_over and not now - REMEMBERED <= goal.over_at <= now + REMEMBERED:
                    del self._goals[goal.id]
                    continue
                status = kind()
                self._note(status, goal)
                message.status_list.append(status)
            self._recalled = {
                id_: when for id_, when in self._recalled.items() if when >= now - REMEMBERED
            }
            # Not behind a newer one: a client takes a goal that is not listed any more for lost.
            self._write(self._status, message)

    def _write(self, publisher: Any, message: Any) -> None:
        message.header.stamp = stamp_of(self._node.now())
        try:
            publisher.write(message)
        except PortClosed:
            self.closing.set()  # with its node: goals under way are asked to end
