"""Guard: what a peer asks of a port, held against what it may do there.

Rules: only connections of peers with limited rights are guarded; the others pay nothing for each
message. A refused command or question is answered with the refusal, and the connection goes on; a
refused message ends it. Requests that change nothing are open to every peer with any right at all,
and everybody is told the port's name, so that a peer looking for another port notices its mistake.

A peer that may read may also make the port send to a port on the peer's own computer, and end that
connection; one that may write may make it receive from there, and end such connections. Not so a
name server, where commands are messages, so that reading and writing mean no more than asking.
"""

from __future__ import annotations

from typing import Any, Final, Protocol

from yarpy.carriers.base import Carrier, to_write
from yarpy.contact import parse_contact
from yarpy.data.bottle import Bottle
from yarpy.data.text import plain_text
from yarpy.errors import AccessRefused, DecodeError, YarpError
from yarpy.link.begin.admission import ASK, Admission, Peer, on_behalf
from yarpy.link.begin.handshake import find_carrier
from yarpy.link.driver import Driver
from yarpy.link.receive.inbound import Inbound, Owner
from yarpy.link.send.outbound import Outbound
from yarpy.names.address import is_local
from yarpy.port.keep.registration import Registration
from yarpy.registry import graphs
from yarpy.route import CarrierSpec, parse_carrier
from yarpy.wire.message import ADMIN, CALL, DATA, QUIT, Message, Refused

# Administrative requests by their first four letters, as `answer/admin.py` reads them.
QUESTIONS: Final = frozenset(("help", "ver", "list", "get", "stat", "pray"))
CHANGES: Final = frozenset(("add", "del", "set", "prop"))
MONITORS: Final = frozenset(("atch", "dtch"))


class Inputs(Protocol):
    """Those of a port."""

    links: tuple[Inbound, ...]


class Outputs(Protocol):
    """Those of a port."""

    links: tuple[Outbound, ...]


class Hub(Protocol):
    """The port, as far as a guard needs it."""

    registration: Registration

    @property
    def inputs(self) -> Inputs: ...

    @property
    def outputs(self) -> Outputs: ...


def inbound(owner: Owner, hub: Hub, driver: Driver, carrier: Carrier) -> Inbound:
    """A connection into a port. Raises AccessRefused if it comes in vain; it is closed then."""
    admission = driver.admission
    if admission.everything:
        return Inbound(owner, driver, carrier)
    for right in to_write(carrier.route):
        if why := admission.refusal(right):
            driver.transport.close()
            raise AccessRefused(why)
    return Inbound(owner, driver, carrier, Guard(hub))


def to_read(spec: CarrierSpec) -> list[str]:
    """The rights that a reader needs: more if its monitors ride on our end, and if it wants what
    the port receives."""
    wanted = ["read", *(["attach"] if spec.send else [])]
    return [*wanted, "administer"] if spec.log is not None else wanted


