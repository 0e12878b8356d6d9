"""Identity: is the port that listens at an address the one whose name led there?

Rules: a name service may remember a number that belongs to another port by now, and a robot's arm
must not get what was meant for its camera. So the listener is asked for its name before a
connection to a name is made, and before a broken one is dialled again. A name that somebody entered
by hand is an alias or no YARP port at all: the first time it may lead anywhere. An address was
chosen on purpose; its listener is asked afterwards, to be recognised the next time.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Final

from yarpy.contact import Contact
from yarpy.errors import Timeout, YarpError
from yarpy.link.begin.handshake import GREETING, find_carrier
from yarpy.names.base import NameClient
from yarpy.port.connect import probe
from yarpy.route import Route
from yarpy.threads import Thread

TIMEOUT: Final = GREETING

# What a name service knows of a name: the values of a property.
Properties = Callable[[str, str], Iterable[object]]


def confirm(
    contact: Contact,
    properties: Properties | None,
    key: bytes,
    timeout: float | None = None,
    secure: bool = False,
) -> probe.Listener:
    """Return what the port that listens where `contact.name` should says of itself.

    Raises WrongPort (another port), LinkClosed (nobody listens), Timeout (it is silent).
    """
    if not has_to_be_asked(contact):
        return probe.Listener()
    try:
        found = probe.introduce(contact, timeout or TIMEOUT, key, secure)
    except Timeout:
        if _by_hand(contact.name, properties):
            return probe.Listener()
        raise
    judge(contact, found.name, properties)
    return found


def has_to_be_asked(contact: Contact) -> bool:
    """Return whether a name led to this address, so that another port may listen there by now."""
    return bool(contact.name) and contact.carrier in ("", "tcp")


def judge(contact: Contact, found: str, properties: Properties | None) -> None:
    """Raise WrongPort if a listener that calls itself `found` is not the port that is meant."""
    if found and found != contact.name and not _by_hand(contact.name, properties):
        raise probe.another_port(contact, contact.name, found)


def confirm_again(
    contact: Contact, route: Route, key: bytes, timeout: float | None = None
) -> probe.Listener:
    """As `confirm`, for the peer that `route` had before it broke."""
    found = probe.introduce(contact, timeout or TIMEOUT, key, route.spec.in_tls)
    if found.name != route.peer:
        raise probe.another_port(contact, route.peer, found.name)
    return found


def has_proof(route: Route) -> bool:
    """Return whether a broken connection may be dialled again by itself: its peer can be asked for
    its name, or has none."""
    return bool(route.peer) or is_nameless(route)


def is_nameless(route: Route) -> bool:
    """Return whether what is at the other end of such a connection may be no port: a camera, which
    is sent nothing, or what has said by its protocol that it is of the right kind."""
    kind = find_carrier(route.spec)
    return kind.reaches.nameless or (kind.reaches.foreign and not kind.push)


def learn(contact: Contact, route: Route, key: bytes) -> None:
    """Ask, in a thread of its own, which port a new connection has reached."""

    def ask() -> None:
        try:
            if not route.peer:
                route.peer, route.yarp4 = probe.introduce(contact, TIMEOUT, key, route.spec.in_tls)
        except YarpError:
            pass  # it cannot say
        finally:
            route.asked = False

    route.asked = True
    try:
        Thread(target=ask, name=f"yarpy who is {contact.address}", daemon=True).start()
    except BaseException:  # also out of a signal handler
        route.asked = False
        raise


def properties_of(names: NameClient | None) -> Properties | None:
    """Return the function that looks up what `names` knows of names."""
    return None if names is None else names.get


def _by_hand(name: str, properties: Properties | None) -> bool:
    """Return whether the name was registered by hand: no port told the name service of itself under
    it."""
    if properties is None:
        return False
    try:
        return not list(properties(name, "process"))
    except YarpError:
        return False
