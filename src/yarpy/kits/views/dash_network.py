"""The network as its page is told of it: ports, connections, numbers, and what has happened.

Rules: pure; snapshots come in, JSON goes out. Names and places go out only when they are others
than in `version`; the numbers of each second are lists in the same order. One answer is made for
all browsers. What strangers say of themselves is text with a limit.
"""

from __future__ import annotations

import json
import math
from collections import deque
from collections.abc import Iterable
from typing import Any, Final

from yarpy.network.peek import NAME
from yarpy.network.traffic import End, Flow, PortState, Snapshot

MOST_PORTS: Final = 5000
MOST_LINKS: Final = 20_000
KEPT: Final = 500  # events
AT_ONCE: Final = 20  # events told of one look
LONGEST: Final = 300  # characters of a text

_LIGHTS: Final = {"answers": 1, "refused": -1, "foreign": None}
_WORDS: Final = {
    "answers": "alive",
    "refused": "gone: nobody listens there; yarpy clean removes such names",
    "silent": "silent: its program is stopped, or very busy",
    "foreign": "not asked: no port of YARP",
}

Key = tuple[str, str]


class View:
    """The network as pages see it."""

    def __init__(self) -> None:
        self.snapshot: Snapshot | None = None
        self._version = 0
        self._shape: list[Any] = []
        self._structure = ""
        self._numbers = '"states":[],"numbers":[]'
        self._drops: dict[Key, int] = {}
        self._dropping: set[Key] = set()
        self._states: dict[str, str] = {}
        self._links: set[Key] = set()
        self._more = 0
        self._events: deque[tuple[int, float, str]] = deque(maxlen=KEPT)
        self._last = 0  # number of the newest event
        self.problem = "asking the ports ..."

    def take(self, snapshot: Snapshot) -> None:
        """Take a new snapshot of the network."""
        before, self.snapshot = self.snapshot, snapshot
        passed = snapshot.time - before.time if before else 0.0
        flows = [one for one in snapshot.flows.values() if one.target not in ("", NAME)]
        flows = flows[:MOST_LINKS]
        names = {name for flow in flows for name in (flow.source, flow.target)}
        states = [*snapshot.ports.values()][:MOST_PORTS]
        self._more = max(0, len(snapshot.ports) - MOST_PORTS)
        strangers = sorted(names - snapshot.ports.keys())
        ports = [*map(_port, states), *map(_stranger, strangers)]
        links = [[cut(flow.source), cut(flow.target), cut(flow.carrier)] for flow in flows]
        shape = [ports, links]
        if shape != self._shape:
            self._shape = shape
            self._version += 1
            structure = json.dumps({"ports": ports, "links": links})
            self._structure = f"{structure[1:-1]},"
        drops = {(flow.source, flow.target): flow.drops for flow in flows}
        rates = {
            key: (count - self._drops[key]) / passed
            for key, count in drops.items()
            if count is not None and key in self._drops and passed > 0
        }
        self._tell(states, flows, {key for key, rate in rates.items() if rate > 0}, before is None)
        self._drops = {key: count for key, count in drops.items() if count is not None}
        told = [[*_state(state)] for state in states]
        told += [[None, "not registered"] for _ in strangers]
        numbers = [_numbers(flow, rates.get((flow.source, flow.target))) for flow in flows]
        self._numbers = json.dumps({"states": told, "numbers": numbers})[1:-1]
        self.problem = ""

    def told(self, since: int, event: int, undo: str) -> str:
        """JSON for a page that has the names of version `since`, and the events up to `event`."""
        structure = "" if since == self._version else self._structure
        if not 0 <= event <= self._last:
            event = 0  # of another program
        rest = {
            "version": self._version,
            "events": [one for one in self._events if one[0] > event],
            "problem": self.problem,
            "more": self._more,
            "undo": undo,
        }
        return f"{{{structure}{self._numbers},{json.dumps(rest)[1:]}"

    def happened(self, text: str) -> None:
        """Remember an event."""
        self._last += 1
        moment = self.snapshot.time if self.snapshot else 0.0
        self._events.append((self._last, moment, cut(text)))

    def _tell(
        self, states: list[PortState], flows: list[Flow], dropping: set[Key], first: bool
    ) -> None:
        """Log the differences from the snapshot before."""
        found: dict[str, str] = {state.name: state.state for state in states}
        links = {(flow.source, flow.target) for flow in flows}
        if not first:
            old = self._states
            self._some(f"{name} appears" for name in found if name not in old)
            self._some(f"{name} is closed" for name in old if name not in found)
            self._some(
                f"{name}: {_state(state)[1]}"
                for state in states
                if (name := state.name) in old and old[name] != state.state
            )
            self._some(f"{a} → {b}: connected" for a, b in sorted(links - self._links))
            self._some(f"{a} → {b}: disconnected" for a, b in sorted(self._links - links))
            self._some(f"{a} → {b}: drops messages" for a, b in sorted(dropping - self._dropping))
        self._states, self._links, self._dropping = found, links, dropping

    def _some(self, texts: Iterable[str]) -> None:
        """Events of one kind, some of them if there are many."""
        found = list(texts)
        for text in found[:AT_ONCE]:
            self.happened(text)
        if len(found) > AT_ONCE:
            self.happened(f"... and {len(found) - AT_ONCE} more like this")


def cut(text: str) -> str:
    """A text of a length that a page bears."""
    return text if len(text) <= LONGEST else f"{text[:LONGEST]}..."


def _port(state: PortState) -> dict[str, Any]:
    return {
        "name": cut(state.name),
        "address": [state.contact.host, state.contact.port],
        "place": cut(state.host or state.contact.host),
        "program": cut(state.program),
        "process": state.pid,
        "ours": bool(state.ours),
        "image": state.type == "yarp/image",
    }


def _stranger(name: str) -> dict[str, Any]:
    """An end of a connection that is not registered."""
    shown = {"name": cut(name), "address": ["", 0], "place": "", "program": ""}
    return {**shown, "process": 0, "ours": False, "image": False}


def _state(state: PortState) -> tuple[int | None, str]:
    return _LIGHTS.get(state.state, 0), cut(_WORDS.get(state.state) or state.error or state.state)


def _numbers(flow: Flow, dropped: float | None) -> list[Any]:
    ends = [end for end in (flow.sender, flow.receiver) if end is not None]
    told = [
        flow.measured("messages"),
        flow.rate,
        flow.speed,
        flow.measured("latency"),
        flow.measured("jitter"),
        flow.drops,
        dropped,
        flow.missed,
        flow.replaced,
        _both(ends, _thread),
        _both(ends, lambda end: "" if end.qos.packets is None else str(end.qos.packets)),
        cut(", ".join(name for end in ends for name in end.monitors)),
    ]
    return [_short(value) if isinstance(value, float) else value for value in told]


def _short(value: float) -> float | None:
    """As many digits as are read."""
    return float(f"{value:.4g}") if math.isfinite(value) else None


def _both(ends: list[End], spell: Any) -> str:
    """Return the texts of both ends; only one where they are the same."""
    found = list(dict.fromkeys(text for end in ends if (text := spell(end))))
    return cut(" / ".join(found))


def _thread(end: End) -> str:
    policy = end.qos.policy
    if policy in (None, "SCHED_OTHER"):
        return ""
    return f"{str(policy).removeprefix('SCHED_')} {end.qos.priority}"
