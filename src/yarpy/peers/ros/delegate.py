"""Beside a ROS master: `yarpy server --ros` tells it of topics and services, and asks it for names.

Rules: ports of C++ YARP with the names of topics (`/msg-@/node`) leave it to the server to call the
master, once both they and the port of their node are announced; ports of yarpy call it themselves,
and say so (`OWN`). What is registered is unregistered in the same words, and told again to a master
that was restarted. All calls are made by one thread, so that no command waits for the master; but a
question for a name that nobody here has is asked there.
"""

from __future__ import annotations

import os
import threading
import time
from dataclasses import dataclass
from queue import Empty, SimpleQueue
from typing import Final

from yarpy.contact import Contact
from yarpy.data.bottle import Bottle
from yarpy.errors import AddressError, NoNameServer, YarpError
from yarpy.log import logger
from yarpy.names.address import is_local
from yarpy.names.default import secret
from yarpy.names.node_name import PUBLISHER, SERVER, SUBSCRIBER, NodeName, parse_node_name
from yarpy.nameserver.command import NameService
from yarpy.nameserver.delegate import DelegateContext
from yarpy.peers.ros.graph_name import check_graph_name, master_type
from yarpy.peers.ros.master import (
    DEFAULT_URI,
    VARIABLE,
    RosMaster,
    advertised_host,
    parse_uri,
    uri_of,
)
from yarpy.peers.ros.names import RosNames
from yarpy.port.connect import probe

log = logger("yarpy.name_server")

NAME: Final = "/ros"  # under which the master is found
CALLER: Final = "/yarp/RosNameSpace"
OWN: Final = ("ros", "own")  # the property of ports that call the master themselves
TIMEOUT: Final = 1.0  # seconds for an answer of the master
REST: Final = 2.0  # seconds for which a master that is away is asked for no names
LOOK: Final = 5.0  # seconds between looks whether the master still knows
_VERBS: Final = {PUBLISHER: "Publisher", SUBSCRIBER: "Subscriber", SERVER: "Service"}


@dataclass(frozen=True, slots=True)
class _Told:
    """A registration of a port at the master."""

    name: NodeName
    verb: str
    topic: str
    type: str
    uri: str  # that of the port itself for a service, else that of the node
    node_uri: str


