"""RosRobot: a simulated robot as a node of ROS 1, beside its ports of YARP.

    /icubSim/cam/left                   sensor_msgs/Image, each camera
    /icubSim/joint_states               sensor_msgs/JointState, all joints of all parts
    /icubSim/set_model_configuration    gazebo_msgs/SetModelConfiguration: moves joints
    /tf                                 tf2_msgs/TFMessage, where its parts and cameras are

Rules: those of `robot_state`, which has the joints and the frames. Nothing is drawn while nobody
subscribes.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Sequence
from contextlib import ExitStack
from math import isfinite
from typing import Any, Final

from yarpy.config.configuration import configuration
from yarpy.errors import YarpError
from yarpy.kits.devices.closeable import Closeable
from yarpy.kits.devices.control_board.interface import ControlMode
from yarpy.kits.sim.robot import Robot
from yarpy.names.address import is_local
from yarpy.peers.ros.graph_name import ros_name
from yarpy.peers.ros.master import VARIABLE, RosMaster, parse_uri, uri_of
from yarpy.peers.ros.node.node import Node
from yarpy.peers.ros.robot_state import Published, RobotState

TRY: Final = """
With ROS, whose master answers at {master}:

  rostopic echo {robot}/joint_states
  rosrun tf tf_echo {model}/root_link {model}/head
  rosrun image_view image_view image:={robot}/cam/left
  rosservice call {robot}/set_model_configuration '' '' '[neck_yaw]' '[0.5]'

"""

QUICK: Final = 0.5  # seconds for a master to answer
SERVICE: Final = "gazebo_msgs/SetModelConfiguration"


class RosRobot(Closeable):
    """Shows `robot` to ROS while it is open; a context manager. `master` as in ROS_MASTER_URI.

    Raises AddressError if the robot has a name that ROS does not allow, NoNameServer.
    """

    def __init__(self, robot: Robot, master: str | None = None) -> None:
        with ExitStack() as resources:
            self.node = node = resources.enter_context(Node(robot.name, master=master))
            self._state = state = RobotState(robot, self._publish, lambda *time: [*time])
            resources.callback(state.close)
            for part, camera in robot.cameras.items():
                port = camera.images
                if "@" not in port.name:  # else it is a topic already, by its name
                    topic = ros_name(f"{robot.name}/{part}")
                    node.attach(port, topic, "sensor_msgs/Image", state.frame_of(part))
            if state.joints:
                node.service("~set_model_configuration", SERVICE, self._move)
            self._resources = resources.pop_all()

    def _publish(self, topic: str, type_: str) -> Published:
        made = self.node.publisher(topic, type_, queue_size=100)
        return Published(lambda: made.outputs, made.write)

    def _move(self, asked: Any) -> tuple[bool, str]:
        """Let joints move to positions; the answer does not wait until they are there."""
        problem = self._problem(asked.model_name, asked.joint_names, asked.joint_positions)
        if problem:
            return False, problem
        wanted = dict(zip(asked.joint_names, map(float, asked.joint_positions), strict=True))
        for board in self._state.boards:
            chosen = [joint for joint in self._state.joints if joint.board is board]
            chosen = [joint for joint in chosen if joint.name in wanted]
            if chosen:
                numbers = [joint.number for joint in chosen]
                board.switch_control_modes(numbers, [ControlMode.POSITION] * len(numbers))
                board.position_move(numbers, [wanted[each.name] / each.unit for each in chosen])
        return True, ""

    def _problem(self, model: str, names: Sequence[str], positions: Sequence[float]) -> str:
        """Return why it cannot be done; "" if it can."""
        known = [joint.name for joint in self._state.joints]
        if model not in ("", self._state.model):
            return f"there is no model {model!r} here, only {self._state.model}"
        if len(names) != len(positions):
            return f"{len(names)} names of joints with {len(positions)} positions"
        for name, position in zip(names, positions, strict=True):
            if name not in known:
                return f"there is no joint {name!r}, only {', '.join(known)}"
            if not isfinite(position):
                return f"{name} cannot move to {position}"
        return ""


class RosRobotPublisher:
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
