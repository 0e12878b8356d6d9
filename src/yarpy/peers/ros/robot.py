"""RosRobot: a simulated robot as a node of ROS 1, beside its ports of YARP.

    /icubSim/cam/left                   sensor_msgs/Image, each camera
    /icubSim/joint_states               sensor_msgs/JointState, all joints of all parts
    /icubSim/set_model_configuration    gazebo_msgs/SetModelConfiguration: moves joints
    /tf                                 tf2_msgs/TFMessage, where its parts and cameras are

Rules: ROS measures angles in radians and lengths in metres, YARP in degrees and millimetres. All
names are below the robot's own, also those of frames (icubSim/head), so that it is not taken for
another one. Nothing is measured or drawn while nobody subscribes.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from math import isfinite, radians
from typing import Any, Final

from yarpy.config.configuration import configuration
from yarpy.data.stamp import Stamp
from yarpy.errors import YarpError
from yarpy.kits.devices.closeable import Closeable
from yarpy.kits.devices.control_board.interface import ControlMode
from yarpy.kits.devices.publisher import Publisher
from yarpy.kits.sim.robot import Robot
from yarpy.names.address import is_local
from yarpy.peers.ros.graph_name import ros_name
from yarpy.peers.ros.master import VARIABLE, RosMaster, parse_uri, uri_of
from yarpy.peers.ros.node.node import Node
from yarpy.peers.ros.transform.topic import MOVING, TYPE, transform_of

TRY: Final = """
With ROS, whose master answers at {master}:

  rostopic echo {robot}/joint_states
  rosrun tf tf_echo {model}/root_link {model}/head
  rosrun image_view image_view image:={robot}/cam/left
  rosservice call {robot}/set_model_configuration '' '' '[neck_yaw]' '[0.5]'

