"""Ros2Robot: a simulated robot as a node of ROS 2, beside its ports of YARP.

    /icubSim/cam/left        sensor_msgs/msg/Image, each camera
    /icubSim/joint_states    sensor_msgs/msg/JointState, all joints of all parts
    /tf                      tf2_msgs/msg/TFMessage, where its parts and cameras are

Rules: those of `peers/ros/robot_state.py`. It speaks what RMW_IMPLEMENTATION
names, as every `Node`: DDS, or Zenoh. Nothing is drawn while nobody subscribes.
"""

from __future__ import annotations

import os
import threading
from contextlib import ExitStack
from typing import Final

from yarpy.data.sig.image import Image
from yarpy.data.stamp import Stamp
from yarpy.errors import YarpError
from yarpy.kits.devices.closeable import Closeable
from yarpy.kits.sim.robot import Robot
from yarpy.names.address import is_local
from yarpy.peers.ros.message.convert.native import to_message
from yarpy.peers.ros.robot_state import Published, RobotState
from yarpy.peers.ros2.dds.library import load
from yarpy.peers.ros2.key import domain
from yarpy.peers.ros2.name import node_of
from yarpy.peers.ros2.node.node import MIDDLEWARE, Node, is_dds
from yarpy.peers.ros2.qos import Qos
from yarpy.peers.ros2.rmw import Writer
from yarpy.peers.ros2.zenoh.participant import CONFIGURATION, take_part
from yarpy.peers.zenoh.place import parts, place

TRY: Final = """
With ROS 2, over {where} (RMW_IMPLEMENTATION={rmw}):

  ros2 topic echo {robot}/joint_states
  ros2 run tf2_ros tf2_echo {model}/root_link {model}/head
  ros2 run image_view image_view --ros-args -r image:={robot}/cam/left

"""

QUICK: Final = 1.0  # seconds for a router to answer
IMAGE: Final = "sensor_msgs/msg/Image"
QOS: Final = Qos(depth=100)  # as tf2 has it


class Ros2Robot(Closeable):
    """Shows `robot` to ROS 2 while it is open; a context manager. `rmw` as of a `Node`.

    Raises AddressError if the robot has a name that ROS 2 does not allow, UnknownPlugin, LinkClosed
    (no router).
    """

    def __init__(self, robot: Robot, rmw: str | None = None) -> None:
        with ExitStack() as resources:
            self.node = resources.enter_context(Node(robot.name, rmw=rmw))
            state = RobotState(robot, self._publish, _time)
            resources.callback(state.close)
            for part, camera in robot.cameras.items():
                topic = str(node_of(f"{robot.name}/{part}"))
                viewer = _Viewer(self.node.publisher(topic, IMAGE), state.frame_of(part))
                camera.viewers.append(viewer)
                resources.callback(camera.viewers.remove, viewer)
            self._resources = resources.pop_all()

    def _publish(self, topic: str, type_: str) -> Published:
        made = self.node.publisher(topic, type_.replace("/", "/msg/"), qos=QOS)
        return Published(lambda: made.subscribers, made.write)


class _Viewer:
    """Shows pictures of a camera, whose frame this is."""

    def __init__(self, writer: Writer, frame: str) -> None:
        self._writer, self._frame = writer, frame

    @property
    def outputs(self) -> int:
        return self._writer.subscribers

    def write(self, image: Image, stamp: Stamp) -> None:
        self._writer.write(to_message(image, self._writer.kind, stamp, self._frame))


def _time(seconds: int, nanoseconds: int) -> dict[str, int]:
    return {"sec": seconds, "nanosec": nanoseconds}


class Ros2RobotPublisher:
    """ROS 2 as a graph in which a simulated robot is shown, too."""

    title = "ROS 2"

    def find(self, everywhere: bool) -> str:
        """Return how nodes are reached, "" if none can be. DDS has no router to look for: it is
        taken where RMW_IMPLEMENTATION names it. `everywhere`: a router elsewhere, too."""
        found: list[str] = []

        def ask() -> None:
            try:
                if is_dds():
                    load()
                    found.append("DDS")
                elif everywhere or _is_here():
                    take_part(domain(None)).close()
                    found.append("Zenoh")
            except YarpError:
                pass  # there is none

        asking = threading.Thread(target=ask, name="yarpy ros2", daemon=True)
        asking.start()
        asking.join(QUICK)
        return found[0] if found else ""

    def show(self, robot: Robot, where: str = "") -> Ros2Robot:
        """Show the robot as a node. `where` is where all nodes of this program are."""
        return Ros2Robot(robot)

    def advice(self, robot: str, where: str) -> str:
        """Return what to try, for people."""
        rmw = os.environ.get(MIDDLEWARE) or "rmw_zenoh_cpp"
        return TRY.format(robot=robot, model=robot.strip("/"), where=where, rmw=rmw)


def _is_here() -> bool:
    """Return whether Zenoh goes to a router of this computer. Raises AddressError,
    LocalProtocolError."""
    routers = place(os.environ.get(CONFIGURATION, "")).routers
    return bool(routers) and all(is_local(parts(router)[1]) for router in routers)
