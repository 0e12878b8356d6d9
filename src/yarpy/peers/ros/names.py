"""The ROS master as a name service.

    node      carrier xmlrpc, at its address
    service   carrier rossrv+service./name

Rules: only what ROS knows is found here. Ports with the names of nodes register as publishers and
subscribers themselves (`ros/graph.py`); an ordinary port is seen as a publisher of
/yarp/registration, as ports of C++ YARP are. There are no properties. Ports choose their numbers.
"""

from __future__ import annotations

import os
from typing import Final

from yarpy.contact import Contact
from yarpy.errors import AddressError
from yarpy.names.base import Contacts, Strings
from yarpy.names.node_name import parse_node_name
from yarpy.peers.ros.graph_name import ros_name, yarp_name
from yarpy.peers.ros.master import (
    DEFAULT_URI,
    VARIABLE,
    RosMaster,
    Uri,
    advertised_host,
    parse_uri,
    uri_of,
)

_KINDS: Final = {"xmlrpc": "node", "topic": "topic", "rossrv": "service"}
REGISTRATION: Final = "/yarp/registration"


class RosNames:
    """A `NameClient` that asks the master, which is found under `name` itself."""

    allocates = False
    title = "a ROS master"
    hint = f"start it with `roscore`, or correct {VARIABLE}"
    instead = "in a topic of ROS ports take part by their names (/TOPIC@/NODE)"

    def __init__(self, master: RosMaster, name: str = "/ros") -> None:
        self.master = master
        self.name = name

    def register(
        self,
        name: str,
        carrier: str | None = None,
        host: str | None = None,
        port: int | None = None,
        port_type: str | None = None,
    ) -> Contact:
        if not port:
            raise AddressError(f'a ROS master gives out no port numbers: give one for "{name}"')
        if name.startswith("..."):
            name = f"/tmp/port/{port}"
        contact = Contact(carrier or "tcp", name, host or advertised_host(), port)
        if _is_port(name) and contact.carrier == "tcp":
            graph = ros_name(name)
            self.master.call("registerPublisher", graph, REGISTRATION, "*", _own_uri(contact))
        return contact

    def unregister(self, name: str) -> None:
        if not _is_port(name):
            return
        where = self.master.node(ros_name(name))
        if where is not None:
            uri = _own_uri(Contact(host=where.host, port=where.port))
            self.master.call("unregisterPublisher", ros_name(name), REGISTRATION, uri)

    def query(self, name: str) -> Contact | None:
        """Return the address of a node, a port or a service, or of the master; a topic's name has
        none."""
        if not _is_port(name):
            return None  # without asking, so that such a port opens before its master comes
        found = self._node(name)
        if found is None:
            found = self._service(name)
        if found is None and name == self.name:
            where = parse_uri(self.master.uri)
            found = Contact("xmlrpc", name, where.host, where.port)
        return found

    def _node(self, name: str) -> Contact | None:
        where = self.master.node(ros_name(name))
        if where is None:
            return None
        if self._is_yarp_port(name, where):
            return Contact("tcp", name, where.host, where.port)
        return Contact("xmlrpc", name, where.host, where.port)

    def _is_yarp_port(self, name: str, where: Uri) -> bool:
        """Return whether the name is that of an ordinary port of YARP, which is registered as no
        node of ROS is."""
        publishers, _, _ = self.master.state()
        return any(topic == REGISTRATION and ros_name(name) in nodes for topic, nodes in publishers)

    def _service(self, name: str) -> Contact | None:
        where = self.master.service(ros_name(name))
        if where is None:
            return None
        return Contact(f"rossrv+service.{ros_name(name)}", name, where.host, where.port)

    def announce(self, name: str, ok: bool = True) -> None:
        """Nothing: a master is told when a port registers."""

    def set(self, name: str, key: str, *values: str | int | float) -> Strings:
        return []

    def get(self, name: str, key: str) -> Strings:
        return []

    def list(self, prefix: str | None = None) -> Contacts:
        """Nodes and services, without their addresses: a master tells those one by one; topics have
        the carrier `topic`."""
        publishers, subscribers, services = self.master.state()
        topics = {name for name, _ in (*publishers, *subscribers)}
        nodes = {node for _, names in (*publishers, *subscribers, *services) for node in names}
        found = [
            *(Contact("xmlrpc", yarp_name(node)) for node in sorted(nodes)),
            *(Contact("topic", yarp_name(topic)) for topic in sorted(topics - {REGISTRATION})),
            *(Contact("rossrv", yarp_name(name)) for name in sorted(name for name, _ in services)),
        ]
        if prefix is None:
            return found
        below = prefix.rstrip("/") + "/"
        return [item for item in found if item.name == prefix or item.name.startswith(below)]

    def place(self) -> str:
        """Return the address of the master."""
        return self.master.uri

    def address(self) -> tuple[str, int]:
        """Return the host and the number of the master."""
        where = parse_uri(self.master.uri)
        return where.host, where.port

    def alive(self) -> bool:
        """Return whether the master answers."""
        return self.master.answers()

    def line(self, contact: Contact) -> str:
        """Return the line of a node, a topic or a service, as C++ lists them."""
        return f'{_KINDS[contact.carrier]} "{contact.name}"'

    def close(self) -> None:
        """Nothing: each question has a connection of its own."""


def open_names(host: str, port: int, namespace: str) -> RosNames:
    """Return the names of the master at `host` and `port`, or of that in ROS_MASTER_URI."""
    uri = uri_of(host, port) if port else os.environ.get(VARIABLE, DEFAULT_URI)
    return RosNames(RosMaster(uri), namespace)


def _is_port(name: str) -> bool:
    """Return whether a name is that of an ordinary port, not of a topic of a node."""
    try:
        return parse_node_name(name) is None
    except AddressError:
        return False


def _own_uri(contact: Contact) -> str:
    """The address of a port, which calls of ROS reach as well."""
    return uri_of(contact.host, contact.port)
