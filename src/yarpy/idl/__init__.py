"""Types of other systems: their languages are read, their values are Python objects.

    load        a type by its name or its file
    rosmsg      messages and services of ROS 1
    ros2msg     ... and of ROS 2
    thrift      structs, enums and services of Thrift, as YARP speaks it

Rules: pure, as `wire` and `data` are: definitions come from files and texts, bytes go in and out.
"""

from __future__ import annotations

import os
from typing import Any


def load(what: str | os.PathLike[str]) -> Any:
    """The type that `what` names: "sensor_msgs/JointState", a file "msgs/robot/msg/Arm.msg", or
    the module of a file "camera.thrift".

    A message is a class, a service (`.srv`) has two: `Request` and `Response`. Names are looked
    for in the packages of ROS_PACKAGE_PATH and of an installed ROS, then among those that the
    package rosbags brings. Raises UnknownType (nobody has it), DecodeError (a definition that is
    wrong), OSError (no such file).
    """
    if os.fspath(what).endswith(".thrift"):
        from yarpy.idl.thrift.library import load as load_thrift

        return load_thrift(what)
    from yarpy.idl.rosmsg.library import default_library

    return default_library().load(what)
