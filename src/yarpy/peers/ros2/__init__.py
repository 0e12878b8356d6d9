"""ROS 2 over Zenoh: ports take part in its topics and services, without an installed ROS.

    port.connect("ros2://chatter")                 the port publishes what it writes
    port.listen_to("ros2://camera/image")          ... and reads what others publish

The other side are nodes whose RMW_IMPLEMENTATION is rmw_zenoh_cpp. What is here:

    name, key, token, qos, attachment    the texts and bytes of that RMW; pure
    load                                 a type of ROS 2 as a class
    Node                                 a node, with parameters and actions
    LifecycleNode                        one that others configure and activate
    Transforms                           where frames lie: /tf and /tf_static of a node

Rules: pure files import no session.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

__all__ = ["Node", "Transforms", "load"]


def load(name: str) -> Any:
    """The class of a message, `load("sensor_msgs/msg/JointState")`, a service with the classes
    `Request` and `Response`, or an action with `Goal`, `Result` and `Feedback`. Raises UnknownType
    (nobody has it), DecodeError (its text is wrong).
    """
    from yarpy.peers.ros2.message.library import default_library

    return default_library().load(name)


_WHERE = {
    "Event": "yarpy.peers.ros2.event",
    "Qos": "yarpy.peers.ros2.qos",
    "qos_profile": "yarpy.peers.ros2.qos",
    "LifecycleNode": "yarpy.peers.ros2.node.managed",
    "Node": "yarpy.peers.ros2.node.node",
    "Transforms": "yarpy.peers.ros2.transform",
}

if TYPE_CHECKING:
    from yarpy.peers.ros2.event import Event as Event
    from yarpy.peers.ros2.node.managed import LifecycleNode as LifecycleNode
    from yarpy.peers.ros2.node.node import Node as Node
    from yarpy.peers.ros2.qos import Qos as Qos
    from yarpy.peers.ros2.qos import qos_profile as qos_profile
    from yarpy.peers.ros2.transform import Transforms as Transforms
else:

    def __getattr__(name):  # type checkers do not see it: with it every name would be right
        if name not in _WHERE:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        from importlib import import_module

        return getattr(import_module(_WHERE[name]), name)
