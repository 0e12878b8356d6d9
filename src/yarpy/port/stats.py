"""Counters of ports and connections, as programs see it.

Rules: values, taken at one moment; they do not change any more. `as_dict` gives plain data, for
JSON and tables, without what is not counted.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any


class _Plain:
    """The common part: they can be made plain data."""

    __slots__ = ()

    def as_dict(self) -> dict[str, Any]:
        """Return all numbers by name, as plain data; what is not counted is left out."""
        return {key: value for key, value in _plain(self).items() if value is not None}


@dataclass(frozen=True, slots=True)
class ConnectionStats(_Plain):
    """The counters of one end of a connection. Times in seconds; 0.0: not measured yet.

    messages, bytes: carried by this connection.
    replaced: messages that this side left out for newer ones.
    drops: messages that this side lost or a monitor dropped, or that did not get to the other side.
    unconfirmed: on their way when the connection broke: some may have arrived.
    rate: messages per second, now.
    period, jitter: smoothed time between messages, and its variation.
    latency: smoothed time from a question to its answer.
    since: when the connection was made, in seconds since 1970.
    unacknowledged: of an output: messages on their way, as far as is known; else None.
    missed: deadlines that were missed (`Qos(deadline=...)`); None without one.
    """

    source: str
    target: str
    carrier: str
    messages: int
    bytes: int
    replaced: int
    drops: int
    unconfirmed: int
    rate: float
    period: float
    jitter: float
    latency: float
    since: float
    unacknowledged: int | None = None
    missed: int | None = None


@dataclass(frozen=True, slots=True)
class RemoteStats(_Plain):
    """The counts that both ports of a connection tell: those of the sender, or of the receiver if
    only that one counts; `replaced` and `drops` are of both. None: not counted."""

    messages: int | None
    bytes: int | None
    rate: float | None
    jitter: float | None
    latency: float | None
    replaced: int | None
    drops: int | None


@dataclass(frozen=True, slots=True)
class Totals(_Plain):
    """Sums over connections that have ended; the names are those of ConnectionStats."""

    messages: int
    bytes: int
    replaced: int
    drops: int
    unconfirmed: int


@dataclass(frozen=True, slots=True)
class PastStats(_Plain):
    """The sums over the connections of a port that have ended."""

    inputs: Totals
    outputs: Totals


@dataclass(frozen=True, slots=True)
class PortStats(_Plain):
    """The counters of a port.

    inputs, outputs: of each connection.
    unconnected: messages that were written while nobody was connected.
    past: sums over connections that have ended.
    waiting: messages that came and were not read yet.
    """

    name: str
    inputs: list[ConnectionStats]
    outputs: list[ConnectionStats]
    unconnected: int
    past: PastStats
    waiting: int


def connection_stats(
    source: str, target: str, carrier: str, counted: Mapping[str, Any]
) -> ConnectionStats:
    """Return the stats of a connection of which `counted` has the numbers."""
    return ConnectionStats(source, target, carrier, **counted)


def port_stats(found: Mapping[str, Any]) -> PortStats:
    """Return the stats of a port, of which `found` is all that its hub has counted."""
    return PortStats(
        found["name"],
        [ConnectionStats(**one) for one in found["inputs"]],
        [ConnectionStats(**one) for one in found["outputs"]],
        found["unconnected"],
        PastStats(**{side: Totals(**sums) for side, sums in found["past"].items()}),
        found["waiting"],
    )


def _plain(value: Any) -> dict[str, Any]:
    found = asdict(value)
    for side in ("inputs", "outputs"):
        if isinstance(found.get(side), list):
            found[side] = [
                {key: number for key, number in one.items() if number is not None}
                for one in found[side]
            ]
    return found
