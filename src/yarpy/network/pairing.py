"""Pairing: two ports whose connection is made, checked or ended by a third program.

Rules: all questions go to the ports themselves, over one connection to the port in charge.
"""

from __future__ import annotations

from typing import Self

from yarpy import registry
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
    UnknownPlugin,
)
from yarpy.link.begin.handshake import find_carrier
from yarpy.names.base import NameClient
from yarpy.names.default import DEFAULT, secret
from yarpy.network.asking import find_end
from yarpy.network.dialled import dialled_in
from yarpy.port.connect import identity, probe, refusal
from yarpy.port.connect.target import agreed, refuse_medium
from yarpy.route import CarrierSpec, parse_carrier
from yarpy.scope import CONNECTING

_CONFIRMING = 2.0  # seconds for a port to say its name


class Pairing:
    """Two ports whose connection is made, checked or ended from outside: over which carrier, which
    of them is asked, and in which words."""

    def __init__(self, source: str, target: str, carrier: str, names: NameClient | None) -> None:
        self.source_text, self.target_text = source, target
        # for all questions to the port in charge
        self._visit: probe.AdminConnection | None = None
        from_, to = _end(source, "source"), _end(target, "destination")
        self.topical = "topic" in (from_.carrier, to.carrier)
        self.source, self.target = from_, to
        if self.topical:
            self.spec = parse_carrier(carrier or "tcp")
            self.ask, self.peer, self.pull, self.open = "", "", False, False
            return
        here = from_ if from_.placed else find_end(from_, names)
        there = to if to.placed else find_end(to, names)
        constraint = ""
        for contact in (here, there):
            if not _competent(contact):
                constraint = contact.carrier
        given = carrier or written(target) or written(source)
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
        them sends to the other. Raises WrongPort if another port does.

        A port of yarpy that is to dial the other one looks at it itself, so nobody does so twice.
        """
        reached = self._confirm(self.asked, names)
        if not (reached and self._looks_itself()):
            self._confirm(self._other, names)

    def confirm_other(self, names: NameClient) -> None:
        """Raise WrongPort if that is why the port in charge could not dial the other one."""
        self._confirm(self._other, names)

    @property
    def _other(self) -> Contact:
        return self.here if self.asked is self.there else self.there

    def _confirm(self, contact: Contact, names: NameClient) -> bool:
        """Return whether it could be asked, if it had to be."""
        try:
            if contact is not self.asked:
                identity.confirm(contact, names.get, secret(), _CONFIRMING)
            elif identity.has_to_be_asked(contact):
                identity.judge(contact, self._visited().name(), names.get)
        except (LinkClosed, Timeout, RemoteProtocolError):
            return False  # perhaps it can be reached from the other one, if not from here
        return True

    def _looks_itself(self) -> bool:
        """Return whether the port in charge is of yarpy, if it matters."""
        if not identity.has_to_be_asked(self._other):
            return True
        try:
            reply = self.admin(Vocab("stat"), Vocab("in"), "?")
        except LinkClosed:
            return False
        return not reply or reply[0] != Vocab("fail")

    def _visited(self) -> probe.AdminConnection:
        if self._visit is None:
            self._visit = probe.AdminConnection(self.asked, CONNECTING)
        return self._visit

    def close(self) -> None:
        """Hang up, if somebody was asked."""
        visit, self._visit = self._visit, None
        if visit is not None:
            visit.close()

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
        return dialled_in(self.admin(Vocab("list"), Vocab("out")), self.there, self.here.host)

    def ask_back(self, *words: object) -> Bottle:
        """Ask the destination about a connection that it may have dialled itself, as with pull
        carriers. An empty answer if it is the port in charge anyway, or cannot be asked."""
        if self.pull or not _competent(self.there):
            return Bottle()
        try:
            return probe.ask(self.there, [*words, self.source.label])
        except (LinkClosed, Timeout, RemoteProtocolError):
            return Bottle()


def existing(source: str, target: str, names: NameClient | None = None) -> str:
    """Return the carrier of the connection between these ends; "" if there is none. Raises as
    Pairing."""
    with Pairing(source, target, "", names) as pairing:
        return pairing.existing()


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


def written(text: str) -> str:
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
