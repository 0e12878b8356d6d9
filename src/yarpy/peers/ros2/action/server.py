"""The server of an action: takes goals, carries each out in a thread, and says how it goes.

Rules: what `execute(goal)` returns is the result, and the goal has succeeded; what it raises aborts
the goal. Where somebody wants it canceled `goal.canceling` is true: `return goal.canceled(result)`.
Who asks for a result is answered once there is one. The last goals that are over are remembered, up
to a number; of goals that go on there is a limit, too.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any, Final

from yarpy.limit import ROS2_GOALS, ROS2_QUESTIONS
from yarpy.log import log_failure, logger
from yarpy.monitors.base import FAILURES
from yarpy.peers.ros.message.message import Message
from yarpy.peers.ros2.action.status import Refusal, Status, id_of, nanoseconds_of, stamp_of, uuid_of
from yarpy.peers.ros2.exchange import Question
from yarpy.peers.ros2.message.library import Action

log = logger("yarpy.ros2")

REMEMBERED: Final = 100  # goals that are over
NOTHING: Final = bytes(16)


class Ended:
    """The outcome that `Goal.canceled` and `Goal.aborted` return, for `execute` to return."""

    def __init__(self, status: Status, result: object) -> None:
        self.status = status
        self.result = result


class Goal:
    """A goal under way. `request`: an object of the action's Goal."""

    def __init__(self, server: ActionServer, id_: bytes, request: Any) -> None:
        self.id = id_
        self.request = request
        self.status = Status.ACCEPTED
        self.stamp = time.time_ns()
        self.result: Any = None  # an object of the action's Result, once it is over
        self._server = server
        self._asked: list[Question] = []  # for the result

    @property
    def canceling(self) -> bool:
        """Return whether somebody wants it canceled, or the server closes."""
        return self.status == Status.CANCELING or self._server.closing.is_set()

    def wait(self, seconds: float) -> bool:
        """Sleep; return True at once when it is to be canceled, False after the time."""
        with self._server.changed:
            return self._server.changed.wait_for(lambda: self.canceling, seconds)

    def feedback(self, value: object) -> None:
        """Tell who listens how far it is: an object of the action's Feedback, or a list or dict of
        its fields. Raises TypeError, ValueError, DecodeError for what is none."""
        self._server.tell_feedback(self, value)

    def canceled(self, result: object = None) -> Ended:
        """Return what says that it was given up, as was asked for."""
        return Ended(Status.CANCELED, result)

    def aborted(self, result: object = None) -> Ended:
        """Return what says that it has failed."""
        return Ended(Status.ABORTED, result)


