"""ROS 2 over Zenoh: ports take part in its topics and services, without an installed ROS.

    port.connect("ros2://chatter")                 the port publishes what it writes
    port.listen_to("ros2://camera/image")          ... and reads what others publish

The other side are nodes whose RMW_IMPLEMENTATION is rmw_zenoh_cpp. What is here:

    name, key, token, qos, attachment    the texts and bytes of that RMW; pure
    load                                 a type of ROS 2 as a class

Rules: pure files import no session.
"""

from __future__ import annotations

from typing import Any


def load(name: str) -> Any:
    """The class of a message, `load("sensor_msgs/msg/JointState")`, or a service with the classes
    `Request` and `Response`. Raises UnknownType (nobody has it), DecodeError (its text is wrong).
    """
    from yarpy.idl.ros2msg.library import default_library

    return default_library().load(name)