class Guard:
    """Judges what comes from peers that may not do everything, by the rights of their admission."""

    def __init__(self, hub: Hub) -> None:
        self._hub = hub

    def advance(self, link: Inbound, deadline: float | None) -> Message:
        """Return the next message that may come. Raises AccessRefused."""
        message = link.receiver.advance(deadline)
        if message.key in (DATA, CALL):
            self._judge(link, message)
        return message

    def _judge(self, link: Inbound, message: Message) -> None:
        """Refuse a message that must not come. Raises AccessRefused, which ends the connection."""
        why = link.driver.admission.refusal("write")
        if not why:
            return
        receiver = link.receiver
        receiver.release()
        if message.key == CALL and receiver.open_question(message):
            message.reply(Refused(why))
        elif link.carrier.spelling == "text":
            link.carrier.encode_lines(link.driver.stream, [why])
            link.driver.flush()
        receiver.counter.drops += 1
        raise AccessRefused(why)

    def answer(self, link: Inbound, message: Message) -> Bottle | list[str] | None:
        """Carry out a port command, or refuse it; return the answer."""
        right = self._right(link, message)
        why = link.driver.admission.refusal(right) if right else ""
        if not why:
            with on_behalf(link.driver.admission):
                return link.carry_out(message)
        if message.key == ADMIN:
            called = graphs.call(_words(message.as_(Bottle))[0])
            if called is not None and called[1].changes and link.carrier.reaches.foreign:
                from yarpy.data.xmlrpc import Plain  # for programs of others

                return Plain([-1, why, 0])
            return Refused(why)
        if message.key == "*":
            return [f"This is {self._hub.registration.name} at tcp://{self._address}/", why]
        return [why]

    @property
    def _address(self) -> str:
        return self._hub.registration.contact.address

    # -- what a request needs ---------------------------------------------------------------------

    def _right(self, link: Inbound, message: Message) -> str:
        """The right that a command needs; "" if anybody may give it."""
        key, rest = message.key, message.text
        if key in (QUIT, "?", "h"):
            return ""
        if key == "*":
            return ASK
        if key == "r":
            allows = link.driver.admission.allows
            return next((one for one in to_read(link.route.spec) if not allows(one)), "")
        if key == ADMIN:
            return self._right_to_ask(link.driver.admission, message)
        if key == "/":
            return self._right_to_add(link.driver.admission, "/" + rest)
        if key == "!" and self._goes_to_peer(link.driver.admission.peer, rest):
            return "read"
        if key == "~" and self._comes_from_peer(link.driver.admission.peer, rest):
            return "write"
        return "administer"

    def _right_to_ask(self, admission: Admission, message: Message) -> str:
        try:
            request = message.as_(Bottle)
        except DecodeError:
            return ASK  # it gets an error
        name, second, third = _words(request)
        verb = name[:4]
        if verb in QUESTIONS or (verb == "prop" and second[:4] == "get"):
            return ASK
        if verb in MONITORS:
            return "attach"
        if verb == "add":
            return self._right_to_add(admission, f"{third}:/{second}" if third else second)
        if verb == "del":
            return self._right_to_delete(admission.peer, second)
        if verb in CHANGES:
            return "administer"
        if (called := graphs.call(name)) is not None:
            return "administer" if called[1].changes else ASK
        return "write"  # whatever the program itself understands

    def _right_to_add(self, admission: Admission, target: str) -> str:
        wanted = parse_contact(target)
        spec = parse_carrier(wanted.carrier)
        try:
            receives = not find_carrier(spec).push  # such a connection brings messages to us
        except YarpError:
            receives = False
        if (spec.recv if receives else spec.send) and not admission.allows("attach"):
            return "attach"
        if admission.directory or spec.log is not None or admission.allows("administer"):
            return "administer"
        try:
            contact = self._hub.registration.locate(wanted)
        except YarpError:
            contact = None
        if contact is None or not _is_of(admission.peer, contact.host):
            return "administer"
        return "write" if receives else "read"

    def _right_to_delete(self, peer: Peer, name: str) -> str:
        goes, comes = self._goes_to_peer(peer, name), self._comes_from_peer(peer, name)
        if goes and not any(link.route.source == name for link in self._hub.inputs.links):
            return "read"
        if comes and not any(link.route.target == name for link in self._hub.outputs.links):
            return "write"
        return "administer"

    def _goes_to_peer(self, peer: Peer, name: str) -> bool:
        """Return whether our outputs of that name, if any, lead to the computer of the peer."""
        found = [link for link in self._hub.outputs.links if link.route.target == name]
        return bool(found) and all(_is_of(peer, _remote(link)) for link in found)

    def _comes_from_peer(self, peer: Peer, name: str) -> bool:
        """Return whether our inputs of that name, if any, come from the computer of the peer."""
        found = [link for link in self._hub.inputs.links if link.route.source == name]
        return bool(found) and all(
            link.driver.admission.peer.address == peer.address or _is_of(peer, _remote(link))
            for link in found
        )


def _is_of(peer: Peer, host: str) -> bool:
    """Return whether an address is one of the peer's computer."""
    return bool(host) and (host == peer.address or (peer.here and is_local(host)))


def _remote(link: Inbound | Outbound) -> str:
    try:
        remote: Any = link.driver.transport.remote
        return str(remote[0])
    except OSError:
        return ""


def _words(request: Bottle) -> list[str]:
    """Return the first three words of a request, as `answer/admin.py` reads them: the first is a
    word, or "" if it is none, the others are whatever their text says."""
    first = plain_text(request[0]) if request and isinstance(request[0], str) else ""
    return [first, *map(plain_text, request[1:3]), "", ""][:3]
