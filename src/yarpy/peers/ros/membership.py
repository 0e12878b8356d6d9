"""Membership: a port as a topic or a service of a node.

Rules: what is registered with the master is unregistered in the same words. A subscriber dials
every publisher that the master names, and again when a connection breaks, ever more rarely; a
publisher that the master takes from the list is left. A client dials its service when there is one.
Only threads made for that wait for a peer, and they are few: whoever can call the node can name any
number of publishers, and any host. One host is dialled a few times at a time, and ever more rarely
while nothing there answers.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from math import inf
from typing import Any, Final

from yarpy.contact import Contact
from yarpy.errors import AddressError, DecodeError, UnknownType, YarpError
from yarpy.link.begin import handshake
from yarpy.link.receive.inbound import Inbound
from yarpy.link.send.outbound import Outbound
from yarpy.log import logger
from yarpy.names.node_name import CLIENT, PUBLISHER, SERVER, SUBSCRIBER, NodeName
from yarpy.peers.ros.graph_name import ANY_TYPE, check_graph_name, master_type
from yarpy.peers.ros.master import RosMaster, Uri, call, parse_uri, uri_of
from yarpy.port.hub import Hub
from yarpy.route import Declared, Route
from yarpy.wire.message import Packet

log = logger("yarpy.ros")

GRAPH_NAME: Final = "ros"  # its name in the registry
DIALLING: Final = 10.0  # seconds for a publisher to say where its topic is
SOON: Final = 0.5  # seconds before a publisher that did not answer is dialled again
LONGEST: Final = 30.0
SLOWER: Final = 1.6
SEEKING: Final = 2.0  # seconds between questions for a service that is not there yet
PUBLISHERS: Final = 1000  # of a topic
DIALS: Final = 16  # publishers that are dialled at a time
OF_HOST: Final = 4  # ... of one host
LONG: Final = 1000  # characters of an address
QUEUE_SIZE: Final = 10  # messages that wait for a subscriber, where the publisher does not say


@dataclass(slots=True)
class _Publisher:
    """A publisher that we should be connected to, by the address of its node."""

    uri: str
    link: Inbound | None = None
    dialling: bool = False
    due: float = 0.0
    pause: float = SOON
    told: str = ""
    listed: bool = True  # by the master that there is now


@dataclass(slots=True)
class _Host:
    """A computer on which publishers are said to be: whoever can call the node can name one that
    has none, so each attempt in vain puts off all others there."""

    dials: int = 0  # under way
    due: float = 0.0
    pause: float = SOON

    def ended(self, reached: bool) -> None:
        """An attempt has ended."""
        self.dials -= 1
        if reached:
            self.due, self.pause = 0.0, SOON
        else:
            self.due = time.monotonic() + self.pause
            self.pause = min(self.pause * SLOWER, LONGEST)


@dataclass(slots=True)
class NodeAddress:
    """The address of a node: its name, the master, and its addresses."""

    node: str
    master: RosMaster
    uri: str  # of the node's port
    host: str


@dataclass(eq=False)
class Membership:
    """A role of a port in the graph. `kind` is the class of its messages, or a Service; None: the
    kind of its peers. `latched`: late subscribers get the last message. `queue_size`: so many
    messages wait for a subscriber that is behind; 0: the writer waits for it. `attached`: the port
    existed before the node, and outlives it. `frame`: that of headers which have none."""

    name: NodeName
    type: str = ""
    kind: Any = None
    latched: bool = False
    queue_size: int = QUEUE_SIZE
    attached: bool = False
    clock: Callable[[], float] = time.time
    frame: str = ""
    hub: Hub | None = None
    place: NodeAddress | None = None
    last: Packet | None = None  # of a latched publisher
    changed: Callable[[], object] = field(default=lambda: None)  # there may be something to do
    _publishers: dict[str, _Publisher] = field(default_factory=dict)
    _hosts: dict[str, _Host] = field(default_factory=dict)
    _dials: int = 0  # under way, also to publishers that were taken from the list since
    _lock: threading.Lock = field(default_factory=threading.Lock)
    _registered: tuple[str, ...] = ()
    _closed: bool = False
    _seek: float = 0.0  # when a client asks for its service again

    def __post_init__(self) -> None:
        self.topic = check_graph_name(self.name.topic)
        self.node = check_graph_name(self.name.node)

    @property
    def declared(self) -> Declared:
        """The facts about the port that its connections announce."""
        kind, clock = self.kind, self.clock
        return Declared(
            self.node, self.topic, self.type, kind, self.latched, clock, GRAPH_NAME, self.frame
        )

    @property
    def shown_type(self) -> str:
        """The type that the master is told."""
        return master_type(self.type)

    def is_like(self, other: Membership) -> bool:
        """Return whether both have the same role for the same topic."""
        return (self.topic, self.name.category) == (other.topic, other.name.category)

    def tell_apart(self, number: int) -> None:
        """Note that it is the `number`-th of several subscribers of the node to its topic: it calls
        itself differently, since a publisher of rospy keeps one connection to each name."""
        hub = self.hub
        assert hub is not None
        own = hub.registration
        own.declared = replace(own.declared, node=f"{self.node}_{number}")

    def learn(self, value: object) -> bool:
        """Take the type that a value naturally becomes for that of the topic, where nobody has said
        one; return whether there is such a type. A subscriber that wants another gets that."""
        if self.name.category != PUBLISHER or self.type or self.hub is None:
            return False
        from yarpy.peers.ros.message.convert.native import natural_type

        found = natural_type(value)
        if found is None:
            return False
        self.type = found
        own = self.hub.registration
        own.declared = replace(own.declared, type=found)
        return True

    # -- the master -------------------------------------------------------------------------------

    def register(self, place: NodeAddress, again: bool = False) -> None:
        """Tell the master. `again`: it was told before, or another one was. Raises NoNameServer,
        RemoteProtocolError, LocalProtocolError."""
        hub, category = self.hub, self.name.category
        assert hub is not None
        self.place = place
        if category == PUBLISHER:
            words = ("Publisher", self.topic, self.shown_type, place.uri)
        elif category == SUBSCRIBER:
            words = ("Subscriber", self.topic, self.shown_type, place.uri)
        elif category == SERVER:
            words = ("Service", self.topic, uri_of(place.host, hub.port, "rosrpc"), place.uri)
        else:
            self.look()
            return
        self._registered = words
        found = place.master.call(f"register{words[0]}", self.node, *words[1:])
        if category == SUBSCRIBER:
            self.update(found if isinstance(found, list) else [], again)

    def unregister(self) -> None:
        """Tell the master that it is over, in the same words. Raises as `register`."""
        self._closed = True
        words, place = self._registered, self.place
        if not words or place is None:
            return
        self._registered = ()
        uri = words[2] if words[0] == "Service" else words[3]
        place.master.call(f"unregister{words[0]}", self.node, words[1], uri, timeout=2.0)

    # -- a subscriber -----------------------------------------------------------------------------

    def update(self, uris: Sequence[object], again: bool = False) -> None:
        """The publishers are these now. `again`: the master may have forgotten some."""
        named = {uri: None for uri in uris if isinstance(uri, str) and len(uri) <= LONG}
        if len(named) > PUBLISHERS:
            log.warning(
                "%s: %s publishers are named; the first %s are dialled",
                *(self.topic, len(named), PUBLISHERS),
            )
        wanted = dict.fromkeys([*named][:PUBLISHERS])
        with self._lock:
            for publisher in self._publishers.values():
                if again:
                    publisher.listed = publisher.uri in wanted
            known = self._publishers.values()
            gone = [item for item in known if item.listed and item.uri not in wanted]
            for item in gone:
                del self._publishers[item.uri]
            left = {_host(uri) for uri in (*self._publishers, *wanted)}
            self._hosts = {
                name: host for name, host in self._hosts.items() if name in left or host.dials
            }
            for uri in wanted:
                self._publishers.setdefault(uri, _Publisher(uri)).listed = True
        for item in gone:
            if item.link is not None:
                item.link.close()
        self.look()

    def look(self) -> None:
        """Dial what should be connected and is not."""
        hub = self.hub
        if hub is None or hub.life.closing or self._closed:
            return
        if self.name.category == CLIENT:
            self._look_for_service(hub)
            return
        now = time.monotonic()
        with self._lock:
            for item in self._publishers.values():
                gone = item.link is not None and item.link not in hub.inputs.links
                if gone and not item.dialling:
                    # It may have said goodbye, of which the master tells in a moment.
                    item.link, item.due = None, max(item.due, now + SOON)
            due = [item for item in self._publishers.values() if self._is_due(hub, item, now)]
            due = self._chosen(sorted(due, key=lambda item: item.due), now)
            self._dials += len(due)
            for uri in [uri for uri, item in self._publishers.items() if self._is_over(hub, item)]:
                del self._publishers[uri]
        for item in due:
            threading.Thread(
                target=self._dial, args=(hub, item), name=f"yarpy dial {item.uri}", daemon=True
            ).start()

    def _chosen(self, due: list[_Publisher], now: float) -> list[_Publisher]:
        """Return the publishers that are dialled now, marked so."""
        found: list[_Publisher] = []
        for item in due:
            host = self._hosts.setdefault(_host(item.uri), _Host())
            if len(found) + self._dials >= DIALS:
                break
            if host.dials < OF_HOST and now >= host.due:
                host.dials += 1
                item.dialling = True
                found.append(item)
        return found

    def due(self) -> float:
        """Return the time to look again, as time.monotonic has it, if nothing happens before."""
        hub = self.hub
        if hub is None or hub.life.closing or self._closed:
            return inf
        if self.name.category == CLIENT:
            return inf if hub.outputs.links or self.place is None else self._seek
        with self._lock:
            if self._dials >= DIALS:
                return inf
            waiting = [item for item in self._publishers.values() if self._is_due(hub, item, inf)]
            pairs = [(item, self._hosts.get(_host(item.uri), _Host())) for item in waiting]
            # (the end of an attempt wakes those that wait for it)
            return min(
                (max(item.due, host.due) for item, host in pairs if host.dials < OF_HOST),
                default=inf,
            )

    def _is_due(self, hub: Hub, item: _Publisher, now: float) -> bool:
        alive = item.link is not None and item.link in hub.inputs.links
        return item.listed and not alive and not item.dialling and now >= item.due

    def _is_over(self, hub: Hub, item: _Publisher) -> bool:
        """Return whether a publisher is one of a former master, and has gone."""
        return not item.listed and not item.dialling and item.link not in hub.inputs.links

    def _dial(self, hub: Hub, item: _Publisher) -> None:
        reached = False
        try:
            item.link = self._connected(hub, item.uri)
            item.pause, item.told = SOON, ""
            reached = True
        except (YarpError, OSError) as error:
            if str(error) != item.told and not (hub.life.closing or self._closed):
                item.told = str(error)
                log.warning(
                    "%s: no connection to the publisher at %s: %s; it is tried again",
                    *(hub.name, item.uri, error),
                )
        finally:
            # Also one that was there for a moment only is not dialled again at once.
            item.due = time.monotonic() + item.pause
            item.pause = min(item.pause * SLOWER, LONGEST)
            item.dialling = False
        with self._lock:
            self._dials -= 1
            if (host := self._hosts.get(_host(item.uri))) is not None:
                host.ended(reached)
            unwanted = self._publishers.get(item.uri) is not item or self._closed
        if unwanted and item.link is not None:
            item.link.close()
        self.changed()

    def _connected(self, hub: Hub, uri: str) -> Inbound:
        """A connection from a publisher. Raises YarpError, OSError."""
        found = call(
            parse_uri(uri), "requestTopic", self.node, self.topic, [["TCPROS"]], timeout=DIALLING
        )
        where = _place(found)
        spec = f"tcpros+role.pub+topic.{self.topic}"
        route = Route(hub.name, uri, spec, where.port, declared=hub.registration.declared)
        contact = Contact("tcpros", "", where.host, where.port)
        driver, carrier = handshake.greet(contact, route, limit=hub.limit)
        fields: dict[str, str] = getattr(carrier, "fields", {})
        route.source, route.target = fields.get("callerid") or uri, hub.name
        link = Inbound(hub.inputs, driver, carrier)
        hub.inputs.take(link)
        threading.Thread(target=hub.inputs.serve, args=(link,), daemon=True).start()
        return link

    def uri_of(self, link: Inbound) -> str:
        """The address of the node that an input comes from; "" if the master did not name it."""
        with self._lock:
            found = (item.uri for item in self._publishers.values() if item.link is link)
            return next(found, "")

    # -- a client ---------------------------------------------------------------------------------

    def _look_for_service(self, hub: Hub) -> None:
        """Connect the client to its service, if there is one."""
        place, now = self.place, time.monotonic()
        if place is None or hub.outputs.links or now < self._seek:
            return
        self._seek = now + SEEKING
        where = place.master.service(self.topic)
        if where is None:
            return
        spec = f"rossrv+service.{self.topic}"
        route = Route(hub.name, self.topic, spec, where.port, declared=hub.registration.declared)
        contact = Contact("rossrv", self.topic, where.host, where.port)
        driver, carrier = handshake.greet(contact, route, limit=hub.limit)
        hub.outputs.add(Outbound(driver, carrier))

    # -- a latched publisher ----------------------------------------------------------------------

    def admit(self, link: Outbound) -> None:
        """A subscriber is about to come; nothing was written to it."""
        if self.name.category == PUBLISHER and self.queue_size:
            link.keep(self.queue_size)

    def welcome(self, link: Outbound) -> None:
        """A subscriber has come."""
        packet = self.last
        if packet is not None:
            try:
                link.send(packet)
            except (YarpError, ValueError, TypeError):
                pass  # it has gone, or the next message tells what is wrong


def _host(uri: str) -> str:
    """The host in an address, which may be none."""
    try:
        return parse_uri(uri).host
    except YarpError:
        return ""


def _place(found: object) -> Uri:
    """Return the address that a publisher gives for its topic. Raises AddressError."""
    if isinstance(found, list) and len(found) >= 3 and found[0] == "TCPROS":
        host, port = found[1], found[2]
        if isinstance(host, str) and host and isinstance(port, int) and 0 < port < 65536:
            return Uri(host, port)
    raise AddressError(f"the publisher offers no TCPROS connection, but {str(found)[:80]}")


def kind_of(type_: str, category: str) -> Any:
    """The class or Service of a type; None, with a warning, if nobody has its definition."""
    if type_ in ("", ANY_TYPE):
        return None
    from yarpy.peers.ros.message.library import default_library

    library, name = default_library(), master_type(type_)
    if name == ANY_TYPE:
        name = type_  # the error says what is wrong with it
    try:
        return library.service(name) if category in (CLIENT, SERVER) else library.message(name)
    except (UnknownType, DecodeError) as error:
        if "/" in type_ and not type_.startswith("yarp/"):
            log.warning("%s; the type is taken from who connects", error)
        return None
