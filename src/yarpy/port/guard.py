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
from yarpy.data.xmlrpc import Plain
from yarpy.errors import AccessRefused, DecodeError, YarpError
from yarpy.link.admission import ASK, Peer
from yarpy.link.driver import Driver
from yarpy.link.handshake import find_carrier
from yarpy.link.inbound import Inbound, Owner
from yarpy.link.outbound import Outbound
from yarpy.names.address import is_local
from yarpy.port.registration import Registration
from yarpy.route import CarrierSpec, parse_carrier
from yarpy.wire.message import ADMIN, CALL, DATA, QUIT, Message, Refused

# Administrative requests by their first four letters, as `port/admin.py` reads them.
QUESTIONS: Final = frozenset(("help", "ver", "list", "get", "stat", "pray"))
CHANGES: Final = frozenset(("add", "del", "set", "prop"))
MONITORS: Final = frozenset(("atch", "dtch"))
# What ROS nodes ask of each other, and what they are told, whole. Over XML-RPC a refusal has ROS's
# three elements.
ROS: Final = frozenset(
    (
        *("requestTopic", "getPid", "getBusInfo", "rtop", "pid", "bus", "getBusStats"),
        *("getMasterUri", "getPublications", "getSubscriptions"),
    )
)
TOLD: Final = frozenset(("publisherUpdate", "paramUpdate", "shutdown", "rpup"))


class Hub(Owner, Protocol):
    """What a guard needs of its port."""

    registration: Registration
    inputs: tuple[Inbound, ...]
    outputs: tuple[Outbound, ...]


def inbound(hub: Hub, driver: Driver, carrier: Carrier) -> Inbound:
    """A connection into a port. Raises AccessRefused if it comes in vain; it is closed then."""
    admission = driver.admission
    if admission.everything:
        return Inbound(hub, driver, carrier)
    for right in to_write(carrier.route):
        if why := admission.refusal(right):
            driver.transport.close()
            raise AccessRefused(why)
    link = Inbound(hub, driver, carrier)
    Guard(hub, link)
    return link


def to_read(spec: CarrierSpec) -> list[str]:
    """The rights that a reader needs: more if its monitors ride on our end, and if it wants what
    the port receives."""
    wanted = ["read", *(["attach"] if spec.send else [])]
    return [*wanted, "administer"] if spec.log is not None else wanted


class Guard:
    """Stands in the way of a connection whose peer may not do everything."""

    def __init__(self, hub: Hub, link: Inbound) -> None:
        self._hub = hub
        self._link = link
        link.advance = self.advance  # messages are judged before anybody sees them
        link.answer = self.answer

    def advance(self, deadline: float | None) -> Message:
        """The next message that may come. Raises AccessRefused."""
        message = self._link.receiver.advance(deadline)
        if message.key in (DATA, CALL):
            self._judge(message)
        return message

    def _judge(self, message: Message) -> None:
        """Refuse a message that must not come. Raises AccessRefused, which ends the connection."""
        link = self._link
        why = link.driver.admission.refusal("write")
        if not why:
            return
        receiver = link.receiver
        if message.key == CALL and receiver.open_question(message):
            message.reply(Refused(why))
        elif link.carrier.spelling == "text":
            link.carrier.encode_lines(link.driver.stream, [why])
            link.driver.flush()
        receiver.counter.drops += 1
        raise AccessRefused(why)

    def answer(self, message: Message) -> Bottle | list[str] | None:
        """What a port command is answered: it is carried out, or refused."""
        right = self._right(message)
        why = self._link.driver.admission.refusal(right) if right else ""
        if not why:
            return self._link.carry_out(message)
        if message.key == ADMIN:
            by_ros = self._link.carrier.foreign and _verb(message) in TOLD
            return Plain([-1, why, 0]) if by_ros else Refused(why)
        if message.key == "*":
            return [f"This is {self._hub.name} at tcp://{self._address}/", why]
        return [why]

    @property
    def _address(self) -> str:
        return self._hub.registration.contact.address

    # -- what a request needs ---------------------------------------------------------------------

    def _right(self, message: Message) -> str:
        """The right that a command needs; "" if anybody may give it."""
        key, rest = message.key, message.text
        if key in (QUIT, "?", "h"):
            return ""
        if key == "*":
            return ASK
        if key == "r":
            allows = self._link.driver.admission.allows
            return next((one for one in to_read(self._link.route.spec) if not allows(one)), "")
        if key == ADMIN:
            return self._right_to_ask(message)
        if key == "/":
            return self._right_to_add("/" + rest)
        if key == "!" and self._goes_to_peer(rest):
            return "read"
        if key == "~" and self._comes_from_peer(rest):
            return "write"
        return "administer"

    def _right_to_ask(self, message: Message) -> str:
        try:
            request = message.as_(Bottle)
        except DecodeError:
            return ASK  # it gets an error
        name, second, third = _words(request)
        verb = name[:4]
        if name in ROS or verb in QUESTIONS or (verb == "prop" and second[:4] == "get"):
            return ASK
        if verb in MONITORS:
            return "attach"
        if verb == "add":
            return self._right_to_add(f"{third}:/{second}" if third else second)
        if verb == "del":
            return self._right_to_delete(second)
        return "administer" if verb in CHANGES or name in TOLD else "write"

    def _right_to_add(self, target: str) -> str:
        wanted = parse_contact(target)
        spec = parse_carrier(wanted.carrier)
        admission = self._link.driver.admission
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

    def _right_to_delete(self, name: str) -> str:
        goes, comes = self._goes_to_peer(name), self._comes_from_peer(name)
        if goes and not any(link.route.source == name for link in self._hub.inputs):
            return "read"
        if comes and not any(link.route.target == name for link in self._hub.outputs):
            return "write"
        return "administer"

    def _goes_to_peer(self, name: str) -> bool:
        """Whether our outputs of that name, if any, lead to the computer of the peer."""
        peer = self._link.driver.admission.peer
        found = [link for link in self._hub.outputs if link.route.target == name]
        return bool(found) and all(_is_of(peer, _remote(link)) for link in found)

    def _comes_from_peer(self, name: str) -> bool:
        """Whether our inputs of that name, if any, come from the computer of the peer."""
        peer = self._link.driver.admission.peer
        found = [link for link in self._hub.inputs if link.route.source == name]
        return bool(found) and all(
            link.driver.admission.peer.address == peer.address or _is_of(peer, _remote(link))
            for link in found
        )


def _is_of(peer: Peer, host: str) -> bool:
    """Whether an address is one of the peer's computer."""
    return bool(host) and (host == peer.address or (peer.here and is_local(host)))


def _remote(link: Inbound | Outbound) -> str:
    try:
        remote: Any = link.driver.transport.remote
        return str(remote[0])
    except OSError:
        return ""


def _words(request: Bottle) -> list[str]:
    """The first three words of a request, as `port/admin.py` reads them: the first is a word, or ""
    if it is none, the others are whatever their text says."""
    first = plain_text(request[0]) if request and isinstance(request[0], str) else ""
    return [first, *map(plain_text, request[1:3]), "", ""][:3]


def _verb(message: Message) -> str:
    """The first word of a request that could be read."""
    return _words(message.as_(Bottle))[0]
