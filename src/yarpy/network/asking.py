"""One port, or the name server, asked by a program that needs no port for it.

Rules: requests are the messages that C++ tools send. `names` None is the default name service.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from yarpy.contact import Contact, parse_contact
from yarpy.data.bottle import Bottle
from yarpy.data.text import plain_text
from yarpy.errors import AddressError, LinkClosed, LocalProtocolError
from yarpy.names.base import NameClient
from yarpy.names.default import DEFAULT, secret
from yarpy.network.dialled import dialled_in
from yarpy.port.connect import identity, probe
from yarpy.port.connect.target import unknown
from yarpy.route import parse_carrier
from yarpy.scope import ASKING, Scope, apart, moment


@apart
def query(
    name: str, names: NameClient | None = None, *, timeout: float | None = None
) -> Contact | None:
    """Return the address of the port `name`, None if it is unknown. An address is returned as it
    is.

    Raises NoNameServer, also for one that has not answered within `timeout` seconds, else 3.
    """
    contact = parse_contact(name)
    if contact.placed:
        return contact
    with Scope(moment(ASKING if timeout is None else timeout)):
        return (names or DEFAULT.current()).query(contact.name)


def find(name: str, names: NameClient | None = None) -> Contact:
    """As `query`, but an unknown name raises UnknownName, which names the nearest known one."""
    return find_end(Contact("", name), names)


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


def find_end(end: Contact, names: NameClient | None) -> Contact:
    """As `find`, of an end of a connection, whose carrier the error takes up."""
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
        if peer in listed or (found := dialled_in(listed, contact, host)):
            return peer if peer in listed else found
    return peer


@apart
def ping(name: str, *, names: NameClient | None = None, timeout: float | None = None) -> list[str]:
    """Return what the port says about itself and its connections, within `timeout` seconds, else 3.
    Raises UnknownName, LinkClosed, Timeout, NoNameServer, AddressError for a topic of another
    middleware."""
    with Scope(moment(ASKING if timeout is None else timeout)):
        return probe.describe(find_port(name, names))


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
