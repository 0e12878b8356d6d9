"""The nodes of this process: each has a port that answers as a node does, and its members.

Rules: a node begins with its first member, or with a `Node` of the program, and ends with the last.
A thread of its own tells the master what it does not know: at once, after it was restarted, or when
it comes at last. It sleeps until a connection ends, one is due to be dialled, or the master is to
be asked, more rarely as long as nothing changes. On exit everything is unregistered. Forked
children have no nodes.
"""

from __future__ import annotations

import atexit
import os
import threading
import time
from collections.abc import Callable
from typing import Any, Final, Protocol

from yarpy import fork
from yarpy.data.bottle import Bottle
from yarpy.errors import AddressError, NoNameServer, YarpError
from yarpy.log import logger
from yarpy.names.base import NameClient
from yarpy.names.node_name import CLIENT, PUBLISHER, SERVER
from yarpy.peers.ros.master import RosMaster, advertised_host, uri_of
from yarpy.peers.ros.membership import GRAPH_NAME, Membership, NodeAddress
from yarpy.peers.ros.node import slave
from yarpy.peers.ros.node.parameters import Followed
from yarpy.port.hub import Hub
from yarpy.port.mailbox import Callback, Mailbox
from yarpy.route import Declared

log = logger("yarpy.ros")

ASK: Final = 2.0  # seconds between questions to the master at first, and after any change
SLOWER: Final = 1.5
SLOWEST: Final = 6.0
SOON: Final = 0.5  # seconds, while it does not know some member
SHORTEST: Final = 0.02  # seconds between looks, whatever happens


class Opener(Protocol):
    """A function that opens the port of a node."""

    def __call__(
        self,
        name: str,
        mailbox: Mailbox,
        names: NameClient | None,
        /,
        *,
        register: bool,
        declared: Declared,
    ) -> Hub: ...


class GraphNode:
    """A node. `hub` is its port."""

    def __init__(self, name: str, master: RosMaster, names: NameClient | None, opener: Opener):
        self.name = name
        self.master = master
        self.members: tuple[Membership, ...] = ()
        self.users = 0  # members, and objects of the program
        self.host = advertised_host()
        self.process = os.getpid()
        self.on_shutdown: Callable[[], None] | None = None
        self._unknown: set[Membership] = set()  # to the master
        self._wake = threading.Event()
        self._ended = False
        self._told = ""
        self._lock = threading.RLock()  # members come and go
        self.hub = opener(
            name,
            Callback(lambda message: None),
            names,
            register=names is not None,
            declared=Declared(name, graph=GRAPH_NAME),
        )
        self.hub.callbacks.node = self._answer
        self.place = NodeAddress(name, master, uri_of(self.host, self.hub.port), self.host)
        self.parameters = Followed(name, master, self.place.uri)
        threading.Thread(target=self._run, name=f"yarpy node {name}", daemon=True).start()

    @property
    def master_uri(self) -> str:
        return self.master.uri

    def _answer(self, words: Bottle) -> Bottle | None:
        return slave.answer(self, words)

    def add(self, member: Membership) -> None:
        """Make a port a member, and tell the master, now if it answers.

        Raises AddressError for a second publisher or server of the same name: only one of them
        would be found.
        """
        with self._lock:
            same = [item for item in self.members if item.is_like(member)]
            if same and member.name.category in (PUBLISHER, SERVER):
                what = "serves" if member.name.is_service else "publishes"
                raise AddressError(f"{self.name} {what} {member.topic} already, by another port")
            if same:
                member.tell_apart(len(same) + 1)
            self.members = (*self.members, member)
        member.changed = self._wake.set
        try:
            member.register(self.place)
            self._wake.set()
            return
        except NoNameServer as error:
            if str(error) != self._told:  # once for all members
                self._told = str(error)
                log.warning("%s joins the graph once the master is there: %s", self.name, error)
        except YarpError as error:
            log.warning("%s: %s", self.name, error)
        self._unknown.add(member)
        self._wake.set()

    def tell(self, member: Membership) -> None:
        """Register a member once more, soon: it has changed."""
        self._unknown.add(member)
        self._wake.set()

    def remove(self, member: Membership) -> None:
        """The port closes."""
        with self._lock:
            self.members = tuple(item for item in self.members if item is not member)
        known = member not in self._unknown
        self._unknown.discard(member)
        try:
            member.unregister()
        except YarpError as error:
            if known:
                log.info("%s: %s stays registered: %s", self.name, member.topic, error)

    def shut_down(self, reason: str) -> None:
        """Close all ports of the node, in a thread of its own: whoever says so waits."""
        log.warning("%s is shut down: %s", self.name, reason or "no reason is given")

        def close() -> None:
            for member in self.members:
                hub = member.hub
                if hub is not None and not member.attached:
                    hub.close()
                elif hub is not None and hub.membership is not None:
                    hub.membership.leave()
            if self.on_shutdown is not None:
                self.on_shutdown()

        threading.Thread(target=close, name=f"yarpy shutdown {self.name}", daemon=True).start()

    def end(self) -> None:
        """No member is left."""
        self._ended = True
        self._wake.set()
        self.parameters.end()
        self.hub.close()

    # -- the thread -------------------------------------------------------------------------------

    def _run(self) -> None:
        pause = ASK
        ask = time.monotonic() + pause
        while not self._ended:
            due = min([ask, *(member.due() for member in self.members)])
            self._wake.wait(max(due - time.monotonic(), SHORTEST))
            self._wake.clear()
            if self._ended:
                return
            now = time.monotonic()
            try:
                if self._unknown:
                    ask = min(ask, now + SOON)
                if now >= ask:
                    pause = SOON if self._unknown else min(max(pause, ASK) * SLOWER, SLOWEST)
                    ask = now + pause
                    self._ask_master()
                for member in self.members:
                    member.look()
            except YarpError as error:
                self._tell(str(error))
                pause = ASK
                ask = min(ask, now + pause)
            except Exception:
                log.exception("the node %s met a defect", self.name)

    def _ask_master(self) -> None:
        """Register again what the master does not know. Raises NoNameServer and others."""
        if not (self.members or self.parameters):
            return
        found = self.master.node(self.name)
        known = found is not None and uri_of(found.host, found.port) == self.place.uri
        if (known and not self._unknown) or (found is not None and not known):
            self._tell("")  # if it is not ours, another node of that name has come
            return
        again = found is None
        members, problem = self.members, ""
        if again:
            self._unknown.update(members)  # whatever happens to the first of them
            self.parameters.forget()
        for member in members:
            if member not in self._unknown:
                continue
            try:
                member.register(self.place, again)
            except NoNameServer:
                raise
            except YarpError as error:  # the others are registered all the same
                problem = str(error)
                if member.name.category != CLIENT:  # the master is told nothing of those
                    continue
            self._unknown.discard(member)
        self._tell(problem)
        if again and not problem and any(member.name.category != "+1" for member in self.members):
            log.info("%s is registered with the master at %s", self.name, self.master.uri)

    def _tell(self, problem: str) -> None:
        """Log what is wrong with the master, once for as long as it is."""
        if problem != self._told:
            self._told = problem
            if problem:
                log.warning("%s: %s; what is connected goes on", self.name, problem)


