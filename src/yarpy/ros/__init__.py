"""ROS 1: nodes with publishers, subscribers, services and parameters, without an installed ROS.

    with yarpy.ros.Node("/talker") as node:
        chatter = node.publisher("/chatter", "std_msgs/String")
        chatter.write("hello")

`node` is what programs use; `bag_reader` and `bag_writer` are for the files of rosbag. Ports whose
names are those of topics (`/chatter+@/talker`) belong to nodes as well; `membership` says how.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

_WHERE = {
    "BagReader": "yarpy.ros.bag_reader",
    "BagWriter": "yarpy.ros.bag_writer",
    "Node": "yarpy.ros.node",
    "Publisher": "yarpy.ros.node",
    "Subscriber": "yarpy.ros.node",
    "TypeServer": "yarpy.ros.type_server",
}

if TYPE_CHECKING:
    from yarpy.ros.bag_reader import BagReader as BagReader
    from yarpy.ros.bag_writer import BagWriter as BagWriter
    from yarpy.ros.node import Node as Node
    from yarpy.ros.node import Publisher as Publisher
    from yarpy.ros.node import Subscriber as Subscriber
    from yarpy.ros.type_server import TypeServer as TypeServer


def __getattr__(name: str) -> Any:
    if name not in _WHERE:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(_WHERE[name]), name)


def __dir__() -> list[str]:
    return sorted(_WHERE)
