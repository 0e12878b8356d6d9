"""zmq: every port is a ZeroMQ socket, for those who connect to its number and to connect to others.

    zmq+pub.TOPIC    zmq+sub.TOPIC      to a SUB that is bound there, from a PUB
    zmq+push         zmq+pull           to a PULL, from a PUSH
    zmq+req          zmq+rep            questions to a REP, from a REQ
    ... +user.NAME+password.WORD        to a socket that asks for them (PLAIN)
    ... +curve.KEY+password.KEY         to a socket with a key (CURVE)

Rules: a carrier string says what the side that dials is. Of a socket that dials us we are whatever
fits, all at once. What PUB and SUB exchange has the topic as its first frame; the topic of a port
is its name. A REQ's question goes to the port's reader, whose reply returns. `carriers/payload.py`
says what the last frame holds; `+raw` is YARP's own spelling, under a topic that begins with
`raw:`, which subscribers ask for by subscribing to `raw:`. A SUB never keeps its writer waiting: as
with ZeroMQ's own high-water mark a number of messages wait for it, and others are dropped, and
counted. PINGs are answered; a host that has died is noticed by TCP.
"""

from __future__ import annotations

from typing import Final

from yarpy.carriers.base import Carrier, refuse_unknown
from yarpy.errors import LocalProtocolError, RemoteProtocolError
from yarpy.log import readable
from yarpy.peers.zmq import curve, curve_server, plain, zmtp
from yarpy.peers.zmq.reading import Pull, Rep, Sub
from yarpy.peers.zmq.role import PARTNER, PORT, Role
from yarpy.peers.zmq.writing import Pub, Push, Req
from yarpy.route import CarrierSpec, Route
from yarpy.wire.steps import Steps
from yarpy.wire.stream import ByteStream

NOBODY: Final = "zmq"  # what a peer without a name is called

#: by what a carrier string says of the side that dials
ROLES: Final[dict[str, type[Role]]] = {kind.role: kind for kind in (Pub, Push, Req, Sub, Pull, Rep)}
_WORDS: Final = (
    *("pub.TOPIC", "push", "req", "sub.TOPIC", "pull", "rep"),
    *("user.NAME", "password.WORD", "curve.KEY", "raw"),
)


class Zmq(Role):
    """A connection before it is known what its ends are."""

    magic = zmtp.MAGIC

    @classmethod
    def of(cls, spec: CarrierSpec) -> type[Carrier]:
        refuse_unknown(spec, _WORDS)
        if curve.keys_of(spec) is None:
            plain.credentials(spec)
        found = roles_of(spec)
        if len(found) != 1:
            raise LocalProtocolError(
                f'"{spec}" does not say what this end is: zmq+pub, zmq+push and zmq+req send, '
                "zmq+sub, zmq+pull and zmq+rep receive"
            )
        return ROLES[found[0]]

    def welcome(self, stream: ByteStream, first: bytes) -> Steps[Carrier | None]:
        stream.write(zmtp.OPENING)
        stream.unread(len(first))
        minor, mechanism = yield from zmtp.read_any_greeting(stream)
        minor = min(1, minor)
        sealed: curve_server.Server | None = None
        if mechanism == curve.MECHANISM:
            sealed = curve_server.Server(curve_server.own_key())
            admitting = sealed.admit(stream)
        elif mechanism == plain.MECHANISM:
            admitting = plain.admit(stream)
        elif mechanism == zmtp.NULL:
            admitting = zmtp.read_ready(stream)
        else:
            zmtp.refuse(mechanism)
        stream.write(zmtp.greeting(mechanism, mechanism != zmtp.NULL)[len(zmtp.OPENING) :])
        properties = yield from admitting
        kind = properties.get("socket-type", b"").upper()
        if kind not in PARTNER:
            shown = readable(kind[:20].decode("latin-1")) or "socket without a type"
            why = f"a port does not speak with a {shown}: take SUB, PULL, PUB, PUSH, REQ or REP"
            stream.write(zmtp.error(why))
            raise RemoteProtocolError(why)
        ours, told = PARTNER[kind]
        old = self.route
        route = Route(NOBODY, old.target, old.spec, old.port, old.host, declared=old.declared)
        says = properties.get(PORT.lower(), b"").decode("utf-8", "surrogateescape")
        if says:
            route.introduce(says)
        if told not in route.spec.tokens and route.spec.value(told) is None:
            route.spec = route.spec.plus(told)
        if roles_of(route.spec) != [told]:
            raise RemoteProtocolError(f"a {kind.decode()} that says that it is {route.spec}")
        carrier = ROLES[ours](route)
        carrier.minor, carrier.push, carrier.accepted = minor, not carrier.push, True
        carrier.sealed = sealed
        yield from carrier.admit(stream)
        stream.write((sealed.ready_of if sealed else zmtp.ready)(carrier.said()))
        carrier.begin(stream)
        return carrier


def roles_of(spec: CarrierSpec) -> list[str]:
    """The roles that a carrier string names."""
    return [word for token in spec.tokens if (word := token.partition(".")[0]) in ROLES]
