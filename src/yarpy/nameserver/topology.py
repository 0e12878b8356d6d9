"""Topics, subscriptions and persistent connections: what a name server keeps connected.

Rules: pure; the clock is handed in (seconds since the epoch). Nothing here talks to a port: every
event (`announce`, `vanish`, `subscribe` ...) returns the connections to make or to break, and the
caller does so in the background, in order for each pair of ports.

Semantics: a name is live from `announce` until it is unregistered, or until
somebody says that it does not answer and it has been live for more than 30 s. A rule joins two
ports, or a port and a topic; a port into a topic is joined with every port out of it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Literal

from yarpy.errors import AddressError

GRACE = 30.0  # seconds a name must have been live before a complaint removes it
LONGEST_NAME = 1000  # characters of a name, decorations included
LONGEST_STRUCTURE = 65_536  # characters that describe a topic or a type
TOTAL_STRUCTURES = 16 << 20  # characters of all together


def undecorate(text: str) -> tuple[str, str]:
    """The carrier and the name of `carrier:/name`; the carrier is "" where none is written.

    >>> undecorate("udp://cam")
    ('udp', '/cam')
    >>> undecorate("tcp:/cam")
    ('tcp', 'cam')
    """
    place = text.find(":/")
    if place < 0:
        return "", text
    return text[:place].removeprefix("/"), text[place + 2 :]


def split_network(name: str) -> tuple[str | None, str]:
    """`/net=127/x` means /x at an address that begins with 127.

    >>> split_network("/net=127/x"), split_network("/x")
    (('127', '/x'), (None, '/x'))
    """
    if name[:5] not in ("/net=", "/NET="):
        return None, name
    network, slash, rest = name[5:].partition("/")
    return network, slash + rest


def bare_name(text: str) -> str:
    """The name in a decorated one: without carrier and network."""
    return split_network(undecorate(text)[1])[1]


@dataclass(frozen=True, slots=True)
class Subscription:
    """A rule: keep `source` connected to `destination`. Both may be decorated by a carrier."""

    source_text: str
    destination_text: str
    mode: str = ""  # "from" or "to": forget the rule when that side is unregistered

    @property
    def source(self) -> str:
        return bare_name(self.source_text)

    @property
    def destination(self) -> str:
        return bare_name(self.destination_text)

    @property
    def carrier(self) -> str:
        return undecorate(self.destination_text)[0]


@dataclass(frozen=True, slots=True)
class Action:
    """Something to do to two ports: `[add] "carrier://destination"` or `[del]` asked of `ask`.
    Without a carrier the one that seems best."""

    kind: Literal["connect", "disconnect"]
    source: str
    destination: str
    carrier: str = ""
    ask: str = ""  # the port to be asked; on disconnect the one that is still there

    @property
    def peer(self) -> str:
        """The other side, as seen from `ask`."""
        return self.destination if self.ask == self.source else self.source


class Topology:
    """Rules, topics, types and the live table. `on_change(kind, key)` is called for what a database
    must write: kinds `subscription` (key `source`, NUL, `destination`), `topic`, `live`,
    `structure`.
    """

    def __init__(self, clock: Callable[[], float], limit: int = 100_000) -> None:
        self.clock = clock
        self.limit = limit
        self.live: dict[str, float] = {}
        self.topics: dict[str, str] = {}  # name -> structure
        self.structures: dict[str, str] = {}  # type name -> its yarp description
        self._described = 0  # characters of both
        self.on_change: Callable[[str, str], None] | None = None
        self._rules: dict[tuple[str, str], Subscription] = {}
        self._out: dict[str, dict[str, Subscription]] = {}  # source -> destination -> rule
        self._in: dict[str, dict[str, Subscription]] = {}  # destination -> source -> rule

    # --- events

    def announce(self, name: str) -> list[Action]:
        """`name` listens: connect it wherever a rule has it and the other side is live too."""
        _check(name)
        if name not in self.live and len(self.live) >= self.limit:
            raise AddressError(f"this server watches at most {self.limit} ports")
        self.live[name] = self.clock()
        self._changed("live", name)
        return [_connect(*pair) for pair in self._pairs(name) if self._both_live(pair)]

    def complain(self, name: str) -> None:
        """`name` is reported not to answer."""
        since = self.live.get(name)
        if since is not None and self.clock() - since > GRACE:
            del self.live[name]
            self._changed("live", name)

    def vanish(self, name: str) -> list[Action]:
        """`name` was unregistered: let the other sides drop it, forget rules tied to its life."""
        actions = []
        if self.live.pop(name, None) is not None:
            self._changed("live", name)
        for source, destination, carrier in self._pairs(name):
            other = destination if source == name else source
            if other in self.live:
                actions.append(Action("disconnect", source, destination, carrier, other))
        for rule in [*self._out.get(name, {}).values(), *self._in.get(name, {}).values()]:
            if (rule.mode, name) in (("from", rule.source), ("to", rule.destination)):
                self.unsubscribe(rule.source, rule.destination)
        return actions

    def subscribe(
        self, source: str, destination: str, mode: str, known: Callable[[str], bool]
    ) -> list[Action]:
        """Add a rule, or replace the one for the same two names. Returns what to connect now.

        mode: "from" or "to" tie it to the life of the source or destination; if that is a port
        and not `known` (registered) the rule is dropped at once, silently as in C++.
        Raises AddressError for an empty name, an unknown mode, or too many rules.
        """
        if mode not in ("", "from", "to"):
            raise AddressError(f'mode "{mode}": a subscription is tied "from", "to" or not at all')
        rule = Subscription(source, destination, mode)
        if not rule.source or not rule.destination:
            raise AddressError("a subscription needs two port or topic names")
        _check(source)
        _check(destination)
        pair = rule.source, rule.destination
        for side, text, name in (("from", source, pair[0]), ("to", destination, pair[1])):
            if undecorate(text)[0].partition("+")[0] == "topic":
                if name not in self.topics:
                    self.declare(name)
            elif mode == side and not known(name):
                self.unsubscribe(*pair)
                return []
        if pair not in self._rules and len(self._rules) >= self.limit:
            raise AddressError(f"this server keeps at most {self.limit} subscriptions")
        self._add(rule)
        self._changed("subscription", "\0".join(pair))
        return [_connect(*pair) for pair in self._joined(rule) if self._both_live(pair)]

    def unsubscribe(self, source: str, destination: str) -> bool:
        """Forget a rule; a connection that exists stays. Whether there was one."""
        pair = bare_name(source), bare_name(destination)
        if self._rules.pop(pair, None) is None:
            return False
        for table, key, other in ((self._out, *pair), (self._in, pair[1], pair[0])):
            del table[key][other]
            if not table[key]:
                del table[key]
        self._changed("subscription", "\0".join(pair))
        return True

    def declare(self, topic: str, structure: str = "") -> list[Action]:
        """Make `topic` a topic; rules that mention it join through it from now on."""
        _check(topic, structure)
        if topic not in self.topics and len(self.topics) >= self.limit:
            raise AddressError(f"this server keeps at most {self.limit} topics")
        new = topic not in self.topics
        self._take(self.topics.get(topic, ""), structure)
        self.topics[topic] = structure
        self._changed("topic", topic)
        if not new:
            return []
        return [_connect(*pair) for pair in self._through(topic) if self._both_live(pair)]

    def undeclare(self, topic: str) -> None:
        """`topic` is no longer one; rules that mention it stay."""
        structure = self.topics.pop(topic, None)
        if structure is not None:
            self._take(structure, "")
            self._changed("topic", topic)

    def describe(self, type_: str, structure: str) -> None:
        """Remember the description of a type."""
        _check(type_, structure)
        if type_ not in self.structures and len(self.structures) >= self.limit:
            raise AddressError(f"this server keeps at most {self.limit} types")
        self._take(self.structures.get(type_, ""), structure)
        self.structures[type_] = structure
        self._changed("structure", type_)

    def _take(self, old: str, new: str) -> None:
        """A description takes the place of another. Raises AddressError if there is no room."""
        size = self._described + len(new) - len(old)
        if size > max(TOTAL_STRUCTURES, self._described):
            raise AddressError(
                f"this server keeps at most {TOTAL_STRUCTURES} characters of descriptions"
            )
        self._described = size

    def collect(self, known: Callable[[str], bool]) -> None:
        """Drop live marks of names that are not registered."""
        for name in [name for name in self.live if not known(name)]:
            del self.live[name]
            self._changed("live", name)

    # --- looking

    def subscriptions(self, name: str = "") -> list[Subscription]:
        """Return all rules, or those with `name` on one side, by source and destination."""
        if name:
            found = set(self._out.get(name, {}).values())
            found.update(self._in.get(name, {}).values())
        else:
            found = set(self._rules.values())
        return sorted(found, key=lambda rule: (rule.source, rule.destination))

    def rule(self, source: str, destination: str) -> Subscription | None:
        return self._rules.get((source, destination))

    def restore(
        self,
        rules: Iterable[Subscription],
        topics: dict[str, str],
        live: dict[str, float],
        structures: dict[str, str],
    ) -> None:
        """Fill an empty topology with what a database remembers."""
        for rule in rules:
            self._add(rule)
        self.topics.update(topics)
        self.live.update(live)
        self.structures.update(structures)
        self._described = sum(map(len, (*self.topics.values(), *self.structures.values())))

    # --- inside

    def _add(self, rule: Subscription) -> None:
        pair = rule.source, rule.destination
        self._rules[pair] = rule
        self._out.setdefault(pair[0], {})[pair[1]] = rule
        self._in.setdefault(pair[1], {})[pair[0]] = rule

    def _pairs(self, name: str) -> Iterator[tuple[str, str, str]]:
        """Source, destination, carrier of every connection that rules ask for at `name`."""
        seen = set()
        rules = [*self._out.get(name, {}).values(), *self._in.get(name, {}).values()]
        for rule in rules:
            for pair in self._joined(rule):
                if name in pair[:2] and pair not in seen:
                    seen.add(pair)
                    yield pair

    def _joined(self, rule: Subscription) -> Iterator[tuple[str, str, str]]:
        """The connections one rule takes part in: itself, or its combinations over a topic."""
        if rule.destination in self.topics:
            for onward in self._out.get(rule.destination, {}).values():
                yield rule.source, onward.destination, onward.carrier
        elif rule.source in self.topics:
            for before in self._in.get(rule.source, {}).values():
                yield before.source, rule.destination, rule.carrier
        else:
            yield rule.source, rule.destination, rule.carrier

    def _through(self, topic: str) -> Iterator[tuple[str, str, str]]:
        for rule in self._in.get(topic, {}).values():
            yield from self._joined(rule)

    def _both_live(self, pair: tuple[str, str, str]) -> bool:
        return pair[0] in self.live and pair[1] in self.live

    def _changed(self, kind: str, key: str) -> None:
        if self.on_change is not None:
            self.on_change(kind, key)


def _check(name: str, structure: str = "") -> None:
    if len(name) > LONGEST_NAME:
        raise AddressError(f"a name is at most {LONGEST_NAME} characters long")
    if "\0" in name:
        raise AddressError("a port or topic name cannot hold a NUL character")
    if len(structure) > LONGEST_STRUCTURE:
        raise AddressError(f"a description is at most {LONGEST_STRUCTURE} characters long")


def _connect(source: str, destination: str, carrier: str) -> Action:
    return Action("connect", source, destination, carrier, source)
