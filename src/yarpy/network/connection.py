"""The network as a whole: connect and disconnect any two ports, check for them, wait for them.

Rules: all requests go to the ports themselves, in the messages that C++ tools send; nothing
here needs a port of its own. `names` None is the default name service.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import Any

from yarpy.contact import Contact, check_name, is_broker, is_medium, parse_contact
from yarpy.data.bottle import Bottle
from yarpy.data.text import plain_text
from yarpy.data.value import Vocab
from yarpy.errors import (
    AddressError,
    LinkClosed,
    LocalProtocolError,
    NotAllowed,
    RemoteProtocolError,
    Timeout,
    UnknownName,
    UnknownPlugin,
)
from yarpy.link.handshake import find_carrier
from yarpy.names.base import NameClient
from yarpy.names.default import DEFAULT, secret
from yarpy.network.dialled import address_in, leads_to
from yarpy.port import identity, probe, refusal
from yarpy.port.choosing import offers_memory
from yarpy.port.connecting import agreed, refuse_medium, unknown
from yarpy.route import CarrierSpec, masked, parse_carrier

_CONFIRMING = 2.0  # seconds for a port to say its name
_POLL = 0.05  # seconds between looks while waiting


def query(name: str, names: NameClient | None = None) -> Contact | None:
    """Where the port `name` is, None if it is unknown. An address is returned as it is.

    Raises NoNameServer.
    """
    contact = parse_contact(name)
    if contact.placed:
        return contact
    return (names or DEFAULT.current()).query(contact.name)


def find(name: str, names: NameClient | None = None) -> Contact:
    """As `query`, but an unknown name raises UnknownName, which names the nearest known one."""
    return _find(Contact("", name), names)


def find_port(name: str, names: NameClient | None = None) -> Contact:
    """As `find`, of what can be asked: a topic of another middleware raises AddressError."""
    contact = find(name, names)
    if is_medium(contact.carrier):
        medium = contact.carrier.partition("+")[0]
        raise AddressError(
            f'"{name}" is no port but a topic of {medium}, which cannot be asked; '
            "`yarpy ping` of the port that is connected to it shows the connection"
        )
    return contact


def _find(end: Contact, names: NameClient | None) -> Contact:
    contact = query(end.name, names)
    if contact is None:
        raise unknown(end.name, names or DEFAULT.current(), end.carrier)
    return contact


def confirmed(
    name: str, names: NameClient | None = None, *, carrier: str = "tcp", timeout: float = 10.0
) -> Contact:
    """As `find`, once the listener there has been asked whether it is the port of that name, over
    `carrier`: what is sent next may move something. Raises also WrongPort, LinkClosed, Timeout.
    """
    contact = find(name, names)
    if is_medium(contact.carrier):
        return contact  # nobody listens there, and no name service knows it
    known = identity.properties_of(names or DEFAULT.current()) if contact.name else None
    identity.confirm(contact, known, secret(), timeout, parse_carrier(carrier).in_tls)
    return contact


def admin(
    name: str, *words: object, names: NameClient | None = None, timeout: float = 3.0
) -> Bottle:
    """The answer of the port `name` to an administrative message, e.g. `admin("/p", "ver")`.

    Words that are commands may be strings. Raises UnknownName, WrongPort, LinkClosed, Timeout.
    """
    try:
        contact = confirmed(name, names, timeout=timeout)
        return probe.ask(contact, list(words), timeout=timeout)
    except LinkClosed as error:
        raise LinkClosed(
            f'"{name}" is registered, but does not answer ({error}); if its program is gone, '
            "`yarpy clean` removes the name"
        ) from error


def called(port: str, peer: str, names: NameClient | None = None) -> str:
    """What `port` calls its connection with `peer`: another name than that where it was dialled by
    address. `peer` if it has none. Raises as `admin`."""
    host, contact = find(port, names).host, query(peer, names)
    if contact is None:
        return peer
    for side in ("out", "in"):
        listed = admin(port, "list", side, names=names)
        if peer in listed or (found := _dialled(listed, contact, host)):
            return peer if peer in listed else found
    return peer


def _dialled(listed: Bottle, contact: Contact, host: str) -> str:
    """The address of `contact` in what a port at `host` lists, "" if it is not there."""
    for peer in map(plain_text, listed):
        address = address_in(peer)
        if address is not None and leads_to(address, contact, host):
            return peer
    return ""


class Pairing:
    """Two ports whose connection is made, checked or ended from outside: over which carrier, which
    of them is asked, and in which words."""

    def __init__(
        self, source: str, target: str, carrier: str | None, names: NameClient | None
    ) -> None:
        self.source_text, self.target_text = source, target
        from_, to = _end(source, "source"), _end(target, "destination")
        self.topical = "topic" in (from_.carrier, to.carrier)
        self.source, self.target = from_, to
        if self.topical:
            self.spec = parse_carrier(carrier or "tcp")
            self.ask, self.peer, self.pull, self.open = "", "", False, False
            return
        here = from_ if from_.placed else _find(from_, names)
        there = to if to.placed else _find(to, names)
        constraint = ""
        for contact in (here, there):
            if not _competent(contact):
                constraint = contact.carrier
        given = carrier or _written(target) or _written(source)
        if not (is_medium(from_.carrier) or is_medium(to.carrier)):
            refuse_medium(given)
        self.spec = parse_carrier(given or constraint or "tcp")
        # Which carrier is then for the source to say.
        self.open = not (given or constraint or to.reachable)
        if given and constraint:
            self.spec = agreed(given, constraint)
        heard = is_broker(from_.carrier) or is_medium(from_.carrier)
        if heard and "sub" not in self.spec.tokens:
            self.spec = self.spec.plus("sub")
        self.pull = _pulls(self.spec)
        self.here, self.there = here, there
        asked = there if self.pull else here
        if not _competent(asked):
            raise LocalProtocolError(
                f'neither "{source}" nor "{target}" can be asked to make this connection: '
                f"a {asked.carrier} endpoint takes no YARP commands"
            )
        if self.spec.base == "http" and not probe.is_ours(asked):
            raise NotAllowed(refusal.NO_HTTP.format(asked.name or asked.address))
        if self.spec.base == "local":
            self._check_one_program(names or DEFAULT.current())
        self.asked = asked
        self.peer = (from_ if self.pull else to).label
        # Perhaps a camera, which does not understand us: ask its receiver first.
        self.plain = from_.reachable and not from_.name and not self.pull

    def _check_one_program(self, names: NameClient) -> None:
        """Refuse what crashes a receiver of C++ YARP in a program of its own."""
        here, there = (
            (end.host, *names.get(end.name, "process")) if end.name else ()
            for end in (self.here, self.there)
        )
        if len(here) > 1 and len(there) > 1 and here != there:
            raise NotAllowed(
                f'"{self.source_text}" and "{self.target_text}" belong to two programs, and local '
                "passes objects within one: use tcp, or unix_stream on one computer"
            )

    def admin(self, *words: object) -> Bottle:
        """Ask the port in charge. Raises LinkClosed if it does not answer."""
        try:
            return probe.ask(self.asked, list(words), timeout=10.0)
        except (LinkClosed, Timeout, RemoteProtocolError) as error:
            name = self.target_text if self.pull else self.source_text
            raise LinkClosed(f"Cannot connect to port {name}: {error}") from error

    def confirm(self, names: NameClient) -> None:
        """Make sure that the ports of these names listen where they are registered, before one of
        them sends to the other. Raises WrongPort if another port does."""
        for contact in (self.here, self.there):
            self._confirm(contact, names)

    def _confirm(self, contact: Contact, names: NameClient) -> None:
        try:
            identity.confirm(contact, names.get, secret(), _CONFIRMING)
        except (LinkClosed, Timeout):
            pass  # perhaps it can be reached from the other one, if not from here

    def existing(self) -> str:
        """The carrier of the connection that exists now, "" if there is none."""
        words = Vocab("list"), Vocab("in" if self.pull else "out"), self.peer
        listed = Bottle() if self.plain else self.admin(*words)
        if not listed:
            listed = self.ask_back(Vocab("list"), Vocab("in"))
            if listed.find("push") != 0:
                listed = self.admin(*words) if self.plain else Bottle()
        if not listed and (address := self.dialled()):
            listed = self.admin(*words[:2], address)
        return plain_text(listed.find("carrier", "")) if listed else ""

    def delete(self, names: NameClient) -> bool:
        """End the connection; False if neither end has it. Raises WrongPort."""
        self._confirm(self.asked, names)
        if self.plain and _done(self.ask_back(Vocab("del"))):
            return True
        if _done(self.admin(Vocab("del"), self.peer)):
            return True
        address = self.dialled()
        if address and _done(self.admin(Vocab("del"), address)):
            return True
        return not self.plain and _done(self.ask_back(Vocab("del")))

    def dialled(self) -> str:
        """The address by which the source calls the destination, if it has dialled that so; ""."""
        if self.pull or not (self.source.name and self.target.name):
            return ""
        return _dialled(self.admin(Vocab("list"), Vocab("out")), self.there, self.here.host)

    def ask_back(self, *words: object) -> Bottle:
        """Ask the destination about a connection that it may have dialled itself, as with pull
        carriers. An empty answer if it is the port in charge anyway, or cannot be asked."""
        if self.pull or not _competent(self.there):
            return Bottle()
        try:
            return probe.ask(self.there, [*words, self.source.label], timeout=10.0)
        except (LinkClosed, Timeout, RemoteProtocolError):
            return Bottle()


def _done(reply: Bottle) -> bool:
    return bool(reply) and reply[0] == 0


def _end(text: str, what: str) -> Contact:
    contact = parse_contact(text)
    if any(c.isspace() for c in text):
        raise AddressError(f'"{text}": a port name contains no blanks')
    if not contact.reachable:
        try:
            check_name(contact.name)
        except AddressError as error:
            raise AddressError(f"invalid {what} '{text}': {error}") from error
    return contact


def _written(text: str) -> str:
    contact = parse_contact(text)
    return (
        contact.carrier
        if ":/" in text and not contact.reachable
        else (contact.carrier if "://" in text else "")
    )


def _competent(contact: Contact) -> bool:
    """Whether a port accepts YARP commands; a camera's web server, registered by name, does not."""
    return parse_carrier(contact.carrier).base not in _FOREIGN


