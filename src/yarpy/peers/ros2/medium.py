"""The transport `ros2`: makes the endpoint that a connection of a port goes over.

Rules: everything is in the target: `ros2+domain.7+node.arm+qos.sensor://chatter~std_msgs/msg/String`.
A topic without a type waits until somebody says it; a service needs one at once, or somebody who
serves it.
"""

from __future__ import annotations

from typing import Final

from yarpy.carriers.hosted import LISTENS, SERVICE
from yarpy.contact import Contact
from yarpy.errors import AddressError, UnknownName
from yarpy.log import logger
from yarpy.peers.ros2.dds.endpoint import open_dds
from yarpy.peers.ros2.dds.participant import WORD
from yarpy.peers.ros2.dds.service import DdsClient, DdsServer, begun
from yarpy.peers.ros2.key import domain
from yarpy.peers.ros2.name import check_node, check_topic, node_of
from yarpy.peers.ros2.qos import WORDS, qos_of_words
from yarpy.peers.ros2.zenoh.endpoint import Client, Endpoint, Publisher, Server
from yarpy.peers.ros2.zenoh.participant import take_part
from yarpy.peers.ros2.zenoh.subscriber import Subscriber
from yarpy.route import CarrierSpec, Route
from yarpy.transports.inbox import Inbox
from yarpy.transports.opener import Opener

log = logger("yarpy.ros2")

TIMEOUT: Final = 1.0  # seconds for a service to appear
HUMBLE: Final = "humble"

_KINDS: Final[dict[tuple[bool, bool], type[Endpoint]]] = {
    (False, False): Publisher,
    (False, True): Subscriber,
    (True, False): Client,
    (True, True): Server,
}


def open_medium(contact: Contact, route: Route) -> Inbox:
    """The endpoint of a connection of the port `route.source`.

    Raises AddressError (a name, domain or QoS that is none), UnknownName (nobody serves it, and no
    type is given), UnknownType, UnknownPlugin (the extra is not installed), LinkClosed (no router),
    LocalProtocolError (a service over DDS).
    """
    spec = route.spec
    name, _, type_ = contact.name.partition("~")
    topic = check_topic(name)
    serves = SERVICE in spec.tokens
    said = spec.value("node")
    node = node_of(route.source) if said is None else check_node(said)
    words = {key: spec.value(key) for key in (word.partition(".")[0] for word in WORDS)}
    given = {key: value for key, value in words.items() if value is not None}
    qos = qos_of_words(spec.value("qos"), given)
    kind = _KINDS[serves, LISTENS in spec.tokens]
    if WORD in spec.tokens:
        number, who = domain(spec.value("domain")), route.source
        if serves:
            made = (DdsServer if LISTENS in spec.tokens else DdsClient)(
                number, who, node, topic, qos
            )
            begun(made, type_)
            return made
        return open_dds(number, who, node, topic, type_, qos, kind.role)
    old = _is_old(spec)
    participant = take_part(domain(spec.value("domain")))
    try:
        endpoint = kind(participant, route.source, node, topic, qos)
    except BaseException:
        participant.close()
        raise
    try:
        endpoint.begin(type_, old, TIMEOUT if serves and not type_ else 0.0)
        if endpoint.kind is None and serves:
            raise UnknownName(
                f"nobody serves {topic} in domain {participant.graph.domain} of ROS 2: is its node "
                "running, with RMW_IMPLEMENTATION=rmw_zenoh_cpp? To be there first, name the type: "
                f"ros2+srv:/{topic}~package/srv/Type"
            )
    except BaseException:
        endpoint.close()
        raise
    if endpoint.kind is None:
        who = "publishes" if LISTENS in spec.tokens else "subscribes to"
        log.info("%s: nobody %s %s yet who says its type", route.source, who, topic)
    return endpoint


def _is_old(spec: CarrierSpec) -> bool:
    """Return whether the nodes are of Humble, which has no type hashes."""
    said = spec.value("distro")
    if said not in (None, HUMBLE):
        raise AddressError(
            f'"distro.{said}": only the oldest distribution is to be named, distro.{HUMBLE}; all '
            "others are alike"
        )
    return said is not None


class Ros2Opener(Opener):
    """Topics and services of ROS 2."""

    name = "ros2"
    proves = False
    meets = False

    @classmethod
    def dial(cls, contact: Contact, timeout: float, route: Route | None = None) -> Inbox:
        if route is None:
            raise AddressError(f'"{contact}" is no port: it cannot be asked')
        return open_medium(contact, route)
