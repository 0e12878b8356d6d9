"""A node of ROS 1 in a Python program: publishers, subscribers, services, parameters.

    with yarpy.ros.Node("/adder") as node:
        node.service("/add", "rospy_tutorials/AddTwoInts", lambda asked: [asked.a + asked.b])
        image = node.subscriber("/camera/image", "sensor_msgs/Image").take(timeout=5)
        rate = node.get_param("~rate", 10)

Rules: types are names, found as a program of ROS would find them, or classes made by
`yarpy.idl.load`. What is written may be an object of the type, a dict or list of its fields, or a
value of YARP (`Image`, `Vector`, str ...); what is read is an object of the type. Everything is
safe to call from any thread. Ports of the node are ports of YARP too. What roslaunch and rosrun say
on the command line of the program holds for all its nodes.
"""

from __future__ import annotations

import logging
import os
import sys
import time
from collections.abc import Callable, Sequence
from typing import Any, Self, TypeAlias, TypeVar

from yarpy.errors import (
    AddressError,
    LocalProtocolError,
    NoNameServer,
    YarpError,
)
from yarpy.names.base import NameClient
from yarpy.names.node_name import PUBLISHER, SERVER, SUBSCRIBER, Category, NodeName
from yarpy.peers.ros.graph import GRAPH, GraphNode, join
from yarpy.peers.ros.graph_name import master_type
from yarpy.peers.ros.master import DEFAULT_URI, VARIABLE, RosMaster
from yarpy.peers.ros.membership import QUEUE_SIZE, Membership
from yarpy.peers.ros.message.library import Service, default_library
from yarpy.peers.ros.message.message import Message as RosMessage
from yarpy.peers.ros.node.arguments import expand, parse_arguments
from yarpy.peers.ros.node.parameters import Followed, Parameters
from yarpy.peers.ros.node.rosout import Rosout
from yarpy.peers.ros.node.topic import Publisher, Subscriber, value_of
from yarpy.peers.ros.role import RosRole, services, without_masters
from yarpy.peers.ros.service.calls import Calls
from yarpy.peers.ros.type_server import ask_type_server
from yarpy.port.assembly import open_hub
from yarpy.port.base import BasePort
from yarpy.port.hub import Hub
from yarpy.port.mailbox import Callback, Fifo, Latest, Mailbox
from yarpy.port.rpc import RpcServer
from yarpy.route import Declared
from yarpy.wire.message import Message

P = TypeVar("P", bound=BasePort)

#: package/Type, or a class of messages
Type: TypeAlias = "str | type[RosMessage]"


