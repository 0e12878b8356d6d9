"""GazeServer: a gaze controller for programs of the iCub, C++ and Python.

    <name>/rpc              [get] [done], [look] [3D] (x y z), [set] [Tneck] 1.0 ...
    <name>/xd:i .../angles:i .../mono:i .../stereo:i    where to look, without an answer
    <name>/x:o  .../angles:o .../q:o                    where it looks; its joints

Rules: the device has the members of GazeController; SimulatedHead is one.

Source: iKinGazeCtrl of icub-main, version 2.0.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from yarpy.data.bottle import Bottle
from yarpy.kits.devices.controllers.client import numbers
from yarpy.kits.devices.controllers.server import ControllerServer
from yarpy.kits.devices.kind import word
from yarpy.kits.devices.refusal import Refused

_NUMBERS = {
    "Tnec": "neck_time",
    "Teye": "eyes_time",
    "vor": "vor_gain",
    "ocr": "ocr_gain",
    "sinh": "saccade_inhibition",
    "sact": "saccade_angle",
    "ntol": "neck_tolerance",
}
_SWITCHES = {"trac": "tracking", "stab": "stabilization", "sacc": "saccades"}
_JOINTS = {"pitc": "pitch", "roll": "roll", "yaw": "yaw"}
_LISTS = {"des": "desired_joints", "vel": "joint_velocities"}


class GazeServer(ControllerServer):
    """Serves `device` as `name`, such as `/iKinGazeCtrl`."""

    RPC = "rpc"
    COMMANDS = ("xd", "angles", "mono", "stereo")
    STATES = {"x": "fixation_point", "angles": "angles", "q": "joints"}
    SETTINGS = (*_NUMBERS.values(), *_SWITCHES.values(), "ranges", "kept_vergence")

    def get(self, item: str, rest: Sequence[Any]) -> list[Any]:
        device = self.device
        if item in _NUMBERS:
            return [float(getattr(device, _NUMBERS[item]))]
        if item in _SWITCHES:
            return [int(getattr(device, _SWITCHES[item]))]
        if item in _JOINTS:
            low, high = device.neck_range(_JOINTS[item])
            return [float(low), float(high)]
        if item in _LISTS:
            return [Bottle(map(float, getattr(device, _LISTS[item])()))]
        match item:
            case "done":
                return [int(device.motion_done())]
            case "sdon":
                return [int(device.saccade_done())]
            case "eyes":
                return [float(device.bound_vergence())]
            case "pose":
                found = device.pose(str(rest[0]))
                place = Bottle(map(float, (*found.position, *found.orientation)))
                return [place, Bottle([0, float(found.time)])]
            case "2D":
                return _list(device.pixel(str(rest[0][0]), numbers(rest[0][1:4], 3, "a point")))
            case "3D":
                return _list(self._point(word(rest[0]), rest[1]))
            case "ang":
                return _list(device.direction(numbers(rest[0], 3, "a point")))
            case "pid":
                return [device.stereo_options()]
            case "twea":
                return [Bottle()]
        raise Refused(f"there is no {item} to get")

    def _point(self, how: str, goal: Sequence[Any]) -> Sequence[float]:
        device = self.device
        if how == "mono":
            return self._seen(goal)
        found: Sequence[float]
        if how == "ster":
            both = numbers(goal, 4, "two pixels")
            found = device.triangulate(both[:2], both[2:])
        elif how == "proj":
            plane = numbers(goal[3:], 4, "a plane")
            found = device.point_on_plane(str(goal[0]), numbers(goal[1:3], 2, "a pixel"), plane)
        elif how == "ang":
            angles = numbers(goal[1:], 3, "a direction")
            found = device.point_in_direction(angles, word(goal[0]) == "rel")
        else:
            raise Refused(f"there is no point by {how}")
        return found

    def _seen(self, goal: Sequence[Any]) -> Sequence[float]:
        """The point at a pixel: so far away, or where the eyes have a vergence."""
        pixel = numbers(goal[1:3], 2, "a pixel")
        if word(goal[3]) == "ver":
            distance = self.device.distance(float(goal[4]))
        else:
            distance = float(goal[3])
        found: Sequence[float] = self.device.point(str(goal[0]), pixel, distance)
        return found

    def set(self, item: str, rest: Sequence[Any]) -> list[Any]:
        if item in _NUMBERS:
            setattr(self.device, _NUMBERS[item], float(rest[0]))
        elif item in _SWITCHES:
            setattr(self.device, _SWITCHES[item], int(rest[0]) > 0)
        elif item == "pid":
            self.device.change_stereo_options(Bottle(rest[0]))
        else:
            raise Refused(f"there is no {item} to set")
        return []

    def act(self, verb: str, rest: Sequence[Any]) -> list[Any]:
        item = word(rest[0])
        if verb == "look":
            goal = rest[1]
            ports = {"3D": "xd", "ang": "angles", "mono": "mono", "ster": "stereo"}
            self.command(ports[item], goal)
        elif verb == "bind" and item == "eyes":
            self.device.bind_eyes(float(rest[1]))
        elif verb == "bind":
            self.device.bind_neck(_JOINTS[item], float(rest[1]), float(rest[2]))
        elif verb == "clea":
            self.device.free("eyes" if item == "eyes" else _JOINTS[item])
        elif verb in ("regi", "unre") and item == "ongo":
            return self._share(verb == "regi", rest[1])
        else:
            raise Refused(f"there is no {verb}")
        return []

    def command(self, port: str, words: Sequence[Any]) -> None:
        if port == "xd":
            self.device.look_at(numbers(words, 3, "a point"))
        elif port == "angles":
            angles = numbers(words[1:], 3, "a direction")
            self.device.turn_to(angles, relative=word(words[0]) == "rel")
        elif port == "mono":
            self.device.look_at(self._seen(words))
        else:
            self.device.look_at(self._point("ster", words))


def _list(values: Sequence[float]) -> list[Any]:
    return [Bottle(map(float, values))]
