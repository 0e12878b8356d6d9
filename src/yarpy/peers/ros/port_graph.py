"""The graph of ROS 1 as ports see it: the roles of those that belong to a node, and what the others
answer when nodes call them.

Rules: quick to import, since any port may be asked for its process.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final

from yarpy.data.bottle import Bottle
from yarpy.data.xmlrpc import Last
from yarpy.names.base import NameClient
from yarpy.names.node_name import NodeName
from yarpy.shipped import GRAPHS

if TYPE_CHECKING:
    from yarpy.peers.ros.role import RosRole
    from yarpy.port.hub import Hub

# As C++ YARP.
ANSWERS: Final[dict[str, Callable[[Hub], list[Any]]]] = {
    "getPid": lambda hub: [1, "", os.getpid()],
    "getBusInfo": lambda hub: [1, "", Bottle([Bottle()])],
    "requestTopic": lambda hub: [
        1,
        hub.name.partition("@")[2] or hub.name,
        Bottle(["TCPROS", hub.contact.host, hub.port]),
    ],
    "publisherUpdate": lambda hub: [1, "ok"],
}


class RosGraph:
    """The contract is `port/graph.py`."""

    calls = GRAPHS["ros"].calls

    def role_of(self, name: NodeName, port_type: str, names: NameClient | None) -> RosRole:
        """Return what a port with this name will be there. Raises AddressError, NoNameServer."""
        from yarpy.peers.ros.role import role_of

        return role_of(name, port_type, names)

    def prepare(self) -> None:
        """Find the master, and with it the server of types. Raises NoNameServer."""
        from yarpy.peers.ros.role import services

        services(None)

    def answer(self, call: str, hub: Hub) -> Bottle:
        """Return what a port that belongs to no node answers."""
        return Last(ANSWERS[call](hub))