"""

QUICK: Final = 0.5  # seconds for a master to answer
PERIOD: Final = 0.02  # seconds between joint states
SERVICE: Final = "gazebo_msgs/SetModelConfiguration"
_UNITS: Final = {"prismatic": 0.001}  # metres in a millimetre


@dataclass(frozen=True)
class _Joint:
    """The board of a joint, its number there, and what one of its units is in ROS."""

    name: str
    board: Any
    number: int
    unit: float


class RosRobot(Closeable):
    """Shows `robot` to ROS while it is open; a context manager. `master` as in ROS_MASTER_URI.

    Raises AddressError if the robot has a name that ROS does not allow, NoNameServer.
    """

    def __init__(self, robot: Robot, master: str | None = None) -> None:
        self._model = robot.name.strip("/")
        self._joints = _joints(robot)
        self._framed = robot.parts.frames
        self._stamp = Stamp()
        framed = set() if self._framed is None else {each.name for each in self._framed.frames()[1]}
        with ExitStack() as resources:
            self.node = node = resources.enter_context(Node(robot.name, master=master))
            for part, port in robot.images.items():
                if "@" not in port.name:  # else it is a topic already, by its name
                    topic = ros_name(f"{robot.name}/{part}")
                    frame = self._frame(part) if part in framed else ""  # else a view of nowhere
                    node.attach(port, topic, "sensor_msgs/Image", frame)
            if self._joints:
                self._states = node.publisher("~joint_states", "sensor_msgs/JointState")
                node.service("~set_model_configuration", SERVICE, self._move)
                publisher = Publisher(f"{robot.name}/joint_states", PERIOD, self._publish)
                resources.callback(publisher.close)
            if self._framed is not None:
                self._places = node.publisher(MOVING, TYPE, queue_size=100)
                mover = Publisher(f"{robot.name}/tf", PERIOD, self._publish_frames)
                resources.callback(mover.close)
            self._resources = resources.pop_all()

    def _publish(self) -> None:
        """Send where the joints are, and how fast they move."""
        if not self._states.outputs:
            return
        positions = {board: board.encoders() for board in self._boards()}
        speeds = {board: board.encoder_speeds() for board in positions}
        when = max(max(board.timestamps()) for board in positions)
        self._stamp = self._stamp.next(when)
        state = {
            "name": [joint.name for joint in self._joints],
            "position": [positions[each.board][each.number] * each.unit for each in self._joints],
            "velocity": [speeds[each.board][each.number] * each.unit for each in self._joints],
        }
        self._states.write(state, self._stamp)

    def _frame(self, name: str) -> str:
        """The name of one of its frames in ROS, where those of all robots are together."""
        return f"{self._model}/{name}"

    def _publish_frames(self) -> None:
        """Send where all frames are."""
        if self._framed is None or not self._places.outputs:
            return
        when, frames = self._framed.frames()
        stamp = [*divmod(round(when * 1e9), 1_000_000_000)]
        made = []
        for each in frames:
            parent, child = self._frame(each.parent), self._frame(each.name)
            made.append(transform_of(parent, child, each.origin, each.orientation, stamp))
        self._places.write({"transforms": made})

    def _boards(self) -> dict[Any, None]:
        return dict.fromkeys(joint.board for joint in self._joints)

    def _move(self, asked: Any) -> tuple[bool, str]:
        """Let joints move to positions; the answer does not wait until they are there."""
        problem = self._problem(asked.model_name, asked.joint_names, asked.joint_positions)
        if problem:
            return False, problem
        wanted = dict(zip(asked.joint_names, map(float, asked.joint_positions), strict=True))
        for board in self._boards():
            chosen = [joint for joint in self._joints if joint.board is board]
            chosen = [joint for joint in chosen if joint.name in wanted]
            if chosen:
                numbers = [joint.number for joint in chosen]
                board.switch_control_modes(numbers, [ControlMode.POSITION] * len(numbers))
                board.position_move(numbers, [wanted[each.name] / each.unit for each in chosen])
        return True, ""

    def _problem(self, model: str, names: Sequence[str], positions: Sequence[float]) -> str:
        """Return why it cannot be done; "" if it can."""
        known = [joint.name for joint in self._joints]
        if model not in ("", self._model):
            return f"there is no model {model!r} here, only {self._model}"
        if len(names) != len(positions):
            return f"{len(names)} names of joints with {len(positions)} positions"
        for name, position in zip(names, positions, strict=True):
            if name not in known:
                return f"there is no joint {name!r}, only {', '.join(known)}"
            if not isfinite(position):
                return f"{name} cannot move to {position}"
        return ""


class RosGuest:
    """ROS as a graph in which a simulated robot is shown, too."""

    title = "ROS"

    def find(self, everywhere: bool) -> str:
        """Return the address of a master that answers soon, "" if there is none. `everywhere`: not
        on this computer alone."""
        uri = _configured()
        found: list[str] = []

        def ask() -> None:
            try:
                master = RosMaster(uri, QUICK)
                if (everywhere or is_local(parse_uri(uri).host)) and master.answers():
                    found.append(master.uri)
            except (YarpError, OSError):
                pass  # there is none

        if uri:
            asking = threading.Thread(target=ask, name="yarpy ros", daemon=True)
            asking.start()
            asking.join(2 * QUICK)  # a host that has to be looked up may take longer
        return found[0] if found else ""

    def show(self, robot: Robot, where: str = "") -> RosRobot:
        """Show the robot as a node, at the master `where` or the usual one."""
        return RosRobot(robot, where or None)

    def advice(self, robot: str, where: str) -> str:
        """Return what to try, for people."""
        return TRY.format(robot=robot, model=robot.strip("/"), master=where)


def _configured() -> str:
    """Return the address of the master that the environment or a file says, "" if neither does."""
    found = configuration(os.environ, on_broken=lambda reason: None)  # a demo needs no file
    stored = [each for each in found.servers if each.mode == "ros"]
    said = next((uri_of(each.host, each.port) for each in stored), "")
    return os.environ.get(VARIABLE) or said


def _joints(robot: Robot) -> list[_Joint]:
    """Return all joints, each with a name of its own: with its part's where two have the same."""
    found: list[_Joint] = []
    boards = robot.parts.boards
    names = [name for board in boards.values() for name in board.axis_names]
    for part, board in boards.items():
        kinds = getattr(board, "axis_types", ["revolute"] * len(board.axis_names))
        for number, (name, kind) in enumerate(zip(board.axis_names, kinds, strict=True)):
            full = name if names.count(name) == 1 else f"{part}/{name}"
            found.append(_Joint(full, board, number, _UNITS.get(kind, radians(1.0))))
    return found
