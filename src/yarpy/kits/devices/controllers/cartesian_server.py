"""CartesianServer: a Cartesian controller for programs of the iCub, C++ and Python.

    <name>/rpc:i        [get] [pose] 9, [go] [xyz] 1.0 (x y z), [set] [time] 2.0 ...
    <name>/command:i    [go] and [tvel] without an answer
    <name>/state:o      where the hand is: seven numbers

Rules: the device has the members of CartesianController; SimulatedArm is one.

Source: ServerCartesianController of icub-main, version 2.0.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from yarpy.data.bottle import Bottle
from yarpy.data.value import Vocab
from yarpy.kits.devices.controllers.client import numbers
from yarpy.kits.devices.controllers.server import ControllerServer
from yarpy.kits.devices.kind import word
from yarpy.kits.devices.refusal import Refused

_NUMBERS = {"time": "trajectory_time", "tol": "tolerance"}
_LISTS = {"dof": "dof", "resp": "rest_position", "resw": "rest_weights"}
_ASKED = {"done": "motion_done", "ison": "is_on"}


class CartesianServer(ControllerServer):
    """Serves `device` as `name`, such as `/icub/cartesianController/left_arm`."""

    RPC = "rpc:i"
    COMMANDS = ("command",)
    STATES = {"state": "state"}
    SETTINGS = (
        *("tracking", "reference_mode", "priority", "trajectory_time", "tolerance", "dof"),
        *("rest_position", "rest_weights", "tip", "joint_limits"),
    )

    def get(self, item: str, rest: Sequence[Any]) -> list[Any]:
        device = self.device
        if item in _NUMBERS:
            return [float(getattr(device, _NUMBERS[item]))]
        if item in _LISTS:
            return [Bottle(map(float, getattr(device, _LISTS[item])))]
        if item in _ASKED:
            return [_truth(getattr(device, _ASKED[item])())]
        match item:
            case "mode":
                return [Vocab("cont" if device.tracking else "shot")]
            case "refe":
                return [_truth(device.reference_mode)]
            case "prio":
                return [str(device.priority)]
            case "lim":
                low, high = device.limits(int(rest[0]))
                return [float(low), float(high)]
            case "des":
                return _solution(device.desired())
            case "qdot":
                return [Bottle(map(float, device.joint_velocities()))]
            case "xdot":
                velocity, turning = device.task_velocities()
                return [Bottle(map(float, (*velocity, *turning)))]
            case "pose":
                found = device.pose(int(rest[0]))
                place = Bottle(map(float, (*found.position, *found.orientation)))
                return [place, Bottle([0, float(found.time)])]
            case "tip":
                position, orientation = device.tip
                return [Bottle(map(float, (*position, *orientation)))]
            case "twea":
                return [Bottle()]
        raise Refused(f"there is no {item} to get")

    def set(self, item: str, rest: Sequence[Any]) -> list[Any]:
        device = self.device
        if item in _NUMBERS:
            setattr(device, _NUMBERS[item], float(rest[0]))
        elif item in _LISTS:
            setattr(device, _LISTS[item], [float(value) for value in rest[0]])
            return [Bottle(map(float, getattr(device, _LISTS[item])))]
        elif item == "mode":
            device.tracking = word(rest[0]) == "cont"
        elif item == "refe":
            device.reference_mode = word(rest[0]) == "true"
        elif item == "prio":
            device.priority = str(rest[0])
        elif item == "lim":
            device.change_limits(int(rest[0]), float(rest[1]), float(rest[2]))
        elif item == "tip":
            place = numbers(rest[0], 7, "a frame")
            device.tip = place[:3], place[3:]
        else:
            raise Refused(f"there is no {item} to set")
        return []

    def act(self, verb: str, rest: Sequence[Any]) -> list[Any]:
        if verb == "go":
            self._go(rest)
            return []
        if verb == "ask":
            given = {word(each[0]): each[1] for each in rest if isinstance(each, Bottle)}
            full = word(given.get("pose", Vocab("full"))) == "full"
            goal = numbers(given["xd"], 7 if full else len(given["xd"]), "a goal")
            start = [float(value) for value in given["q"]] if "q" in given else None
            return _solution(self.device.solve(goal[:3], goal[3:] if full else None, start))
        if verb == "even" and word(rest[1]) == "ogoi":
            return self._share(word(rest[0]) == "regi", rest[2])
        raise Refused(f"there is no {verb}")

    def command(self, port: str, words: Sequence[Any]) -> None:
        if word(words[0]) == "tvel":
            goal = numbers(words[1], 7, "a velocity")
            self.device.move(goal[:3], goal[3:])
        elif word(words[0]) == "go":
            self._go(words[1:])
        else:
            raise Refused("commands are [go] and [tvel]")

    def _go(self, rest: Sequence[Any]) -> None:
        full = word(rest[0]) == "full"
        goal = numbers(rest[2], 7 if full else 3, "a goal")
        self.device.go_to(goal[:3], goal[3:] if full else None, float(rest[1]))


def _truth(value: object) -> Vocab:
    return Vocab("true" if value else "fals")


def _solution(found: Any) -> list[Any]:
    place = Bottle(map(float, (*found.position, *found.orientation)))
    joints = Bottle(map(float, found.joints))
    return [Bottle([Vocab("x"), place]), Bottle([Vocab("q"), joints])]
