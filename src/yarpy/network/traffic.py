"""Traffic: what is known of a network at one moment - its ports, its connections, their counters.

Rules: plain values; who asks for them is `sampling`. What a port says of itself was written by a
stranger: numbers are finite or None, texts have a limit, and whatever else comes is passed over.
C++ ports report to whom they send, over what, and with which priority; what they do not count is
None.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any, Final, Literal, TypeAlias

from yarpy.contact import Contact
from yarpy.data.bottle import Bottle, Property
from yarpy.data.text import plain_text
from yarpy.limit import SAMPLE_ITEMS
from yarpy.network.dialled import address_in, leads_to
from yarpy.qos import Qos

LONGEST: Final = 1000  # characters of a text that a port says

#: `answers`; `refused`: nobody listens there; `silent`: somebody does, and says nothing;
#: `unreachable`: no way there; `denied`: it does not let us ask; `other`: what answers is no port
#: that can be asked, or another one; `foreign`: of another system, which is not asked
State: TypeAlias = Literal[
    "answers", "refused", "silent", "unreachable", "denied", "other", "foreign"
]


@dataclass(slots=True)
class End:
    """A connection as one of its ports sees it; None: that port does not count it.

    `rate` is in messages per second, `jitter` and `latency` (until a reply) in seconds. Of a
    sender: messages `unacknowledged` now. Of a receiver: messages `delivered` to the program,
    `waiting` for it now (of all connections), `lost` on the way; `failure`: why the program could
    not use one. `dropped`: by monitors, by their names, with their `failures`. `asked`: priorities
    that are not what the system does; `timing`: what is expected, and how many deadlines were
    `missed`.
    """

    carrier: str = ""
    messages: int | None = None
    bytes: int | None = None
    replaced: int | None = None
    drops: int | None = None
    unconfirmed: int | None = None
    unconnected: int | None = None
    unacknowledged: int | None = None
    delivered: int | None = None
    waiting: int | None = None
    lost: int | None = None
    rate: float | None = None
    jitter: float | None = None
    latency: float | None = None
    failure: str = ""
    qos: Qos = field(default_factory=Qos)
    asked: dict[str, Any] = field(default_factory=dict)
    timing: dict[str, Any] = field(default_factory=dict)
    monitors: list[str] = field(default_factory=list)
    dropped: dict[str, int] = field(default_factory=dict)
    failures: dict[str, str] = field(default_factory=dict)
    parameters: dict[str, Any] = field(default_factory=dict)
    state: dict[str, Any] = field(default_factory=dict)


@dataclass(slots=True)
class Flow:
    """A connection of two ports, as the sender and the receiver see it.

    Without a target: what the sender dropped on connections that have ended, and what it wrote
    while it had none (`unconnected`). `rate` (1/s) and `speed` (bytes/s) are counted between two
    looks; after the first one they are what the ports say, or None.
    """

    source: str
    target: str
    sender: End | None = None
    receiver: End | None = None
    rate: float | None = None
    speed: float | None = None

    @property
    def carrier(self) -> str:
        """Its protocol with all modifiers."""
        ends = [end.carrier for end in (self.sender, self.receiver) if end is not None]
        return max(ends, key=len, default="")

    @property
    def drops(self) -> int | None:
        """Messages that either side lost, or a monitor dropped."""
        counted = [e.drops for e in (self.sender, self.receiver) if e and e.drops is not None]
        return sum(counted) if counted else None

    @property
    def replaced(self) -> int | None:
        """Messages that gave way to newer ones on either side, as those who wait for nobody want
        it."""
        counted = [e.replaced for e in (self.sender, self.receiver) if e and e.replaced is not None]
        return sum(counted) if counted else None

    @property
    def missed(self) -> int | None:
        """Deadlines that were missed; None where there is none."""
        return _count(self.receiver.timing.get("missed")) if self.receiver is not None else None

    def measured(self, key: str) -> Any:
        """`messages`, `bytes`, `rate`, `jitter` or `latency`, from the side that knows it."""
        for end in (self.sender, self.receiver):
            value = getattr(end, key, None)
            if value:
                return value
        return getattr(self.sender or self.receiver, key, None)


@dataclass(slots=True)
class PortState:
    """A registered name, and what was found there.

    `ours`: it is a port of yarpy, which counts; None: not known. `answer_time` in seconds.
    `program` is the command line, `pid` 0 if it is not told. `error` says why there is no answer.
    """

    name: str
    contact: Contact
    state: State = "foreign"
    error: str = ""
    ours: bool | None = None
    answer_time: float | None = None
    pid: int = 0
    program: str = ""
    host: str = ""
    type: str = ""
    is_rpc: bool = False


@dataclass(slots=True)
class Snapshot:
    """A network at `time` (seconds since 1970): ports by name, flows by source and target."""

    time: float
    ports: dict[str, PortState] = field(default_factory=dict)
    flows: dict[tuple[str, str], Flow] = field(default_factory=dict)

    def add(self, port: str, told: Iterable[tuple[str, str, str, End]]) -> None:
        """Take in what `port` says of its connections; what it says of those of others is passed
        over."""
        for side, source, target, end in told:
            if port not in (source, target):
                continue
            flow = self.flows.get((source, target))
            if flow is None:
                flow = self.flows[source, target] = Flow(source, target)
            if side == "out" if source == target else source == port:
                flow.sender = end
            else:
                flow.receiver = end

    def unite(self) -> None:
        """Join what the two ends tell of a connection that one of them dialled by address and so
        calls by that: it goes by the names of both, where these are certain."""
        strange = [key for key in self.flows if address_in(key[0]) or address_in(key[1])]
        if not strange:
            return
        places: dict[int, list[PortState]] = {}
        for state in self.ports.values():
            places.setdefault(state.contact.port, []).append(state)
        for key in strange:
            named, one = self._named(key, places), self.flows[key]
            known = self.flows.get(named) or Flow(*named)
            if named == key or (known.sender and one.sender) or (known.receiver and one.receiver):
                continue
            del self.flows[key]
            sender, receiver = known.sender or one.sender, known.receiver or one.receiver
            self.flows[named] = Flow(*named, sender, receiver)

    def _named(self, key: tuple[str, str], places: dict[int, list[PortState]]) -> tuple[str, str]:
        """A connection by the names of its ends, as far as these are known."""
        for place, peer in enumerate(key):
            address, other = address_in(peer), self.ports.get(key[1 - place])
            if address is None or other is None:
                continue
            names = [
                state.name
                for state in places.get(address.port, ())
                if leads_to(address, state.contact, other.contact.host)
            ]
            keys = [(name, key[1]) if place == 0 else (key[0], name) for name in names]
            found = [one for one in keys if one in self.flows] or keys
            if len(found) == 1:
                return found[0]
        return key


# --- reading what ports say


def read(told: Property) -> tuple[str, str, End]:
    """One connection in the answer to [stat]: source, target and counters."""
    names = [_text(one) for one in _list(told.get("monitors"))]
    numbers: dict[str, Any] = {key: _count(told.get(key)) for key in _COUNTED}
    numbers.update({key: _number(told.get(key)) for key in ("rate", "jitter", "latency")})
    found = End(
        _text(told.get("carrier", "")),
        **numbers,
        failure=_text(told.get("failure", "")),
        qos=_qos(told),
        asked=_dict(told.get("asked")),
        timing=_dict(told.get("timing")),
        monitors=names,
        parameters=_dict(told.get("parameters")),
        state=_dict(told.get("state")),
    )
    _read_drops(found, names, told.get("dropped"), told.get("failures"))
    own = told.get("port_monitor")
    if own is not None:
        shown = [f"{_text(own)} of the port"]
        _read_drops(found, shown, [told.get("port_dropped")], told.get("port_failures"))
    return _text(told.get("source", "")), _text(told.get("target", "")), found


def read_port(state: PortState, reply: Bottle) -> None:
    """The answer of a port to `prop get` of its own name, put into `state`."""
    process, platform, port = (
        _dict(Property.from_bottle(reply).get(key)) for key in ("process", "platform", "port")
    )
    state.pid = _count(process.get("pid")) or 0
    words = (_text(process.get(key, "")) for key in ("name", "arguments"))
    state.program = " ".join(filter(None, words))
    state.host = _text(platform.get("hostname", ""))
    state.type = _text(port.get("type", ""))
    state.is_rpc = bool(_count(port.get("is_rpc")))


def side_of(told: Property) -> str:
    """`in` or `out`."""
    return _text(told.get("side", ""))


def pairs(item: Any) -> Bottle:
    """The `(key value)` lists of a connection, which may already be a dict."""
    if isinstance(item, dict):
        return Bottle([key, value] for key, value in item.items())
    return item if isinstance(item, Bottle) else Bottle(_list(item))


_COUNTED: Final = (
    *("messages", "bytes", "replaced", "drops", "unconfirmed", "unconnected", "unacknowledged"),
    *("delivered", "waiting", "lost"),
)


def _read_drops(end: End, names: list[str], counts: Any, failures: Any) -> None:
    for name, count in zip(names, _list(counts), strict=False):
        end.dropped[name] = _count(count) or 0
    for name, failure in zip(names, _list(failures), strict=False):
        if failure:
            end.failures[name] = _text(failure)


def _text(value: Any) -> str:
    return plain_text(value)[:LONGEST] if isinstance(value, str) else ""


def _list(value: Any) -> list[Any]:
    return list(value[:SAMPLE_ITEMS]) if isinstance(value, list | tuple) else []


def _count(value: Any) -> int | None:
    return value if isinstance(value, int) and not isinstance(value, bool) else None


def _number(value: Any) -> float | None:
    if not isinstance(value, int | float) or not math.isfinite(value):
        return None
    return float(value)


def _dict(told: Any) -> dict[str, Any]:
    return dict(Property.from_bottle(pairs(told))) if told else {}


def _qos(told: Property) -> Qos:
    """Priorities; what no system has is none."""
    packets = told.get("packets")
    text = str(packets) if packets is not None else "None"
    try:
        return Qos(
            told.get("policy"),
            _count(told.get("priority")),
            None if text == "None" else int(text) if text.isdigit() else text,
        )
    except (ValueError, AttributeError, TypeError):
        return Qos()


__all__ = ["End", "Flow", "PortState", "Snapshot", "State", "pairs", "read", "read_port", "side_of"]