def _pulls(spec: CarrierSpec) -> bool:
    """Whether the receiver is the one that dials. For a carrier that is installed only at the ends,
    the name is all that is known here."""
    try:
        return not find_carrier(spec).push
    except UnknownPlugin:
        return spec.base in _PULLED


_PULLED = frozenset({"h264"})
_FOREIGN = frozenset(
    {"mjpeg", "h264", "tcpros", "rossrv", "xmlrpc", "http", "zmq", "mqtt", "ros2", "zenoh"}
)


def join(
    source: str,
    target: str,
    carrier: str | None = None,
    *,
    names: NameClient | None = None,
    timeout: float | None = None,
) -> tuple[str, str]:
    """Connect two ports; returns the carrier and the answer of the port that was asked. Raises
    like `remote.connect`.
    """
    deadline = None if timeout is None else time.monotonic() + timeout
    while True:
        try:
            return _join(source, target, carrier, names)
        except (UnknownName, LinkClosed):
            if deadline is None or time.monotonic() >= deadline:
                raise
        time.sleep(_POLL)


def _join(
    source: str, target: str, carrier: str | None, names: NameClient | None
) -> tuple[str, str]:
    pairing = Pairing(source, target, carrier, names)
    if pairing.topical:
        ask_server(names, ["subscribe", _decorated(source, ""), _decorated(target, carrier or "")])
        return carrier or "tcp", "connection to topic added."
    pairing.confirm(names or DEFAULT.current())
    active = pairing.source if pairing.pull else pairing.target
    address = f"/{active.address}{active.name}" if active.reachable else active.name
    over, spec = f"{pairing.spec.whole}:/", str(pairing.spec)
    chooses = pairing.open and offers_memory(pairing.here, names or DEFAULT.current())
    reply = pairing.admin(Vocab("add"), address if chooses else over + address)
    text = plain_text(reply[1]).strip() if len(reply) > 1 else ""
    if reply and reply[0] == 0:
        if chooses:  # its answer names what is not tcp
            before, to, told = text.rpartition(" to ")
            spec = parse_contact(told).carrier or spec
            text = text if told != address else before + to + over + told
        return spec, text
    way = f'"{masked(source)}" -> "{masked(target)}" over {pairing.spec}'
    error = refusal.error(text, way)
    if isinstance(error, LinkClosed):
        try:
            find_carrier(pairing.spec)
        except UnknownPlugin as unheard:  # so it may be a typing error
            raise UnknownPlugin(f"{error}; {unheard}") from error
    raise error