class ActionServer:
    """`handlers` has the functions for the three services; `feedback` and `tell` publish.

    execute(goal): in a thread of its own. accept(request): whether a goal is taken. cancel(goal):
    whether it may be canceled.
    """

    def __init__(
        self,
        name: str,
        action: Action,
        execute: Callable[[Goal], object],
        accept: Callable[[Any], bool] = lambda request: True,
        cancel: Callable[[Goal], bool] = lambda goal: True,
    ) -> None:
        self.name = name
        self.action = action
        self.closing = threading.Event()
        self.changed = threading.Condition(threading.RLock())
        self.publish_feedback: Callable[[object], None] = lambda value: None
        self.publish_status: Callable[[object], None] = lambda value: None
        self._execute = execute
        self._accept = accept
        self._cancel = cancel
        self._goals: dict[bytes, Goal] = {}
        self.handlers: dict[str, Callable[[Question], None]] = {
            "send_goal": self._send_goal,
            "get_result": self._get_result,
            "cancel_goal": self._cancel_goal,
        }

    @property
    def goals(self) -> list[Goal]:
        """Those that are known: under way, or over not long ago."""
        with self.changed:
            return [*self._goals.values()]

    def close(self) -> None:
        """Cancel what is under way. Idempotent."""
        with self.changed:
            self.closing.set()
            self.changed.notify_all()

    # -- the services -----------------------------------------------------------------------------

    def _send_goal(self, question: Question) -> None:
        id_ = id_of(question.request.goal_id)
        goal = Goal(self, id_, question.request.goal)
        with self.changed:
            under_way = sum(not item.status.is_over for item in self._goals.values())
            taken = id_ not in self._goals and under_way < ROS2_GOALS and not self.closing.is_set()
        taken = taken and bool(self._accept(goal.request))
        if taken:
            with self.changed:
                self._goals[id_] = goal
        question.answer({"accepted": taken, "stamp": stamp_of(goal.stamp)})
        if taken:
            self._tell_status()
            name = f"yarpy goal of {self.name}"
            threading.Thread(target=self._run, args=(goal,), name=name, daemon=True).start()

    def _get_result(self, question: Question) -> None:
        id_ = id_of(question.request.goal_id)
        with self.changed:
            goal = self._goals.get(id_)
            if goal is not None and not goal.status.is_over:
                if len(goal._asked) < ROS2_QUESTIONS:
                    goal._asked.append(question)
                    return
                question.fail("too many wait for this result")
                return
        self._answer(question, goal)

    def _cancel_goal(self, question: Question) -> None:
        info = question.request.goal_info
        id_, stamp = id_of(info.goal_id), nanoseconds_of(info.stamp)
        with self.changed:
            chosen = [goal for goal in self._goals.values() if _is_meant(goal, id_, stamp)]
            open_ = [goal for goal in chosen if not goal.status.is_over]
        going = [goal for goal in open_ if goal.status == Status.CANCELING or self._cancel(goal)]
        with self.changed:
            going = [goal for goal in going if not goal.status.is_over]
            for goal in going:
                goal.status = Status.CANCELING
            self.changed.notify_all()
        code = Refusal.NONE
        if id_ != NOTHING and not chosen:
            code = Refusal.UNKNOWN_GOAL
        elif id_ != NOTHING and not open_:
            code = Refusal.TERMINATED
        elif open_ and not going:
            code = Refusal.REJECTED
        infos = [{"goal_id": uuid_of(goal.id), "stamp": stamp_of(goal.stamp)} for goal in going]
        question.answer({"return_code": int(code), "goals_canceling": infos})
        if going:
            self._tell_status()

    # -- a goal -----------------------------------------------------------------------------------

    def _run(self, goal: Goal) -> None:
        """Carry a goal out, in a thread of its own."""
        with self.changed:
            if goal.status == Status.ACCEPTED:
                goal.status = Status.EXECUTING
        self._tell_status()
        try:
            found = self._execute(goal)
            if not isinstance(found, Ended):
                found = Ended(Status.SUCCEEDED, found)
            result = self._result(found.result)
        except FAILURES as error:
            log_failure(log, error, "%s: a goal failed", self.name)
            found = Ended(Status.ABORTED, None)
            result = self._result(None)
        with self.changed:
            goal.status, goal.result = found.status, result
            asked, goal._asked = goal._asked, []
            over = [item for item in self._goals.values() if item.status.is_over]
            for old in over[:-REMEMBERED]:
                del self._goals[old.id]
            self.changed.notify_all()
        self._tell_status()
        for question in asked:
            self._answer(question, goal)

    def _result(self, value: Any) -> Any:
        kind = self.action.Result
        if value is None:
            return kind()
        return value if isinstance(value, Message) else kind.from_bottle(value)

    def _answer(self, question: Question, goal: Goal | None) -> None:
        """Tell a result; of a goal that is not known an empty one."""
        response = self.action.GetResult.Response()
        made: Any = response
        if goal is not None:
            made.status, made.result = int(goal.status), goal.result
        question.answer(response)

    def tell_feedback(self, goal: Goal, value: Any) -> None:
        """Publish how far a goal is."""
        if not isinstance(value, Message):
            value = self.action.Feedback.from_bottle(value)
        message: Any = self.action.FeedbackMessage()
        message.goal_id.uuid, message.feedback = [*goal.id], value
        self.publish_feedback(message)

    def _tell_status(self) -> None:
        with self.changed:
            self.publish_status(
                {
                    "status_list": [
                        {
                            "goal_info": {
                                "goal_id": uuid_of(goal.id),
                                "stamp": stamp_of(goal.stamp),
                            },
                            "status": int(goal.status),
                        }
                        for goal in self._goals.values()
                    ]
                }
            )


def _is_meant(goal: Goal, id_: bytes, stamp: int) -> bool:
    """Return whether who cancels so means that goal: one, all up to a moment, or all."""
    if id_ == NOTHING and not stamp:
        return True
    return goal.id == id_ or (stamp > 0 and goal.stamp <= stamp)
