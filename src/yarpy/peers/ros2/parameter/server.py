"""The services by which others see and change the parameters of a node, and the topic that tells of
changes. Tools of ROS 2 (`ros2 param`) and its nodes use them.

Rules: names, types and QoS are those of rclpy. A question is answered in the node's worker; what a
change refuses is the reason that who asked for it is told.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import Any, Final

from yarpy.errors import UnknownName
from yarpy.peers.ros2.exchange import Question
from yarpy.peers.ros2.parameter.store import Change, Descriptor, Parameters
from yarpy.peers.ros2.parameter.value import DOUBLE, INTEGER, NOT_SET, from_ros, named, to_ros
from yarpy.peers.ros2.qos import Qos

EVENTS: Final = "/parameter_events"
EVENT: Final = "rcl_interfaces/msg/ParameterEvent"
QOS: Final = Qos(depth=1000)

#: the services below the name of a node, and their types
SERVICES: Final = {
    "describe_parameters": "rcl_interfaces/srv/DescribeParameters",
    "get_parameter_types": "rcl_interfaces/srv/GetParameterTypes",
    "get_parameters": "rcl_interfaces/srv/GetParameters",
    "list_parameters": "rcl_interfaces/srv/ListParameters",
    "set_parameters": "rcl_interfaces/srv/SetParameters",
    "set_parameters_atomically": "rcl_interfaces/srv/SetParametersAtomically",
}


class Asked:
    """Answers the questions for the parameters of a node; `handlers` has one for each service."""

    def __init__(self, parameters: Parameters) -> None:
        self._all = parameters
        self.handlers: dict[str, Callable[[Question], None]] = {
            name: getattr(self, f"_{name}") for name in SERVICES
        }

    def _get_parameters(self, question: Question) -> None:
        names = question.request.names
        values = [self._all.get(name) if self._all.has(name) else None for name in names]
        question.answer({"values": [to_ros(value) for value in values]})

    def _get_parameter_types(self, question: Question) -> None:
        names = question.request.names
        kinds = [self._all.described(name)[0] if self._all.has(name) else NOT_SET for name in names]
        question.answer({"types": bytes(kinds)})

    def _describe_parameters(self, question: Question) -> None:
        question.answer({"descriptors": [self._described(name) for name in question.request.names]})

    def _described(self, name: str) -> dict[str, Any]:
        if not self._all.has(name):
            return {"name": name}
        kind, found = self._all.described(name)
        return {
            "name": name,
            "type": kind,
            "description": found.description,
            "additional_constraints": found.constraints,
            "read_only": found.read_only,
            "dynamic_typing": found.dynamic,
            **_range(kind, found),
        }

    def _list_parameters(self, question: Question) -> None:
        asked = question.request
        names = self._all.names(asked.prefixes, asked.depth)
        prefixes = sorted({name.rpartition(".")[0] for name in names} - {""})
        question.answer({"result": {"names": names, "prefixes": prefixes}})

    def _set_parameters(self, question: Question) -> None:
        results = [self._set([item]) for item in question.request.parameters]
        question.answer({"results": results})

    def _set_parameters_atomically(self, question: Question) -> None:
        question.answer({"result": self._set(question.request.parameters)})

    def _set(self, items: Any) -> dict[str, Any]:
        try:
            self._all.set({item.name: from_ros(item.value) for item in items})
        except (UnknownName, TypeError, ValueError) as error:
            return {"successful": False, "reason": str(error)}
        return {"successful": True}


def _range(kind: int, found: Descriptor) -> dict[str, Any]:
    if found.low is None or found.high is None or kind not in (INTEGER, DOUBLE):
        return {}
    limits = {"from_value": found.low, "to_value": found.high, "step": found.step}
    if kind == DOUBLE:
        return {"floating_point_range": [limits]}
    return {"integer_range": [{name: int(value) for name, value in limits.items()}]}


def event(node: str, change: Change) -> dict[str, Any]:
    """Return a change as the fields of a ParameterEvent."""
    seconds, nanoseconds = divmod(time.time_ns(), 1_000_000_000)
    parts: Mapping[str, Mapping[str, Any]] = {
        "new_parameters": change.new,
        "changed_parameters": change.changed,
        "deleted_parameters": change.deleted,
    }
    return {
        "stamp": {"sec": seconds, "nanosec": nanoseconds},
        "node": node,
        **{name: named(values) for name, values in parts.items()},
    }
