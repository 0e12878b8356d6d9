"""The network as a whole: connect and disconnect any two ports, check for them, wait for them.

Rules: all requests go to the ports themselves, in the messages that C++ tools send; nothing
here needs a port of its own. `names` None is the default name service.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from math import inf
from typing import Any, Self

from yarpy import registry, scope
from yarpy.contact import Contact, check_name, parse_contact
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
from yarpy.link.begin.handshake import find_carrier
from yarpy.names.base import NameClient
from yarpy.names.default import DEFAULT, secret
from yarpy.network.dialled import address_in, leads_to
from yarpy.port.connect import identity, probe, refusal
from yarpy.port.connect.choosing import offers_memory
from yarpy.port.connect.connecting import agreed, refuse_medium, unknown
from yarpy.route import CarrierSpec, masked, parse_carrier
from yarpy.scope import ASKING, CONNECTING, Scope, apart, moment

_CONFIRMING = 2.0  # seconds for a port to say its name
_POLL = 0.05  # seconds between looks while waiting


@apart
def query(
    name: str, names: NameClient | None = None, *, timeout: float | None = None
) -> Contact | None:
    """Where the port `name` is, None if it is unknown. An address is returned as it is.

    Raises NoNameServer, also for one that has not answered within `timeout` seconds, else 3.
    """
    contact = parse_contact(name)
    if contact.placed:
        return contact
    with Scope(moment(ASKING if timeout is None else timeout)):
        return (names or DEFAULT.current()).query(contact.name)


def find(name: str, names: NameClient | None = None) -> Contact:
    """As `query`, but an unknown name raises UnknownName, which names the nearest known one."""
    return _find(Contact("", name), names)


def find_port(name: str, names: NameClient | None = None) -> Contact:
    """As `find`, of what can be asked: a topic of another middleware raises AddressError."""
    contact = find(name, names)
    if contact.reaches.topic:
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


@apart
def confirmed(
    name: str, names: NameClient | None = None, *, carrier: str = "tcp", timeout: float = ASKING
) -> Contact:
    """As `find`, once the listener there has been asked whether it is the port of that name, over
    `carrier`: what is sent next may move something. Raises also WrongPort, LinkClosed, Timeout.
    """
    with Scope(moment(timeout)):
        contact = find(name, names)
        if contact.reaches.topic:
            return contact  # nobody listens there, and no name service knows it
        known = identity.properties_of(names or DEFAULT.current()) if contact.name else None
        identity.confirm(contact, known, secret(), timeout, parse_carrier(carrier).in_tls)
        return contact


@apart
def admin(
    name: str, *words: object, names: NameClient | None = None, timeout: float | None = None
) -> Bottle:
    """The answer of the port `name` to an administrative message, e.g. `admin("/p", "ver")`, within
    `timeout` seconds, else 3.

    Words that are commands may be strings. Raises UnknownName, WrongPort, LinkClosed, Timeout,
    NoNameServer.
    """
    seconds = ASKING if timeout is None else timeout
    try:
        with Scope(moment(seconds)):
            contact = confirmed(name, names, timeout=seconds)
            return probe.ask(contact, list(words), timeout=seconds)
    except LinkClosed as error:
        raise LinkClosed(
            f'"{name}" is registered, but does not answer ({error}); if its program is gone, '
            "`yarpy clean` removes the name"
        ) from error


def called(port: str, peer: str, names: NameClient | None = None) -> str:
    """Return the name that `port` gives its connection with `peer`: another than `peer` where that
    was dialled by address. `peer` if it has none. Raises as `admin`."""
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

    def __init__(self, source: str, target: str, carrier: str, names: NameClient | None) -> None:
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
        if not (from_.reaches.topic or to.reaches.topic):
            refuse_medium(given)
        self.spec = parse_carrier(given or constraint or "tcp")
        # Which carrier is then for the source to say.
        self.open = not (given or constraint or to.reachable)
        if given and constraint:
            self.spec = agreed(given, constraint)
        heard = from_.reaches.broker or from_.reaches.topic
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
        facts = registry.carriers.facts(self.spec.base)
        if facts.reaches.cpp and not probe.is_ours(asked):
            raise NotAllowed(refusal.useless(asked, facts.reaches.cpp))
        if facts.reaches.same_program:
            self._check_one_program(names or DEFAULT.current())
        self.asked = asked
        self._visit: probe.Visit | None = None  # for all questions to that port
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
            return self._visited().ask(words)
        except (LinkClosed, Timeout, RemoteProtocolError) as error:
            self.close()
            name = self.target_text if self.pull else self.source_text
            raise LinkClosed(f"Cannot connect to port {name}: {error}") from error

    def confirm(self, names: NameClient) -> None:
        """Make sure that the ports of these names listen where they are registered, before one of
        them sends to the other. Raises WrongPort if another port does."""
        for contact in (self.here, self.there):
            self._confirm(contact, names)

    def _confirm(self, contact: Contact, names: NameClient) -> None:
        try:
            if contact is not self.asked:
                identity.confirm(contact, names.get, secret(), _CONFIRMING)
            elif contact.name and contact.carrier in ("", "tcp"):
                identity.judge(contact, self._visited().name(), names.get)
        except (LinkClosed, Timeout, RemoteProtocolError):
            pass  # perhaps it can be reached from the other one, if not from here

    def _visited(self) -> probe.Visit:
        if self._visit is None:
            self._visit = probe.Visit(self.asked, CONNECTING)
        return self._visit

    def close(self) -> None:
        """Hang up, if somebody was asked."""
        visit = getattr(self, "_visit", None)
        if visit is not None:
            self._visit = None
            visit.close()

    def __del__(self) -> None:
        self.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *details: object) -> None:
        self.close()

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
            return probe.ask(self.there, [*words, self.source.label])
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
    """Return whether a port accepts YARP commands; a camera's web server, registered by name, does
    not."""
    return not contact.reaches.foreign


def _pulls(spec: CarrierSpec) -> bool:
    """Return whether the receiver dials. For a carrier that is installed only at the ends, the name
    is all that is known here."""
    try:
        return not find_carrier(spec).push
    except UnknownPlugin:
        return not registry.carriers.facts(spec.base).push


@apart
def join(
    source: str,
    target: str,
    carrier: str = "",
    *,
    names: NameClient | None = None,
    timeout: float | None = None,
) -> tuple[str, str]:
    """Connect two ports; returns the carrier and the answer of the port that was asked. Raises
    like `remote.connect`.
    """
    with Scope(moment(CONNECTING if timeout is None else timeout)) as call:
        first: UnknownName | None = None  # which tells whose name is near; later time may be over
        while True:
            try:
                return _join(source, target, carrier, names)
            except (UnknownName, LinkClosed) as error:
                if isinstance(error, UnknownName):
                    first = first or error
                assert call.until is not None
                if timeout is None or time.monotonic() + _POLL >= call.until:
                    if isinstance(error, UnknownName):
                        raise first or error from None
                    raise
            scope.sleep(_POLL)


def _join(source: str, target: str, carrier: str, names: NameClient | None) -> tuple[str, str]:
    from_ = parse_contact(source)
    offers = False
    if not (carrier or from_.placed or _written(source) or _written(target)):
        # First of all: where a name is can then be asked over the same connection.
        offers = offers_memory(from_, names or DEFAULT.current())
    with Pairing(source, target, carrier, names) as pairing:
        return _joined(pairing, source, target, carrier, names, offers)


def _joined(
    pairing: Pairing,
    source: str,
    target: str,
    carrier: str,
    names: NameClient | None,
    offers: bool,
) -> tuple[str, str]:
    if pairing.topical:
        ask_server(names, ["subscribe", _decorated(source, ""), _decorated(target, carrier or "")])
        return carrier or "tcp", "connection to topic added."
    pairing.confirm(names or DEFAULT.current())
    active = pairing.source if pairing.pull else pairing.target
    address = f"/{active.address}{active.name}" if active.reachable else active.name
    over, spec = f"{pairing.spec.whole}:/", str(pairing.spec)
    chooses = pairing.open and offers
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
            said = str(unheard) in str(error)  # by a port of ours
            raise UnknownPlugin(str(error) if said else f"{error}; {unheard}") from None
    raise error


def _decorated(text: str, carrier: str) -> str:
    contact = parse_contact(text)
    return text if contact.carrier or not carrier else f"{carrier}:/{contact.name}"


@apart
def disconnect(
    source: str, target: str, *, names: NameClient | None = None, timeout: float | None = None
) -> bool:
    """End the connection of two ports, within `timeout` seconds, else 5; False if there was none.
    Raises like `join`."""
    with (
        Scope(moment(CONNECTING if timeout is None else timeout)),
        Pairing(source, target, "", names) as pairing,
    ):
        if pairing.topical:
            ask_server(names, ["unsubscribe", source, target])
            return True
        return pairing.delete(names or DEFAULT.current())


@apart
def is_connected(
    source: str,
    target: str,
    carrier: str = "",
    *,
    names: NameClient | None = None,
    timeout: float | None = None,
) -> bool:
    """Return whether two ports are connected (over `carrier`, if given). False also if the ports do
    not answer within `timeout` seconds, else 3. Raises NoNameServer."""
    with Scope(moment(ASKING if timeout is None else timeout)):
        return _is_connected(source, target, carrier, names)


def _is_connected(source: str, target: str, carrier: str, names: NameClient | None) -> bool:
    try:
        with Pairing(source, target, "", names) as pairing:
            found = pairing.existing()
    except (UnknownName, LinkClosed, Timeout):
        return False
    return bool(found) and (not carrier or masked(carrier) == found)


@apart
def exists(
    name: str,
    target: str | None = None,
    *,
    names: NameClient | None = None,
    timeout: float | None = None,
) -> bool:
    """Return whether the port `name` is known and answers within `timeout` seconds, else 3; with
    `target`, whether they are connected. Raises NoNameServer."""
    with Scope(moment(ASKING if timeout is None else timeout)):
        return _exists(name, target, names)


def _exists(name: str, target: str | None, names: NameClient | None) -> bool:
    if target is not None:
        return _is_connected(name, target, "", names)
    try:
        return probe.answers(confirmed(name, names))
    except (UnknownName, LinkClosed, Timeout):  # perhaps another port listens there
        return False


@apart
def ping(name: str, *, names: NameClient | None = None, timeout: float | None = None) -> list[str]:
    """Return what the port says about itself and its connections, within `timeout` seconds, else 3.
    Raises UnknownName, LinkClosed, Timeout, NoNameServer, AddressError for a topic of another
    middleware."""
    with Scope(moment(ASKING if timeout is None else timeout)):
        return probe.describe(find_port(name, names))


@apart
def wait_for(
    name: str,
    target: str | None = None,
    timeout: float | None = None,
    *,
    names: NameClient | None = None,
) -> bool:
    """Wait until the port `name` exists (with `target`: until the two are connected).

    False when `timeout` seconds were not enough. Raises NoNameServer.
    """
    with Scope(moment(timeout)) as call:
        while not exists(name, target, names=names):
            left = inf if call.until is None else call.until - time.monotonic()
            if left <= _POLL:  # too little for another look: the rest is waited out
                time.sleep(max(left, 0.0))
                return False
            scope.sleep(_POLL)
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
