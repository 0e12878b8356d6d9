"""RobotState: what a simulated robot tells of itself in ROS, of the one kind as of the other.

    /icubSim/joint_states    sensor_msgs/JointState, all joints of all parts
    /tf                      tf2_msgs/TFMessage, where its parts and cameras are

Rules: ROS measures angles in radians and lengths in metres, YARP in degrees and millimetres. All
names are below the robot's own, also those of frames (icubSim/head), so that it is not taken for
another one. Nothing is measured while nobody subscribes. Which ROS it is, the caller says: how a
topic is published, and how a time is spelled.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass
from math import radians
from typing import Any, Final, TypeAlias

from yarpy.kits.devices.closeable import Closeable
from yarpy.kits.devices.publisher import Publisher
from yarpy.kits.sim.robot import Robot
from yarpy.peers.ros.transform.topic import MOVING, TYPE, transform_of

PERIOD: Final = 0.02  # seconds between two messages of a topic
STATES: Final = "joint_states"  # below the name of the robot
STATE: Final = "sensor_msgs/JointState"
_UNITS: Final = {"prismatic": 0.001}  # metres in a millimetre


@dataclass(frozen=True)
class Published:
    """A topic that is published: whether anybody subscribes, and how a message is sent."""

    is_heard: Callable[[], object]
    write: Callable[[dict[str, Any]], object]


#: publishes a topic of a type, as ROS 1 spells both
Publish: TypeAlias = Callable[[str, str], Published]

#: the fields of a time, of its seconds and nanoseconds
Stamp: TypeAlias = Callable[[int, int], object]


@dataclass(frozen=True)
class Joint:
    """The board of a joint, its number there, and what one of its units is in ROS."""

    name: str
    board: Any
    number: int
    unit: float


class RobotState(Closeable):
    """Publishes the state of `robot` while it is open; a context manager. `model` is what the robot
    is called in ROS, `joints` are all it has."""

    def __init__(self, robot: Robot, publish: Publish, stamp: Stamp) -> None:
        self.model = robot.name.strip("/")
        self.joints = _joints(robot)
        self.boards: list[Any] = [*dict.fromkeys(joint.board for joint in self.joints)]
        self._framed = robot.parts.frames
        self._stamp = stamp
        with ExitStack() as resources:
            topics: list[tuple[str, str, Callable[[], dict[str, Any]]]] = []
            if self.joints:
                topics.append((f"{robot.name}/{STATES}", STATE, self._measured))
            if self._framed is not None:
                topics.append((MOVING, TYPE, self._transforms))
            for topic, type_, made in topics:
                step = _step(publish(topic, type_), made)
                publisher = Publisher(f"{robot.name} {topic}", PERIOD, step)
                resources.callback(publisher.close)
            self._resources = resources.pop_all()

    def frame(self, name: str) -> str:
        """Return the name of one of its frames in ROS, where those of all robots are together."""
        return f"{self.model}/{name}"

    def frame_of(self, part: str) -> str:
        """Return the frame of what a camera sees; "" where nobody knows its place."""
        framed = [] if self._framed is None else self._framed.frames()[1]
        return self.frame(part) if any(each.name == part for each in framed) else ""

    def _measured(self) -> dict[str, Any]:
        """Return where the joints are, and how fast they move."""
        positions = {board: board.encoders() for board in self.boards}
        speeds = {board: board.encoder_speeds() for board in self.boards}
        when = max(max(board.timestamps()) for board in self.boards)
        return {
            "header": {"stamp": self._time(when)},
            "name": [joint.name for joint in self.joints],
            "position": [positions[each.board][each.number] * each.unit for each in self.joints],
            "velocity": [speeds[each.board][each.number] * each.unit for each in self.joints],
        }

    def _transforms(self) -> dict[str, Any]:
        """Return where all frames are."""
        assert self._framed is not None
        when, frames = self._framed.frames()
        stamp, made = self._time(when), []
        for each in frames:
            parent, child = self.frame(each.parent), self.frame(each.name)
            made.append(transform_of(parent, child, each.origin, each.orientation, stamp))
        return {"transforms": made}

    def _time(self, seconds: float) -> object:
        return self._stamp(*divmod(round(seconds * 1e9), 1_000_000_000))


def _step(topic: Published, made: Callable[[], dict[str, Any]]) -> Callable[[], None]:
    def step() -> None:
        if topic.is_heard():
            topic.write(made())

    return step


def _joints(robot: Robot) -> list[Joint]:
    """Return all joints, each with a name of its own: with its part's where two have the same."""
    found: list[Joint] = []
    boards = robot.parts.boards
    names = [name for board in boards.values() for name in board.axis_names]
    for part, board in boards.items():
        kinds = getattr(board, "axis_types", ["revolute"] * len(board.axis_names))
        for number, (name, kind) in enumerate(zip(board.axis_names, kinds, strict=True)):
            full = name if names.count(name) == 1 else f"{part}/{name}"
            found.append(Joint(full, board, number, _UNITS.get(kind, radians(1.0))))
    return found
