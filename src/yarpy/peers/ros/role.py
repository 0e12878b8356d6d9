"""The role of a port whose name is that of a topic or service: which master, which name service.

Rules: the master is the one among the name services in use, else that of ROS_MASTER_URI, else the
one that a YARP server knows as `/ros` (`yarpserver --ros`). Without one the port is an ordinary
port with a long name. A YARP server is told of it too, if one answers.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any

from yarpy.errors import NoNameServer
from yarpy.names.base import NameClient
from yarpy.names.client import YarpNameClient
from yarpy.names.default import DEFAULT
from yarpy.names.fallback_client import SeveralNames
from yarpy.names.node_name import NodeName
from yarpy.peers.ros.graph import join
from yarpy.peers.ros.master import VARIABLE, RosMaster, uri_of
from yarpy.peers.ros.membership import Membership, kind_of
from yarpy.peers.ros.names import RosNames
from yarpy.peers.ros.type_server import ask_type_server
from yarpy.port.hub import Hub
from yarpy.route import Declared


class RosRole:
    """A port as a member of a node."""

    def __init__(
        self, member: Membership, master: RosMaster | None, names: NameClient | None
    ) -> None:
        self.member = member
        self.master = master
        self.names = names

    @property
    def port_name(self) -> str:
        """The complete name of the port."""
        return str(self.member.name)

    @property
    def declared(self) -> Declared:
        """The facts that its connections announce."""
        return self.member.declared

    def join(self, hub: Hub, opener: Callable[..., Any], /) -> None:
        """Make it a member. Raises AddressError, NoNameServer."""
        join(self.member, hub, self.master, without_masters(self.names), opener)


def role_of(name: NodeName, port_type: str, names: NameClient | None) -> RosRole:
    """The role of a port with this name. Raises AddressError, NoNameServer."""
    kind = name.type or port_type
    member = Membership(name, kind, kind_of(kind, name.category))
    found, master = services(names)
    return RosRole(member, master, found)


def services(names: NameClient | None) -> tuple[NameClient | None, RosMaster | None]:
    """The name service of a port and the master, `names` being what it was given. Raises
    NoNameServer if there is neither."""
    missing: NoNameServer | None = None
    given = names is not None
    if names is None:
        try:
            names = DEFAULT.current()
        except NoNameServer as error:
            missing = error
    master = next((item.master for item in _all(names) if isinstance(item, RosNames)), None)
    uri = os.environ.get(VARIABLE, "")
    if master is None and uri:
        master = RosMaster(uri)
    if master is None:
        master = _behind(names)
    if master is not None:
        ask_type_server(master)
    if missing is not None and master is None:
        raise NoNameServer(f"{missing}; for ROS, set {VARIABLE}") from missing
    if master is not None and not given:
        names = _of([item for item in _all(names) if _answers(item)])
    return names, master


def _behind(names: NameClient | None) -> RosMaster | None:
    """The master that a YARP server delegates to."""
    for item in _all(names):
        try:
            where = item.query("/ros") if isinstance(item, YarpNameClient) else None
        except NoNameServer:
            continue
        if where is not None and where.carrier == "xmlrpc":
            return RosMaster(uri_of(where.host, where.port))
    return None


def _answers(names: NameClient) -> bool:
    """Return whether a configured server answers; beside ROS, one that does not is left out."""
    return not isinstance(names, YarpNameClient) or names.alive()


def without_masters(names: NameClient | None) -> NameClient | None:
    """The name service of a node's own port, which registers with the master by itself."""
    return _of([item for item in _all(names) if not isinstance(item, RosNames)])


def _of(clients: list[NameClient]) -> NameClient | None:
    if len(clients) < 2:
        return clients[0] if clients else None
    return SeveralNames(clients)


def _all(names: NameClient | None) -> tuple[NameClient, ...]:
    if isinstance(names, SeveralNames):
        return names.clients
    return () if names is None else (names,)
