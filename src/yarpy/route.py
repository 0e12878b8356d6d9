"""Routes: who talks to whom, and over which carrier - the carrier string, parsed once.

A carrier string is a protocol and what is added to it, in any order, a `+` before each:

    tcp+log.in                                   a key with its value, which may hold dots
    unix_stream+ack                              a word
    tcp+send.throttle+period_ms.10               monitors at the sender's end and their parameters,
    tcp+recv.portmonitor+file.x+(gain 1 2)       or at the receiver's end; a list in parentheses
    mjpeg+path.video+user.me+password.WORD       a password, which is never shown

It travels to the other side as a *specifier*: the sender's name, and a group `(key value)` for each
addition, where every dot has become a space.

Rules: pure. A connection has one `Route`, and that holds the one `CarrierSpec`: no other code
parses carrier strings. What may be shown is `text`, without the password.

    >>> spec = parse_carrier("mjpeg+path.a.b+password.x+y+recv.priority+tc.0.5")
    >>> spec.base, spec.value("path"), spec.text
    ('mjpeg', 'a.b', 'mjpeg+path.a.b+password.***+y+recv.priority+tc.0.5')
    >>> spec.recv
    (('priority', ('tc.0.5',)),)
    >>> parse_carrier("tcp+send.x+(note a+log.in b)").send
    (('x', ('(note a+log.in b)',)),)
    >>> route = Route("/w", "/r", "tcp+recv.priority+tc.0.5")
    >>> route.specifier
    '/w (recv priority) (tc 0 5)'
    >>> there = Route("", "/r", "tcp")
    >>> there.introduce(route.specifier)
    >>> print(there)
    /w -> /r (tcp+recv.priority+tc.0)
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any, Final, TypeAlias

from yarpy.errors import RemoteProtocolError
from yarpy.log import readable

_PASSWORD = re.compile(r"\+password\.[^+\s]*?(?=\+|:/|\s|$)")

#: monitors in their order: the name of each, and the parameters that follow it
Monitors: TypeAlias = tuple[tuple[str, tuple[str, ...]], ...]


@dataclass(frozen=True, slots=True, repr=False)
class CarrierSpec:
    """A parsed carrier string. `text` may be shown, `whole` has the password too.

    `own`: this program asked for it, not somebody on the network. `scripts`: who asked for it may
    name scripts of a context. `chosen`: nobody asked for that
    protocol, it seemed the best one.
    `base` is the protocol, `tokens` what is added to it. `send` and `recv` are the monitors at
    either end. `log` is the value of `+log`: such a connection gets what a port receives, not what
    it writes.
    """

    base: str
    tokens: tuple[str, ...]
    send: Monitors
    recv: Monitors
    log: str | None
    text: str
    whole: str
    own: bool = field(default=False, compare=False)
    scripts: bool = field(default=False, compare=False)
    chosen: bool = field(default=False, compare=False)

    def value(self, key: str) -> str | None:
        """The value of the first `+key.value`, or None.

        >>> parse_carrier("mjpeg+path.mjpg/video.mjpg?camera=1").value("path")
        'mjpg/video.mjpg?camera=1'
        >>> parse_carrier("tcp+log").value("log") is None
        True
        """
        for token in self.tokens:
            name, dot, value = token.partition(".")
            if dot and name == key:
                return value
        return None

    def plus(self, *tokens: str) -> CarrierSpec:
        """The same carrier with something more added to it."""
        return self._as("+".join((self.whole, *tokens)))

    @property
    def in_tls(self) -> bool:
        """Return whether the carrier string asks for TLS."""
        return self.base == "tls" or "tls" in self.tokens

    def over(self, base: str) -> CarrierSpec:
        """The same additions to another protocol.

        >>> parse_carrier("http+tls").over("mjpeg").text
        'mjpeg+tls'
        """
        return self._as("+".join((base, *self.tokens)))

    def _as(self, text: str) -> CarrierSpec:
        return replace(parse_carrier(text), own=self.own, scripts=self.scripts, chosen=self.chosen)

    def __str__(self) -> str:
        return self.text

    def __repr__(self) -> str:
        return f"CarrierSpec({self.text!r})"


def parse_carrier(text: str) -> CarrierSpec:
    """Read a carrier string. Without a protocol it means tcp. Any text is valid.

    >>> parse_carrier("").base
    'tcp'
    """
    base, *tokens = _split(text)
    monitors: dict[str, list[tuple[str, list[str]]]] = {"send": [], "recv": []}
    own: list[str] | None = None
    log = None
    for token in tokens:
        key, dot, value = token.partition(".")
        if dot and key in monitors:
            own = []
            monitors[key].append((value, own))
        elif own is not None:
            own.append(token)
        if dot and key == "log" and log is None:
            log = value
    send, recv = (tuple((name, tuple(its)) for name, its in monitors[end]) for end in monitors)
    shown = ["password.***" if token.startswith("password.") else token for token in tokens]
    return CarrierSpec(
        base or "tcp", tuple(tokens), send, recv, log, masked("+".join((base, *shown))), text
    )


def _split(text: str) -> list[str]:
    """Return what stands between `+` outside parentheses. Those that do not pair up are ordinary
    characters."""
    if "(" not in text:
        return text.split("+")
    found, depth, start = [], 0, 0
    for index, c in enumerate(text):
        if c == "+" and depth == 0:
            found.append(text[start:index])
            start = index + 1
        depth = max(depth + (c == "(") - (c == ")"), 0)
    return [*found, text[start:]] if depth == 0 else text.split("+")


def masked(text: str) -> str:
    """A text with a carrier string in it, such as an address, without the password.

    >>> masked("mjpeg+path.video+user.me+password.a.b://cam")
    'mjpeg+path.video+user.me+password.***://cam'
    """
    return _PASSWORD.sub("+password.***", text)


@dataclass(frozen=True, slots=True)
class Declared:
    """The description that our port gives of itself where a protocol asks for it: the node that it
    belongs to, its topic or service, the name of its type, and the class of that, as far as it is
    known. `latched`: who comes late gets the last message. `clock` gives the time for messages
    without a stamp, in seconds. `graph`: the name of the graph that its node belongs to. `frame`:
    the frame of reference of its pictures and points."""

    node: str = ""
    topic: str = ""
    type: str = ""
    kind: Any = None
    latched: bool = False
    clock: Callable[[], float] | None = None
    graph: str = ""
    frame: str = ""


UNDECLARED: Final = Declared()


@dataclass(slots=True, init=False)
class Route:
    """The two ends of one connection, and its carrier. `port` is the accepting side's TCP port,
    `host` its address, where it was dialled. `peer` is what the port that was dialled calls itself,
    as far as it was asked and can say; `asked`: it is being asked; `yarp4`: it is of C++ YARP 4.
    `declared` is what our port says of itself."""

    source: str
    target: str
    spec: CarrierSpec
    port: int
    host: str
    peer: str = field(compare=False)
    asked: bool = field(compare=False)
    yarp4: bool = field(compare=False)
    declared: Declared = field(compare=False)

    def __init__(
        self,
        source: str,
        target: str,
        carrier: str | CarrierSpec = "tcp",
        port: int = 0,
        host: str = "",
        peer: str = "",
        declared: Declared = UNDECLARED,
    ) -> None:
        self.source = source
        self.target = target
        self.spec = parse_carrier(carrier) if isinstance(carrier, str) else carrier
        self.port = port
        self.host = host
        self.peer = peer
        self.asked = self.yarp4 = False
        self.declared = declared

    @property
    def carrier(self) -> str:
        """The carrier string, as everybody may see it."""
        return self.spec.text

    @property
    def specifier(self) -> str:
        """Return what the sender says of itself: its name, and what is added to its carrier."""
        _, plus, additions = self.spec.whole.partition("+")
        if not plus:
            return self.source
        return f"{self.source} ({additions.replace('+', ') (').replace('.', ' ')})"

    def introduce(self, specifier: str) -> None:
        """Take source and additions from what the sender says of itself.

        Of each group only the first two words survive, as in C++. RemoteProtocolError for what no
        port can be called: a name is shown to people, here and by the name server.
        """
        if readable(specifier) != specifier:
            shown = readable(specifier[:80])
            raise RemoteProtocolError(f'control characters in the name of the peer: "{shown}"')
        self.source, _, rest = specifier.partition(" ")
        added = []
        for token in _split_groups(rest):
            words = _split_groups(token[1:-1]) if token.startswith("(") else [token]
            if words and words != ["tls"]:  # whether it is TLS we see ourselves
                added.append(".".join(words[:2]))
        if added:
            self.spec = self.spec.plus(*added)

    def __str__(self) -> str:
        return f"{self.source} -> {self.target} ({self.carrier})"


def _split_groups(text: str) -> list[str]:
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