def _decorated(text: str, carrier: str) -> str:
    contact = parse_contact(text)
    return text if contact.carrier or not carrier else f"{carrier}:/{contact.name}"


def disconnect(source: str, target: str, *, names: NameClient | None = None) -> bool:
    """End the connection of two ports; False if there was none. Raises like `join`."""
    pairing = Pairing(source, target, None, names)
    if pairing.topical:
        ask_server(names, ["unsubscribe", source, target])
        return True
    return pairing.delete(names or DEFAULT.current())


def is_connected(
    source: str, target: str, carrier: str | None = None, *, names: NameClient | None = None
) -> bool:
    """Whether two ports are connected (over `carrier`, if given)."""
    try:
        found = Pairing(source, target, None, names).existing()
    except (UnknownName, LinkClosed):
        return False
    return bool(found) and (carrier is None or masked(carrier) == found)


def exists(name: str, target: str | None = None, *, names: NameClient | None = None) -> bool:
    """Whether the port `name` is known and answers; with `target`, whether they are connected."""
    if target is not None:
        return is_connected(name, target, names=names)
    try:
        return probe.answers(confirmed(name, names, timeout=probe.TIMEOUT))
    except (UnknownName, LinkClosed, Timeout):  # perhaps another port listens there
        return False


def ping(name: str, *, names: NameClient | None = None) -> list[str]:
    """What the port says about itself and its connections. Raises UnknownName, LinkClosed,
    AddressError for a topic of another middleware."""
    return probe.describe(find_port(name, names))


def wait_for(
    name: str,
    target: str | None = None,
    timeout: float | None = None,
    *,
    names: NameClient | None = None,
) -> bool:
    """Wait until the port `name` exists (with `target`: until the two are connected).

    False when `timeout` seconds were not enough.
    """
    deadline = None if timeout is None else time.monotonic() + timeout
    condition: Callable[[], bool] = lambda: exists(name, target, names=names)  # noqa: E731
    while not condition():
        if deadline is not None and time.monotonic() >= deadline:
            return False
        time.sleep(_POLL)
    return True


def ask_server(names: NameClient | None, command: Sequence[Any]) -> Bottle:
    """Ask the name server for something that only a server knows (topics, subscriptions).

    Raises LocalProtocolError if there is no server, or it refuses.
    """
    client = names or DEFAULT.current()
    client = getattr(client, "clients", [client])[0]
    request = getattr(client, "request", None)
    if request is None:
        raise LocalProtocolError(
            "topics and persistent connections need a name server of YARP, which remembers them: "
            + getattr(client, "instead", "`yarpy server` starts one")
        )
    reply: Bottle = request(list(command))
    if reply and plain_text(reply[0]) == "fail":
        raise LocalProtocolError(f"the name server refuses: {reply.to_text()}")
    return reply
