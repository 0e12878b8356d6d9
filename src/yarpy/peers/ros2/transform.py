"""The transforms of ROS 2: /tf and /tf_static, of a `Node`.

    transforms = yarpy.ros2.Transforms(node)
    found = transforms.lookup("map", "camera", timeout=5.0)

Rules: as in `peers/ros/transform/topic.py`.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, Final

from yarpy.peers.ros.transform.buffer import KEPT
from yarpy.peers.ros.transform.topic import FIXED, MOVING, Tree
from yarpy.peers.ros2.qos import TRANSIENT_LOCAL, Qos

if TYPE_CHECKING:
    from yarpy.peers.ros2.node.node import Node

TYPE: Final = "tf2_msgs/msg/TFMessage"
QOS: Final = {False: Qos(depth=100), True: Qos(durability=TRANSIENT_LOCAL, depth=100)}


class Transforms(Tree):
    """The transforms of the graph that a node belongs to; the topics close with it."""

    def __init__(self, node: Node, kept: float = KEPT) -> None:
        super().__init__(
            node.now, lambda topic, latch: node.publisher(topic, TYPE, qos=QOS[latch]), kept
        )
        for topic in (FIXED, MOVING):
            fixed = topic == FIXED
            node.subscriber(topic, TYPE, partial(self.hear, fixed=fixed), qos=QOS[fixed])

    def stamp(self, seconds: int, nanoseconds: int) -> object:
        return {"sec": seconds, "nanosec": nanoseconds}

    def time_of(self, stamp: Any) -> float:
        return float(stamp.sec) + float(stamp.nanosec) / 1e9
