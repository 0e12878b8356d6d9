"""Addresses: `Contact`, where a port is and how to speak to it.

Rules: pure, no sockets. The text forms are those of C++ YARP:

    >>> parse_contact("/cam")
    Contact(carrier='', name='/cam', host='', port=0)
    >>> parse_contact("udp://cam")
    Contact(carrier='udp', name='/cam', host='', port=0)
    >>> parse_contact("/10.0.0.1:10002")
    Contact(carrier='tcp', name='', host='10.0.0.1', port=10002)
    >>> parse_contact("tcp://10.0.0.1:10002/")
    Contact(carrier='tcp', name='', host='10.0.0.1', port=10002)
    >>> parse_contact("mjpeg+path.a/b.c?x=1://cam").carrier
    'mjpeg+path.a/b.c?x=1'

Brokers of MQTT have topics, which are no ports, and a usual number:

    >>> parse_contact("mqtt://broker/robot/arm")
    Contact(carrier='mqtt', name='/robot/arm', host='broker', port=1883)
    >>> parse_contact("mqtt+tls://broker/robot/arm").label
    '/mqtt://broker:8883/robot/arm'

Topics of ROS 2 have no address at all, but perhaps a type; keys of Zenoh have neither:

    >>> parse_contact("ros2://camera/image~sensor_msgs/msg/Image").label
    '/ros2://camera/image'
    >>> parse_contact("zenoh+sub://robot/arm").label
    '/zenoh://robot/arm'
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from yarpy import registry
from yarpy.errors import AddressError
from yarpy.facts import PORT, Reach

_HOST_PORT = re.compile(r"^[^:/]+:\d+$")
_IPV6_PORT = re.compile(r"^\[[0-9A-Fa-f:.%]+\]:\d+$")


@dataclass(frozen=True, slots=True)
class Contact:
    """The address of a port and its carrier. An empty `host` or a `port` of 0 is not known yet: a
    name service is asked."""

    carrier: str = "tcp"
    name: str = ""
    host: str = ""
    port: int = 0

    @property
    def reaches(self) -> Reach:
        """Return the kind of peer that its carrier leads to."""
        return reach(self.carrier)

    @property
    def reachable(self) -> bool:
        """Return whether host and port number are known."""
        return bool(self.host) and self.port > 0

    @property
    def placed(self) -> bool:
        """Return whether it can be dialled without asking a name server: it has an address, or
        needs none."""
        return self.reachable or self.reaches.topic

    @property
    def address(self) -> str:
        """`host:port`, with brackets around an IPv6 host."""
        host = f"[{self.host}]" if ":" in self.host else self.host
        return f"{host}:{self.port}"

    @property
    def label(self) -> str:
        """Return the name that ports give a connection that was dialled this way: the name, or
        `/host:port/`."""
        base, reaches = self.carrier.partition("+")[0], self.reaches
        if self.name and self.reachable and reaches.broker:
            return f"/{base}://{self.address}{self.name}"
        if reaches.topic:
            return f"/{base}:/{self.name.partition('~')[0]}"
        return self.name or f"/{self.address}/"

    def __str__(self) -> str:
        carrier = self.carrier or "tcp"
        if self.name:
            return f"{carrier}:/{self.name}"
        return f"{carrier}://{self.address}/"


def parse_contact(text: str) -> Contact:
    """Read `/name`, `carrier://name`, `/host:port`, `carrier://host:port[/name]`, `host:port`.

    An empty carrier in the result means that none was given. Raises AddressError for an empty text,
    or none, and for a broker without a topic.
    """
    check_text(text)
    if not text:
        raise AddressError('an empty port name; names start with "/", addresses are /host:port')
    carrier, rest = "", text
    base = text.find("://")
    if base < 0:
        base = text.find(":/")
    if base >= 0:
        carrier, rest = text[:base].removeprefix("/"), text[base + 1 :]
        if rest.startswith("//"):
            rest = rest[1:]
    reaches = reach(carrier)
    if rest.startswith("/") and not reaches.topic:
        head, slash, tail = rest[1:].partition("/")
        where = _host_port(head)
        if where is not None:
            if not tail and reaches.broker:
                spoken = carrier.partition("+")[0]
                raise AddressError(
                    f'"{spoken}://{head}" is a broker without a topic: {spoken}://HOST:PORT/TOPIC'
                )
            return Contact(carrier or "tcp", slash + tail if tail else "", *where)
        if head and tail and reaches.broker:
            usual = reaches.number_tls if "+tls" in carrier else reaches.number
            return Contact(carrier, slash + tail, head, usual)
    elif base < 0:
        # Not a form of C++ (there `host:port` is an unusable name): here it does what it says.
        where = _host_port(rest)
        if where is not None:
            return Contact("tcp", "", *where)
    return Contact(carrier, rest, "", 0)


def reach(carrier: str) -> Reach:
    """Return what a carrier leads to: ports, where none is named or nobody knows it."""
    base = carrier.partition("+")[0]
    return registry.carriers.facts(base).reaches if base else PORT


def _host_port(text: str) -> tuple[str, int] | None:
    if not (_HOST_PORT.match(text) or _IPV6_PORT.match(text)):
        return None
    host, _, port = text.rpartition(":")
    number = int(port) if len(port) < 6 else 65536
    if number > 65535:
        raise AddressError(f'"{text}": a TCP port number is at most 65535')
    return host.strip("[]"), number


def check_text(name: object) -> None:
    """Raise AddressError for what is not a text at all, such as None or a number."""
    if not isinstance(name, str):
        known = getattr(name, "name", None)  # of a port, which is taken for its name
        mend = f'; its name is a text: "{known}"' if isinstance(known, str) and known else ""
        raise AddressError(f'the name of a port is a text such as "/arm", not {name!r:.80}{mend}')


def check_name(name: str) -> str:
    """`name` if it can be the name of a port, else AddressError saying what a name looks like."""
    problem = ""
    if not name.startswith("/"):
        problem = f'must start with "/": try "/{name}"'
    elif any(c.isspace() for c in name):
        # C++ opens "/a b" as "/a", which may be the name of somebody else.
        joined = "_".join(name.split()).rstrip("/")
        problem = f'must not contain blanks, at which C++ YARP cuts it off: try "{joined:.80}"'
    elif '"' in name or "\\" in name:
        # The lines of name servers leave quotes out and double backslashes, ours as those of C++.
        problem = "must not contain quotes or backslashes, which name servers cannot hand on"
    elif name.endswith("/"):
        problem = 'must not end with "/": C++ YARP opens such a port, and refuses to connect it'
        if stem := name.rstrip("/"):
            problem += f'; try "{stem:.80}"'
    elif _host_port(name[1:].partition("/")[0]) is not None:
        problem = "reads as an address host:port; do not end the first part in a colon and digits"
    elif len(name.encode("utf-8", "surrogateescape")) > 900:
        problem = "is longer than 900 bytes"
    elif not name.isprintable():
        problem = "must not contain control characters"
    if problem:
        raise AddressError(f'a port name {problem} (name given: "{name[:80]}")')
    return name
