"""Names and types as ROS spells them, of ports and of what the master is told.

Rules: pure. A colon, which ROS forbids in names, is `__` there.
"""

from __future__ import annotations

import re
from typing import Final

from yarpy.errors import AddressError

#: what is written where no type is known
ANY_TYPE: Final = "*"


def ros_name(name: str) -> str:
    """A name as ROS may spell it, where a colon is forbidden.

    >>> ros_name("/camera/rgb:o")
    '/camera/rgb__o'
    """
    return name.replace(":", "__")


def yarp_name(name: str) -> str:
    """A name that comes from ROS.

    >>> yarp_name("/camera/rgb__o")
    '/camera/rgb:o'
    """
    return name.replace("__", ":")


_TYPE: Final = re.compile(r"([A-Za-z]\w*+)/(?:(?:msg|srv)/)?([A-Za-z]\w*+)", re.ASCII)


def master_type(port_type: str) -> str:
    """The type that the master is told of: `*` for what it would not take.

    >>> master_type(""), master_type("yarp/image"), master_type("thing"), master_type("a/b/c")
    ('*', 'sensor_msgs/Image', 'yarp/thing', '*')
    >>> master_type("std_msgs/msg/String")
    'std_msgs/String'
    """
    if port_type == "yarp/image":
        return "sensor_msgs/Image"
    if port_type in ("", ANY_TYPE):
        return ANY_TYPE
    found = _TYPE.fullmatch(port_type if "/" in port_type else f"yarp/{port_type}")
    return f"{found[1]}/{found[2]}" if found else ANY_TYPE


def check_graph_name(name: str) -> str:
    """`name` as a name of ROS, if it can be one: letters, digits, `_` and slashes.

    Raises AddressError.

    >>> check_graph_name("/motor/state:o")
    '/motor/state__o'
    """
    found = ros_name(name)
    if not re.fullmatch(r"/[A-Za-z][A-Za-z0-9_]*+(?>(?:/[A-Za-z0-9_]++)*)", found):
        raise AddressError(
            f'ROS has no names like "{name[:80]}": those have letters, digits, "_" and "/" alone, '
            "begin with a letter, and do not end with a slash"
        )
    return found
