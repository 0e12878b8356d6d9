"""Addresses: `Contact` (where a port is and how to speak to it) and carrier strings.

Rules: pure, no sockets. The text forms are those of C++ YARP (spec core-3 section 6.1):

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

A carrier string is `base+key.value+flag...`; it travels to the other side as a *specifier*, the
sender's name followed by ` (key value)` groups, where every dot has become a space:

    >>> specifier("/w", "tcp+recv.priority+tc.0.5")
    '/w (recv priority) (tc 0 5)'
    >>> read_specifier("/w (recv priority) (tc 0 5)", "tcp")
    ('/w', 'tcp+recv.priority+tc.0')
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from yarpy.errors import AddressError

_HOST_PORT = re.compile(r"^[^:/]+:\d+$")
_PASSWORD = re.compile(r"\+password\.[^+\s]*?(?=\+|:/|\s|$)")
_IPV6_PORT = re.compile(r"^\[[0-9A-Fa-f:.%]+\]:\d+$")


@dataclass(frozen=True, slots=True)
class Contact:
    """How to reach a port. `host` empty or `port` 0 mean: not known yet, ask a name service."""

    carrier: str = "tcp"
    name: str = ""
    host: str = ""
    port: int = 0

    @property
    def reachable(self) -> bool:
        """Whether host and port number are known."""
        return bool(self.host) and self.port > 0

    @property
    def address(self) -> str:
        """`host:port`, with brackets around an IPv6 host."""
        host = f"[{self.host}]" if ":" in self.host else self.host
        return f"{host}:{self.port}"

    def __str__(self) -> str:
        carrier = self.carrier or "tcp"
        if self.name:
            return f"{carrier}:/{self.name}"
        return f"{carrier}://{self.address}/"


@dataclass(slots=True)
class Route:
    """Who talks to whom over what: one connection. `port` is the accepting side's TCP port,
    `host` its address, where we dialled it. `secret` is the carrier string with its password,
    where `carrier`, which everybody may see, has none."""

    source: str
    target: str
    carrier: str = "tcp"
    port: int = 0
    host: str = ""
    secret: str = field(default="", repr=False)

    def __str__(self) -> str:
        return f"{self.source} -> {self.target} ({self.carrier})"


def parse_contact(text: str) -> Contact:
    """Read `/name`, `carrier://name`, `/host:port`, `carrier://host:port[/name]`, `host:port`.

    An empty carrier in the result means that none was given. Raises AddressError for no text.
    """
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
    if rest.startswith("/"):
        head, slash, tail = rest[1:].partition("/")
        where = _host_port(head)
        if where is not None:
            return Contact(carrier or "tcp", slash + tail if tail else "", *where)
    elif base < 0:
        # Not a form of C++ (there `host:port` is an unusable name): here it does what it says.
        where = _host_port(rest)
        if where is not None:
            return Contact("tcp", "", *where)
    return Contact(carrier, rest, "", 0)


def _host_port(text: str) -> tuple[str, int] | None:
    if not (_HOST_PORT.match(text) or _IPV6_PORT.match(text)):
        return None
    host, _, port = text.rpartition(":")
    number = int(port) if len(port) < 6 else 65536
    if number > 65535:
        raise AddressError(f'"{text}": a TCP port number is at most 65535')
    return host.strip("[]"), number


def check_name(name: str) -> str:
    """`name` if it can be the name of a port, else AddressError saying what a name looks like."""
    problem = ""
    if not name.startswith("/"):
        problem = f'must start with "/": try "/{name}"'
    elif any(c.isspace() for c in name):
        problem = "must not contain blanks"
    elif name.endswith("/"):
        problem = 'must not end with "/"'
    elif _host_port(name[1:].partition("/")[0]) is not None:
        problem = "reads as an address host:port; do not end the first part in a colon and digits"
    elif len(name.encode("utf-8", "surrogateescape")) > 900:
        problem = "is longer than 900 bytes"
    elif not name.isprintable():
        problem = "must not contain control characters"
    if problem:
        raise AddressError(f'a port name {problem} (name given: "{name[:80]}")')
    return name


def base_carrier(carrier: str) -> str:
    """The protocol of a carrier string: the part before the first `+`.

    >>> base_carrier("tcp+recv.priority")
    'tcp'
    """
    return carrier.partition("+")[0]


def modifier(carrier: str, key: str) -> str | None:
    """The value of `+key.value` in a carrier string, or None. The value may contain dots.

    >>> modifier("mjpeg+path.mjpg/video.mjpg?camera=1", "path")
    'mjpg/video.mjpg?camera=1'
    >>> modifier("tcp+log", "log") is None
    True
    """
    for token in carrier.split("+")[1:]:
        name, dot, value = token.partition(".")
        if dot and name == key:
            return value
    return None


def masked(text: str) -> str:
    """A carrier string, or a text with one in it, without the password.

    >>> masked("mjpeg+path.video+user.me+password.a.b://cam")
    'mjpeg+path.video+user.me+password.***://cam'
    """
    return _PASSWORD.sub("+password.***", text)


def specifier(name: str, carrier: str) -> str:
    """What the sender says of itself on the wire: its name and its carrier's modifiers."""
    _, plus, modifiers = carrier.partition("+")
    if not plus:
        return name
    return f"{name} ({modifiers.replace('+', ') (').replace('.', ' ')})"


def read_specifier(text: str, carrier: str) -> tuple[str, str]:
    """The sender's name and full carrier string out of a specifier received over `carrier`.

    Of each group only the first two words survive, as in C++.
    """
    if " " not in text:
        return text, carrier
    name, _, rest = text.partition(" ")
    for token in _split_tokens(rest):
        words = _split_tokens(token[1:-1]) if token.startswith("(") else [token]
        if words:
            carrier += "+" + ".".join(words[:2])
    return name, carrier


def _split_tokens(text: str) -> list[str]:
    """Split at blanks outside parentheses; an unbalanced rest is dropped."""
    tokens, depth, current = [], 0, ""
    for c in text:
        if c in " \t" and depth == 0:
            if current:
                tokens.append(current)
            current = ""
            continue
        depth += (c == "(") - (c == ")")
        current += c
    if current and depth == 0:
        tokens.append(current)
    return tokens