class Graph:
    """The nodes of the process, by name and master."""

    def __init__(self) -> None:
        self._nodes: dict[tuple[str, str], GraphNode] = {}
        self._lock = fork.lock()
        self._registered = False

    def use(
        self, name: str, master: RosMaster, names: NameClient | None, opener: Opener
    ) -> GraphNode:
        """The node of that name, made if there is none. Raises AddressError, NoNameServer."""
        with self._lock:
            if not self._registered:
                self._registered = True
                atexit.register(self.close)
            key = name, master.uri
            node = self._nodes.get(key)
            if node is None or node.process != os.getpid():
                node = self._nodes[key] = GraphNode(name, master, names, opener)
            node.users += 1
            return node

    def leave(self, node: GraphNode) -> None:
        """Somebody needs the node no longer."""
        with self._lock:
            node.users -= 1
            if node.users > 0:
                return
            for key, item in [*self._nodes.items()]:
                if item is node:
                    del self._nodes[key]
        node.end()

    def close(self) -> None:
        """The process ends: unregister what was not closed."""
        for node in [*self._nodes.values()]:
            if node.process == os.getpid():
                for member in node.members:
                    node.remove(member)
                node.parameters.end()


GRAPH: Final = Graph()


class Joined:
    """A port's place in a node, until it leaves."""

    def __init__(self, member: Membership, node: GraphNode) -> None:
        self._member = member
        self._node = node
        self._left = False

    def admit(self, link: Any) -> None:
        """A subscriber is about to come."""
        self._member.admit(link)

    def welcome(self, link: Any) -> None:
        """A subscriber has dialled."""
        if self._member.latched:
            self._member.welcome(link)

    def lost(self) -> None:
        """A connection has ended, which may have to be dialled again."""
        self._member.changed()

    def unheard(self, value: object) -> None:
        """Nobody is connected. What the port writes says the type of its topic, if nobody has:
        without one the tools of ROS do not connect."""
        if not self._member.type and self._member.learn(value):
            self._node.tell(self._member)

    def leave(self) -> None:
        """The port closes."""
        if not self._left:
            self._left = True
            self._node.remove(self._member)
            GRAPH.leave(self._node)


def join(
    member: Membership,
    hub: Hub,
    master: RosMaster | None,
    names: NameClient | None,
    opener: Opener,
) -> None:
    """Make an open port a member of its node, if there is a master. Raises AddressError,
    NoNameServer."""
    member.hub = hub
    if master is None:
        return
    node = GRAPH.use(member.node, master, names, opener)
    # Now: a subscriber may be quicker than the answer of the master.
    hub.membership = Joined(member, node)
    try:
        node.add(member)
    except AddressError:
        hub.membership = None
        GRAPH.leave(node)
        raise
