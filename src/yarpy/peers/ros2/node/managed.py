"""A managed node: others configure and activate it, and take that back (`ros2 lifecycle set`).

    class Driver(yarpy.ros2.LifecycleNode):
        def on_configure(self):
            self.scan = self.lifecycle_publisher("scan", "sensor_msgs/msg/LaserScan")

Rules: services, topic and states are those of rclcpp's LifecycleNode. What `on_...` raises is an
error, False a failure, everything else success. One transition is under way at a time, in the
thread that asked for it, or in one of the node's own where another node did. Publishers made by
`lifecycle_publisher` say nothing while the node is not active.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any, Final

from yarpy.log import log_failure
from yarpy.monitors.base import FAILURES
from yarpy.peers.ros2.exchange import Question, Worker
from yarpy.peers.ros2.node.node import Node
from yarpy.peers.ros2.node.state import (
    GRAPH,
    Outcome,
    State,
    Transition,
    available,
    end_of,
    find,
)
from yarpy.peers.ros2.qos import Qos
from yarpy.peers.ros2.rmw import Writer

EVENT: Final = "lifecycle_msgs/msg/TransitionEvent"
_TRANSITIONS: Final = "lifecycle_msgs/srv/GetAvailableTransitions"
_CALLED: Final = {
    State.CONFIGURING: "on_configure",
    State.CLEANINGUP: "on_cleanup",
    State.ACTIVATING: "on_activate",
    State.DEACTIVATING: "on_deactivate",
    State.SHUTTINGDOWN: "on_shutdown",
}


class LifecyclePublisher:
    """Publishes while its node is active."""

    def __init__(self, writer: Writer, is_active: Callable[[], bool]) -> None:
        self.writer = writer
        self._is_active = is_active

    def write(self, value: object) -> bool:
        """Send a value; return False, and do nothing, while the node is not active."""
        if not self._is_active():
            return False
        self.writer.write(value)
        return True


class LifecycleNode(Node):
    """A node with states; it begins unconfigured. Arguments are those of a Node."""

    def __init__(self, name: str, **said: Any) -> None:
        self._state = State.UNCONFIGURED
        self._changing = threading.RLock()  # one transition at a time; an `on_` may ask for another
        super().__init__(name, **said)
        try:
            self._event = self.publisher("~/transition_event", EVENT)
            worker = self._keep(Worker(f"yarpy states of {self.name}"))
            for service, (kind, handler) in {
                "change_state": ("lifecycle_msgs/srv/ChangeState", self._change),
                "get_state": ("lifecycle_msgs/srv/GetState", self._get),
                "get_available_states": ("lifecycle_msgs/srv/GetAvailableStates", self._states),
                "get_available_transitions": (_TRANSITIONS, self._available),
                "get_transition_graph": (_TRANSITIONS, self._graph),
            }.items():
                # A question for the state is answered while a transition is under way.
                own = worker if service == "change_state" else self._worker
                self._answer(f"{self.name}/{service}", kind, handler, own, None)
        except BaseException:
            self.close()
            raise

    # -- what a driver fills in -------------------------------------------------------------------

    def on_configure(self) -> bool | None:
        """Read parameters, make publishers: the node becomes inactive."""

    def on_activate(self) -> bool | None:
        """Begin to work."""

    def on_deactivate(self) -> bool | None:
        """Stop working."""

    def on_cleanup(self) -> bool | None:
        """Take back what `on_configure` has made."""

    def on_shutdown(self) -> bool | None:
        """The node will not be used any more."""

    def on_error(self) -> bool | None:
        """An `on_` has raised: True if the node may be configured anew; else it is finalized."""
        return False

    # -- its states -------------------------------------------------------------------------------

    @property
    def state(self) -> State:
        """The present state."""
        return self._state

    def lifecycle_publisher(
        self, topic: str, type_: str, *, qos: str | Qos | None = None
    ) -> LifecyclePublisher:
        """Publish a topic while the node is active. Raises AddressError, UnknownType."""
        writer = self.publisher(topic, type_, qos=qos)
        return LifecyclePublisher(writer, lambda: self._state is State.ACTIVE)

    def trigger(self, label: str) -> bool:
        """Go the way of that name: configure, activate, deactivate, cleanup, shutdown. Return
        whether the node came to its end; False also where it does not begin in this state."""
        with self._changing:
            found = find(self._state, 0, label)
            return found is not None and self._go(found)

    # -- how --------------------------------------------------------------------------------------

    def _go(self, way: Transition) -> bool:
        self._step(way)
        try:
            said = getattr(self, _CALLED[way.goal])()
            outcome = Outcome.FAILURE if said is False else Outcome.SUCCESS
        except FAILURES as error:
            log_failure(self.logger, error, "%s: %s failed", self.name, _CALLED[way.goal])
            outcome = Outcome.ERROR
        self._step(end_of(way.goal, outcome))
        if outcome is Outcome.ERROR:
            try:
                handled = Outcome.SUCCESS if self.on_error() is True else Outcome.FAILURE
            except FAILURES as error:
                log_failure(self.logger, error, "%s: on_error failed", self.name)
                handled = Outcome.ERROR
            self._step(end_of(State.ERRORPROCESSING, handled))
        return outcome is Outcome.SUCCESS

    def _step(self, way: Transition) -> None:
        self._state = way.goal
        if not self._closed:
            self._event.write({"timestamp": time.time_ns(), **_described(way)})

    def _change(self, question: Question) -> None:
        asked = question.request.transition
        with self._changing:
            found = find(self._state, asked.id, asked.label)
            if found is None:
                self.logger.warning(
                    "%s is %s: it cannot %s", self.name, self._state.label, asked.label or asked.id
                )
            done = found is not None and self._go(found)
        question.answer({"success": done})

    def _get(self, question: Question) -> None:
        question.answer({"current_state": _state(self._state)})

    def _states(self, question: Question) -> None:
        question.answer({"available_states": [_state(item) for item in State]})

    def _available(self, question: Question) -> None:
        ways = [_described(item) for item in available(self._state)]
        question.answer({"available_transitions": ways})

    def _graph(self, question: Question) -> None:
        question.answer({"available_transitions": [_described(item) for item in GRAPH]})


def _state(state: State) -> dict[str, Any]:
    return {"id": int(state), "label": state.label}


def _described(way: Transition) -> dict[str, Any]:
    return {
        "transition": {"id": way.id, "label": way.label},
        "start_state": _state(way.start),
        "goal_state": _state(way.goal),
    }
