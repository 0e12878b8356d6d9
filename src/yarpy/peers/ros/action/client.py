"""The client of an action of ROS 1: sends goals, and hears how far they are and what came of them.

    client = yarpy.ros.ActionClient(node, "/count", "actionlib_tutorials/Fibonacci")
    client.wait_for_server(5.0)
    print(client.send([6]).result(timeout=10.0).sequence)

Rules: feedback comes in the thread of its connection, so what it calls does something short. Who
waits for a result learns when the server goes away, also where another one is in its place at once.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any, Final
from weakref import WeakValueDictionary

from yarpy.errors import DecodeError, LinkClosed, Timeout
from yarpy.log import logger
from yarpy.peers.ros.action.status import (
    CANCEL_TYPE,
    STATUS_TYPE,
    Status,
    made,
    stamp_of,
    status_of,
    types_of,
)
from yarpy.peers.ros.message.library import default_library

log = logger("yarpy.ros")

SLICE: Final = 0.1  # seconds of each wait, after which the server is looked for
GRACE: Final = 3.0  # seconds that a server may be away


class SentGoal:
    """A goal that was sent. `status`: how far it is, as the server said last."""

    def __init__(
        self, client: ActionClient, id_: str, stamp: float, told: Callable[[Any], object]
    ) -> None:
        self.id = id_
        self.stamp = stamp  # seconds
        self.status = Status.PENDING
        self.text = ""  # what the server says beside the result
        self.told = told
        self.found: Any = None
        self.listed = False  # whether the server knows of it: its status names all such goals
        self.forgotten = 0.0  # since when it does not any more: another server has that name now
        self._client = client

    @property
    def done(self) -> bool:
        """Return whether there is a result."""
        return self.found is not None

    def result(self, timeout: float | None = None) -> Any:
        """Return the result, an object of the action's Result; `status` says what came of the goal.
        Raises Timeout, LinkClosed (the server has gone)."""
        return self._client.await_result(self, timeout)

    def cancel(self) -> None:
        """Ask the server to give it up."""
        self._client.cancel(self.id)


class ActionClient:
    """Of the node `node`; its topics are closed with that, or by `close`. Raises AddressError,
    UnknownType."""

    def __init__(self, node: Any, name: str, type_: str) -> None:
        self.name = node.resolve(name)
        self.types = types = types_of(type_)
        self._node = node
        self._count = 0
        self._goals: dict[str, SentGoal] = {}
        # Those that are over, while somebody holds them: feedback has a connection of its own, and
        # may come behind the result.
        self._over: WeakValueDictionary[str, SentGoal] = WeakValueDictionary()
        self._changed = threading.Condition(threading.RLock())

        def place(what: str) -> str:
            return f"{self.name}/{what}"

        self._goal = node.publisher(place("goal"), types.ActionGoal, queue_size=10)
        self._cancel = node.publisher(place("cancel"), CANCEL_TYPE, queue_size=10)
        self._heard = [
            node.subscriber(place("feedback"), types.ActionFeedback, self._hear_feedback),
            node.subscriber(place("result"), types.ActionResult, self._hear_result),
            node.subscriber(place("status"), STATUS_TYPE, self._hear_status),
        ]

    @property
    def is_served(self) -> bool:
        """Return whether a server is connected by all five topics."""
        writes = self._goal.outputs and self._cancel.outputs
        return bool(writes) and all(port.inputs for port in self._heard)

    def wait_for_server(self, timeout: float | None = None) -> bool:
        """Wait until somebody takes goals; return False if time is over."""
        deadline = None if timeout is None else time.monotonic() + timeout
        while not self.is_served:
            left = SLICE if deadline is None else min(SLICE, deadline - time.monotonic())
            if left <= 0:
                return False
            time.sleep(min(left, 0.02))
        return True

    def send(
        self, goal: object, feedback: Callable[[Any], object] = lambda feedback: None
    ) -> SentGoal:
        """Send a goal: an object of the action's Goal, or a list or dict of its fields.

        `feedback` is called with objects of the action's Feedback. A server that comes later does
        not get it: see `wait_for_server`. Raises TypeError, ValueError, DecodeError.
        """
        message: Any = self.types.ActionGoal()
        message.goal = made(self.types.Goal, goal)
        now = self._node.now()
        with self._changed:
            self._count += 1
            id_ = f"{self._node.name}-{self._count}-{now:.9f}"
            sent = self._goals[id_] = SentGoal(self, id_, now, feedback)
        message.goal_id.id = id_
        message.header.stamp = message.goal_id.stamp = stamp_of(now)
        self._goal.write(message)
        return sent

    def cancel(self, id_: str) -> None:
        """Ask the server to give a goal up; "" for all goals, of other clients too."""
        message: Any = default_library().message(CANCEL_TYPE)()
        message.id = id_
        self._cancel.write(message)

    def await_result(self, goal: SentGoal, timeout: float | None) -> Any:
        """Return the result of a goal; see `SentGoal.result`."""
        deadline = None if timeout is None else time.monotonic() + timeout
        away = 0.0  # since when the server is
        while True:
            with self._changed:
                left = SLICE if deadline is None else min(SLICE, deadline - time.monotonic())
                if self._changed.wait_for(lambda: goal.done, max(left, 0.0)):
                    return goal.found
            now = time.monotonic()
            away = 0.0 if self.is_served else away or now
            if any(since and now - since > GRACE for since in (away, goal.forgotten)):
                goal.status = Status.LOST
                raise LinkClosed(f"who serves {self.name} went away before the goal was over")
            if deadline is not None and now >= deadline:
                raise Timeout(f"{self.name} has no result within {timeout} s")

    def close(self) -> None:
        """Close the topics. Goals under way go on at the server. Idempotent."""
        for port in (*self._heard, self._goal, self._cancel):
            port.close()

    # -- what comes -------------------------------------------------------------------------------

    def _hear_feedback(self, message: Any) -> None:
        id_ = message.status.goal_id.id
        goal = self._goals.get(id_) or self._over.get(id_)
        if goal is not None:
            self._note(goal, message.status)
            goal.told(message.feedback)

    def _hear_status(self, message: Any) -> None:
        told = {item.goal_id.id: item for item in message.status_list}
        now = time.monotonic()
        for goal in [*self._goals.values()]:
            item = told.get(goal.id)
            if item is not None:
                goal.listed, goal.forgotten = True, 0.0
                self._note(goal, item)
            elif goal.listed and not goal.forgotten:
                goal.forgotten = now  # the result has a connection of its own, and may still come

    def _hear_result(self, message: Any) -> None:
        goal = self._goals.get(message.status.goal_id.id)
        if goal is None:
            return
        with self._changed:
            self._note(goal, message.status)
            goal.found = message.result
            self._over[goal.id] = goal
            del self._goals[goal.id]
            self._changed.notify_all()

    def _note(self, goal: SentGoal, status: Any) -> None:
        """The server has said how far a goal is; what came of it is not changed by older news."""
        try:
            now = status_of(status.status)
        except DecodeError as error:
            log.warning("%s: %s", self.name, error)
            return
        if not goal.status.is_over:
            goal.status, goal.text = now, status.text