class RosDelegate:
    """Calls `master` for the ports that `service` knows."""

    def __init__(self, master: RosMaster, service: NameService) -> None:
        self.master = master
        self.about = f"ROS with {VARIABLE}={master.uri}"
        self._names = RosNames(RosMaster(master.uri, TIMEOUT))
        self._service = service
        self._present: set[str] = set()  # ports that were announced
        self._members: dict[str, set[str]] = {}  # of them, those of each node
        self._told: dict[str, _Told] = {}
        self._away = 0.0  # until when no names are asked for
        self._work: SimpleQueue[tuple[str, str] | None] = SimpleQueue()
        self._name_master()
        self._thread = threading.Thread(target=self._run, name="yarpy server ros", daemon=True)
        self._thread.start()

    def registered(self, name: str) -> None:
        """Do nothing: a port is told of when it is announced."""

    def announced(self, name: str) -> None:
        """A port is there."""
        self._work.put(("announced", name))

    def unregistered(self, name: str) -> None:
        """A port has closed, or another one has its name."""
        self._work.put(("gone", name))

    def query(self, name: str) -> Contact | None:
        """Return the address of the node or service of that name; None if the master knows none, or
        is away."""
        if not name.startswith("/") or time.monotonic() < self._away:
            return None
        try:
            parsed = parse_node_name(name)
            return self._names.query(name if parsed is None else parsed.topic)
        except NoNameServer as error:
            self._away = time.monotonic() + REST
            log.warning("%s", error)
        except YarpError as error:
            log.info("%s: %s", name, error)
        return None

    def close(self) -> None:
        """Unregister what was registered, and end."""
        self._work.put(None)
        self._thread.join(2 * TIMEOUT)

    def _name_master(self) -> None:
        """Let it be found under its name, also after somebody cleaned up while it was away."""
        if self._find(NAME) is None:
            where = parse_uri(self.master.uri)
            self._service.answer(Bottle(["register", NAME, "xmlrpc", where.host, where.port]))

    # -- the thread -------------------------------------------------------------------------------

    def _run(self) -> None:
        due = time.monotonic() + LOOK
        while True:
            try:
                item = self._work.get(timeout=max(due - time.monotonic(), 0.0))
            except Empty:
                due = time.monotonic() + LOOK
                self._look()
                continue
            if item is None:
                break
            what, name = item
            if what == "announced":
                self._announce(name)
            else:
                self._forget(name)
        for name in [*self._told]:
            self._forget(name)

    def _announce(self, name: str) -> None:
        if self._find(name) is None:
            return
        self._present.add(name)
        member = _member(name)
        if member is not None:
            self._members.setdefault(member.node, set()).add(name)
            self._register(name, member)
        for each in sorted(self._members.get(name, ())):
            found = _member(each)
            assert found is not None
            self._register(each, found)

    def _find(self, name: str) -> Contact | None:
        with self._service.lock:
            return self._service.store.query(name)

    def _values(self, name: str, key: str) -> list[str]:
        with self._service.lock:
            return self._service.store.values(name, key) or []

    def _register(self, name: str, member: NodeName) -> None:
        """Tell the master of a port, if the port of its node is there too."""
        verb = _VERBS.get(member.category)
        port, node = self._find(name), self._find(member.node)
        if verb is None or port is None or node is None or name in self._told:
            return
        if member.node not in self._present or self._is_own(name) or self._is_own(member.node):
            return
        try:
            topic, owner = check_graph_name(member.topic), check_graph_name(member.node)
        except AddressError as error:
            log.warning("%s", error)
            return
        node_uri = uri_of(_reachable(node.host), node.port)
        uri = uri_of(_reachable(port.host), port.port, "rosrpc") if verb == "Service" else node_uri
        member = NodeName(owner, topic, member.category)
        type_ = master_type("".join(self._values(name, "type")[:1]))
        self._told[name] = _Told(member, verb, topic, type_, uri, node_uri)
        self._tell(name)

    def _is_own(self, name: str) -> bool:
        return OWN[1] in self._values(name, OWN[0])

    def _tell(self, name: str) -> None:
        told = self._told[name]
        words = (told.uri, told.node_uri) if told.verb == "Service" else (told.type, told.node_uri)
        try:
            found = self.master.call(
                f"register{told.verb}", told.name.node, told.topic, *words, timeout=TIMEOUT
            )
        except YarpError as error:
            log.warning("%s is not known to ROS: %s; it is told again", name, error)
            return
        port = self._find(name)
        if told.verb == "Subscriber" and found and isinstance(found, list) and port is not None:
            question = ["publisherUpdate", CALLER, told.topic, found]
            try:
                probe.ask(port, question, timeout=TIMEOUT, secret_=secret())
            except (YarpError, OSError) as error:
                log.warning("%s is not told of its publishers: %s", name, error)

    def _forget(self, name: str) -> None:
        self._present.discard(name)
        member = _member(name)
        if member is not None:
            mates = self._members.get(member.node, set())
            mates.discard(name)
            if not mates:
                self._members.pop(member.node, None)
        for each, told in [*self._told.items()]:
            if name in (each, told.name.node):
                del self._told[each]
                try:
                    self.master.call(
                        f"unregister{told.verb}",
                        *(told.name.node, told.topic, told.uri),
                        timeout=TIMEOUT,
                    )
                except YarpError as error:
                    log.info("%s stays registered with ROS: %s", each, error)

    def _look(self) -> None:
        """Tell a master that was restarted what it does not know."""
        self._name_master()
        lost: dict[str, bool] = {}
        for name, told in [*self._told.items()]:
            node = told.name.node
            try:
                if node not in lost:
                    lost[node] = self.master.node(node) is None
            except YarpError:
                return  # it is away
            if lost[node]:
                self._tell(name)


def open_delegate(place: str, context: DelegateContext) -> RosDelegate:
    """Tell and ask the master at `place`, or that of ROS_MASTER_URI. Raises AddressError if the
    environment names none."""
    uri = place or os.environ.get(VARIABLE, "")
    if not uri:
        raise AddressError(f"--ros needs {VARIABLE}: export {VARIABLE}={DEFAULT_URI}")
    if not RosMaster(uri, TIMEOUT).answers():
        log.warning("no ROS master answers at %s yet; it is asked again for every name", uri)
    return RosDelegate(RosMaster(uri), context.service)


def _member(name: str) -> NodeName | None:
    """Return the node name that a port's name spells; None for an ordinary port."""
    try:
        found = parse_node_name(name)
    except AddressError:
        return None
    return found if found is not None and found.node else None


def _reachable(host: str) -> str:
    """A host as nodes elsewhere reach it."""
    return advertised_host() if is_local(host) else host
