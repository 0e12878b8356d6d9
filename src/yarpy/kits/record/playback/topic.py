"""The port that plays one name of a recording: a port of YARP, or a topic of a node.

    ""                       the port itself
    /player                  the topic of that name, of the node /player of ROS 1
    ros2://player            ... of the node /player of ROS 2, over Zenoh
    ros2+dds://player        ... over DDS; all that a target of that carrier says may stand there

Rules: nobody here knows ROS: what stands before `://` is a carrier, to which the port is connected.
A topic has the type that was recorded; where nobody here has its definition but the file, or it was
none of ROS, that of the first message.
"""

from __future__ import annotations

import re
from typing import Final

from yarpy.errors import LocalProtocolError, UnknownType
from yarpy.kits.record.recorded import PortFacts
from yarpy.names.base import NameClient
from yarpy.port.port import Port

_NODE: Final = re.compile(
    r"(?:(?>(/[A-Za-z]\w*+)+)|[a-z]\w*+(?>(\+[^/:]++)*)://[A-Za-z]\w*+(?>(/\w++)*))", re.A
)
_TYPE: Final = re.compile(r"(?!yarp/)(\w++)/(?:msg/)?(\w++)", re.ASCII)


def checked_node(text: str) -> str:
    """Return what a node is called by. Raises LocalProtocolError."""
    if not _NODE.fullmatch(text):
        raise LocalProtocolError(
            f'"{text}" is no name of a node: /player for ROS 1, ros2://player or ros2+dds://player'
        )
    return text


def open_topic(name: str, node: str, facts: PortFacts, names: NameClient | None) -> Port:
    """Return the open port that sends what was recorded under `facts.name` as `name`. Raises
    AddressError for a name that lives, or that cannot be one there; NoNameServer."""
    carrier, _, called = node.rpartition("://")
    if not carrier:
        return Port(f"{name}+@{node}" if node else name, callback=_ignore, names=names)
    port = Port("...", callback=_ignore, names=names)
    target = f"{carrier}+node.{called}://{name.lstrip('/')}"
    found = [_TYPE.fullmatch(kind) for kind in facts.kinds]
    try:
        try:
            if len(found) != 1 or found[0] is None:
                raise UnknownType(name)
            port.connect(f"{target}~{found[0][1]}/msg/{found[0][2]}")
        except UnknownType:
            port.connect(target)
    except BaseException:
        port.close()
        raise
    return port


def _ignore(message: object) -> None:
    """A port of a player is written to by mistake: nobody who does so waits."""
