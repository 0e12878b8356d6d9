"""The client of an action: sends goals, and hears how far they are and what came of them.

Rules: feedback comes in a thread of Zenoh or of the node, so what it calls does something short.
The result is asked for as soon as a goal is accepted; whoever waits for it has a time limit.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any

from yarpy.errors import LocalProtocolError, RemoteProtocolError
from yarpy.log import log_failure, logger
from yarpy.monitors.base import FAILURES
from yarpy.peers.ros.message.message import Message
from yarpy.peers.ros2.action.status import Refusal, Status, id_of, new_id, uuid_of
from yarpy.peers.ros2.exchange import Worker, result_of
from yarpy.peers.ros2.message.library import Action
from yarpy.peers.ros2.rmw import Caller

log = logger("yarpy.ros2")


class SentGoal:
    """A goal that a server has accepted."""

    def __init__(self, client: ActionClient, id_: bytes, told: Callable[[Any], object]) -> None:
        self.id = id_
        self.told = told  # gets feedback
        self._client = client
        self._result: Future[Any] = client.ask_result(id_)
        self._result.add_done_callback(lambda future: client.over(id_))

    @property
    def status(self) -> Status:
        """The status of the goal, as the server said last."""
        if self._result.done() and self._result.exception() is None:
            return Status(self._result.result().status)
        return self._client.statuses.get(self.id, Status.ACCEPTED)

    @property
    def done(self) -> bool:
        """Return whether there is a result."""
        return self._result.done()

    def result(self, timeout: float | None = None) -> Any:
        """Return the result, an object of the action's Result; `status` says what came of the goal.
        Raises Timeout, LinkClosed (the server has gone), RemoteProtocolError."""
        return result_of(self._result, timeout, self._client.name).result

    def cancel(self, timeout: float | None = 10.0) -> None:
        """Ask the server to give it up. Raises RemoteProtocolError where it refuses; Timeout,
        LinkClosed."""
        self._client.cancel(self.id, timeout)


class ActionClient:
    """Asks by three callers, which are its own: `close` closes them. `worker`: hands over what is
    published."""

    def __init__(
        self,
        name: str,
        action: Action,
        send: Caller,
        get: Caller,
        cancel: Caller,
        worker: Worker,
    ) -> None:
        self.name = name
        self.action = action
        self.statuses: dict[bytes, Status] = {}
        self._send = send
        self._get = get
        self._cancel = cancel
        self._worker = worker
        self._goals: dict[bytes, Callable[[Any], object]] = {}
        self._lock = threading.Lock()  # goals come and go in any thread

    def wait_for_server(self, timeout: float | None = None) -> bool:
        """Wait until somebody takes goals; return False if time is over."""
        return self._send.wait(timeout) and self._get.wait(timeout)

    def send(
        self,
        goal: object,
        feedback: Callable[[Any], object] = lambda feedback: None,
        timeout: float | None = 10.0,
    ) -> SentGoal:
        """Send a goal: an object of the action's Goal, or a list or dict of its fields.

        `feedback` is called with objects of the action's Feedback. Raises UnknownName (nobody takes
        goals), LocalProtocolError (the server does not accept it), Timeout, LinkClosed.
        """
        id_ = new_id()
        if not isinstance(goal, Message):
            goal = self.action.Goal.from_bottle(goal)
        request: Any = self.action.SendGoal.Request()
        request.goal_id.uuid, request.goal = [*id_], goal
        with self._lock:
            self._goals[id_] = feedback  # some may come before the answer
        try:
            answer = self._send.call(request, timeout)
            if not answer.accepted:
                raise LocalProtocolError(f"{self.name} does not accept the goal")
        except BaseException:
            self.forget(id_)
            raise
        return SentGoal(self, id_, feedback)

    def ask_result(self, id_: bytes) -> Future[Any]:
        """Ask for the result of a goal; the answer comes when it is over."""
        return self._get.ask({"goal_id": uuid_of(id_)})

    def cancel(self, id_: bytes, timeout: float | None) -> None:
        """Ask the server to give a goal up. Raises as `SentGoal.cancel`."""
        answer = self._cancel.call({"goal_info": {"goal_id": uuid_of(id_)}}, timeout)
        if answer.return_code != Refusal.NONE:
            known = answer.return_code in [*Refusal]
            why = Refusal(answer.return_code).name if known else str(answer.return_code)
            raise RemoteProtocolError(f"{self.name} does not cancel the goal: {why}")

    def over(self, id_: bytes) -> None:
        """A result has come: feedback that came before is still told."""
        if not self._worker.put(self.forget, id_):
            self.forget(id_)

    def forget(self, id_: bytes) -> None:
        """Nobody wants to hear of a goal any more."""
        with self._lock:
            self._goals.pop(id_, None)
            self.statuses.pop(id_, None)

    def hear_feedback(self, message: Any) -> None:
        """An object of the action's FeedbackMessage has come, of any goal."""
        told = self._goals.get(id_of(message.goal_id))
        if told is not None:
            try:
                told(message.feedback)
            except FAILURES as error:
                log_failure(log, error, "%s: what takes the feedback failed", self.name)

    def hear_status(self, message: Any) -> None:
        """An object of action_msgs/msg/GoalStatusArray has come, of all goals."""
        for item in message.status_list:
            id_ = id_of(item.goal_info.goal_id)
            if id_ in self._goals and 0 <= item.status <= max(Status):
                self.statuses[id_] = Status(item.status)

    def close(self) -> None:
        """Give back what was used. Idempotent."""
        for caller in (self._send, self._get, self._cancel):
            caller.close()