class Node(Parameters):
    """A node. It is registered with the first of its topics and services.

    master: as ROS_MASTER_URI; without it the master of the environment or of `yarpy detect --ros`.
    names: a name client that learns of the ports too; None: the default one, if there is any.
    arguments: a command line with `__name:=x`, remappings and `_parameter:=value`, else that of
    this program. Raises AddressError for a name that ROS does not allow, or that another living
    node has at the name server; NoNameServer where the command line sets parameters, and there is
    no master.
    """

    def __init__(
        self,
        name: str,
        *,
        master: str | None = None,
        names: NameClient | None = None,
        arguments: Sequence[str] | None = None,
    ) -> None:
        self._said = parse_arguments(sys.argv if arguments is None else arguments)
        self.name = self._said.node(name)
        master = master or self._said.special.get("master")
        self._names = names
        if master is not None:
            self.master = RosMaster(master)
            ask_type_server(self.master)
        else:
            self._names, self.master = _found(names)
        self._ports: list[Any] = []
        self._attached: list[tuple[Hub, Declared]] = []  # with what they said of themselves before
        self._calls = Calls(self.name, self.master)
        plain = without_masters(self._names)
        self._node: GraphNode = GRAPH.use(self.name, self.master, plain, open_hub)
        self._closed = False
        self._rosout = Rosout()
        for key, value in self._said.parameters.items():
            self.set_param(f"~{key}", value)
        self._simulated: float | None = None  # seconds, where the time is simulated
        if self._is_simulated():
            self._simulated = 0.0
            self.subscriber("/clock", "rosgraph_msgs/Clock", self._set_time)

    # -- topics -----------------------------------------------------------------------------------

    def publisher(
        self, topic: str, type_: Type, *, latch: bool = False, queue_size: int = QUEUE_SIZE
    ) -> Publisher:
        """Publish a topic. `latch`: who subscribes late gets the last message. `queue_size`: so
        many messages wait for a subscriber that is behind; the oldest gives way, and `write` waits
        for nobody. 0: `write` waits for each.

        Raises AddressError, UnknownType, ValueError.
        """
        if queue_size < 0:
            raise ValueError(f"queue_size={queue_size}: it is 0 or more")
        kind = _message_class(type_)
        member = self._member(topic, PUBLISHER, kind._type, kind)
        member.latched, member.queue_size = latch, queue_size
        return self._keep(Publisher(self._open, member, kind))

    def attach(self, port: BasePort, topic: str, type_: Type, frame: str = "") -> None:
        """Publish what an open port of YARP writes as a topic too, until either is closed. `frame`:
        that of its pictures and points, for the header.

        Its messages become messages of the type (`docs/ros.md` says which do); what does not fit
        is not sent, and the log says why. Raises AddressError for a port that belongs to a topic
        already, UnknownType.
        """
        hub = port._hub
        if hub.membership is not None:
            raise AddressError(f"{port.name} is a topic or a service of a node already")
        kind = _message_class(type_)
        member = self._member(topic, PUBLISHER, kind._type, kind)
        member.attached, member.frame = True, frame
        before, hub.registration.declared = hub.registration.declared, member.declared
        try:
            join(member, hub, self.master, without_masters(self._names), open_hub)
        except YarpError:
            hub.registration.declared = before
            raise
        self._attached.append((hub, before))

    def subscriber(
        self,
        topic: str,
        type_: Type | None = None,
        callback: Callable[[Any], object] | None = None,
        *,
        newest: bool = False,
    ) -> Subscriber:
        """Subscribe to a topic. Without a type it takes whatever is published.

        `callback` gets each message, as an object of the type, in the thread of its connection;
        without one they are read, every one in its order, or with `newest` the newest alone.
        Raises AddressError, UnknownType.
        """
        kind = None if type_ is None else _message_class(type_)
        name = "" if kind is None else kind._type
        member = self._member(topic, SUBSCRIBER, name, kind)
        mailbox: Mailbox = Latest() if newest else Fifo()
        if callback is not None:
            call = callback

            def told(message: Message) -> None:
                call(value_of(message))

            mailbox = Callback(told)
        return self._keep(Subscriber(self._open, member, kind, mailbox))

    # -- services ---------------------------------------------------------------------------------

    def service(
        self, service: str, type_: str | Service, handler: Callable[[Any], object]
    ) -> RpcServer:
        """Serve a service: `handler(question)` gets an object of the request type and returns one
        of the response type, or a list or dict of its fields. What it raises is told to the client.

        Raises AddressError, UnknownType.
        """
        kind = _service(type_)
        member = self._member(service, SERVER, kind.name, kind)

        def answer(message: Message) -> object:
            found = handler(value_of(message))
            return kind.Response() if found is None else found

        plain = without_masters(self._names)
        role = RosRole(member, self.master, plain)
        return self._keep(RpcServer(str(member.name), answer, role=role))

    def call(
        self, service: str, type_: str | Service, *arguments: Any, timeout: float | None = 10.0
    ) -> Any:
        """Call a service; the answer is an object of the response type.

        `arguments` are an object of the request type, a dict of some of its fields, a list of all,
        or the fields. Raises UnknownName (nobody serves it), RemoteProtocolError (the server
        failed, and says why; or is of another type), Timeout, LinkClosed, NoNameServer. Calls of a
        service take turns.
        """
        kind = _service(type_)
        return self._calls.call(self.resolve(service), kind, kind.request(*arguments), timeout)

    def wait_for_service(self, service: str, timeout: float | None = None) -> bool:
        """Wait until somebody serves it; False if time is over. Raises NoNameServer."""
        return self._calls.wait(self.resolve(service), timeout)

    # -- time -------------------------------------------------------------------------------------

    def now(self) -> float:
        """The time in seconds: the system's; or, where /use_sim_time was set when the node began,
        the last one that /clock said, 0 before the first."""
        return time.time() if self._simulated is None else self._simulated

    def _is_simulated(self) -> bool:
        try:
            return self.get_param("/use_sim_time", False) is True
        except YarpError:
            return False  # the master is not there yet

    def _set_time(self, message: Any) -> None:
        self._simulated = message.clock.to_sec()

    @property
    def logger(self) -> logging.Logger:
        """The log of the node, which comes to /rosout; other nodes may set its level."""
        return self._rosout.of(self)

    # -- names, and the end -----------------------------------------------------------------------

    def resolve(self, name: str) -> str:
        """The full name of a topic, service or parameter: `~rate` is below the node's own name,
        `chatter` beside the node; or what the command line has in its place."""
        return self._said.remap(expand(name, self.name), self.name)

    @property
    def uri(self) -> str:
        """The address where the node answers."""
        return self._node.place.uri

    def close(self) -> None:
        """Close all ports of the node, and unregister. Idempotent."""
        if self._closed:
            return
        self._closed = True
        for port in self._ports:
            port.close()
        for hub, before in self._attached:
            membership, hub.membership = hub.membership, None
            hub.registration.declared = before
            if membership is not None:
                membership.leave()
        self._calls.close()
        GRAPH.leave(self._node)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *details: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<Node {self.name} at {self.uri}>"

    @property
    def _followed(self) -> Followed:
        return self._node.parameters

    def _member(self, name: str, category: Category, type_: str, kind: Any) -> Membership:
        if self._closed:
            raise LocalProtocolError(f"{self.name} is closed")
        topic = self.resolve(name)
        name_ = NodeName(self.name, topic, category)
        return Membership(name_, master_type(type_), kind, clock=self.now)

    def _open(self, member: Membership, mailbox: Mailbox) -> Any:
        role = RosRole(member, self.master, without_masters(self._names))
        return open_hub(str(member.name), mailbox, role=role)

    def _keep(self, port: P) -> P:
        self._ports.append(port)
        return port


def _found(names: NameClient | None) -> tuple[NameClient | None, RosMaster]:
    """The name service, and the master of the environment."""
    try:
        names, master = services(names)
    except NoNameServer:
        master = None
    return names, master or RosMaster(os.environ.get(VARIABLE) or DEFAULT_URI)


def _message_class(type_: Type) -> type[RosMessage]:
    return default_library().message(type_) if isinstance(type_, str) else type_


def _service(type_: str | Service) -> Service:
    return default_library().service(type_) if isinstance(type_, str) else type_
