"""ROS 1: nodes with publishers, subscribers, services and parameters, without an installed ROS.

    with yarpy.ros.Node("/talker") as node:
        chatter = node.publisher("/chatter", "std_msgs/String")
        chatter.write("hello")

`node` is what programs use; `bag/reader` and `bag/writer` are for the files of rosbag. Ports whose
names are those of topics (`/chatter+@/talker`) belong to nodes as well; `membership` says how.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

__all__ = [
    "ActionClient",
    "ActionServer",
    "BagReader",
    "BagWriter",
    "Duration",
    "Node",
    "Publisher",
    "Subscriber",
    "Time",
    "Transforms",
    "TypeServer",
]

_WHERE = {
    "ActionClient": "yarpy.peers.ros.action.client",
    "ActionServer": "yarpy.peers.ros.action.server",
    "BagReader": "yarpy.peers.ros.bag.reader",
    "BagWriter": "yarpy.peers.ros.bag.writer",
    "Duration": "yarpy.peers.ros.message.message",
    "Node": "yarpy.peers.ros.node.node",
    "Publisher": "yarpy.peers.ros.node.topic",
    "Subscriber": "yarpy.peers.ros.node.topic",
    "Time": "yarpy.peers.ros.message.message",
    "Transforms": "yarpy.peers.ros.transform.topic",
    "TypeServer": "yarpy.peers.ros.type_server",
}

if TYPE_CHECKING:
    from yarpy.peers.ros.action.client import ActionClient as ActionClient
    from yarpy.peers.ros.action.server import ActionServer as ActionServer
    from yarpy.peers.ros.bag.reader import BagReader as BagReader
    from yarpy.peers.ros.bag.writer import BagWriter as BagWriter
    from yarpy.peers.ros.message.message import Duration as Duration
    from yarpy.peers.ros.message.message import Time as Time
    from yarpy.peers.ros.node.node import Node as Node
    from yarpy.peers.ros.node.topic import Publisher as Publisher
    from yarpy.peers.ros.node.topic import Subscriber as Subscriber
    from yarpy.peers.ros.transform.topic import Transforms as Transforms
    from yarpy.peers.ros.type_server import TypeServer as TypeServer
else:

    def __getattr__(name):  # type checkers do not see it: with it every name would be right
        if name not in _WHERE:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        from importlib import import_module

        return getattr(import_module(_WHERE[name]), name)


def __dir__() -> list[str]:
    return sorted(__all__)
