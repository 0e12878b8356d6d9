"""The table of connections and that of ports, which `yarpy stats` shows once and `yarpy top` live.

Rules: a table is made of a Snapshot and knows no terminal. On a narrow one the least important
columns are left out, and `wide` shows them all. Whatever strangers say is made readable.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import asdict
from typing import Any, Final, NamedTuple, TypeAlias

from yarpy.log import readable
from yarpy.network.traffic import End, Flow, PortState, Snapshot
from yarpy.route import parse_carrier


class Column(NamedTuple):
    """`rank` says when it goes: the highest first, 0 never."""

    title: str
    rank: int
    numeric: bool = False
    wide: bool = False  # shown with --wide only


COLUMNS: Final = (
    Column("from", 0),
    Column("to", 0),
    Column("carrier", 2),
    Column("messages", 0, numeric=True, wide=True),
    Column("msg/s", 1, numeric=True),
    Column("MB/s", 3, numeric=True),
    Column("replaced", 0, numeric=True, wide=True),
    Column("drops", 0, numeric=True),
    Column("missed", 0, numeric=True, wide=True),
    Column("unconfirmed", 0, numeric=True, wide=True),
    Column("unconnected", 0, numeric=True, wide=True),
    Column("jitter ms", 0, numeric=True, wide=True),
    Column("latency ms", 4, numeric=True),
    Column("thread", 0, wide=True),
    Column("packets", 0, wide=True),
    Column("monitors", 0, wide=True),
)
PORTS: Final = (
    Column("port", 0),
    Column("state", 0),
    Column("in", 2, numeric=True),
    Column("out", 2, numeric=True),
    Column("in/s", 0, numeric=True),
    Column("out/s", 0, numeric=True),
    Column("waiting", 4, numeric=True),
    Column("drops", 1, numeric=True),
    Column("answer ms", 5, numeric=True),
    Column("host", 3),
    Column("pid", 6, numeric=True),
    Column("program", 0, wide=True),
)
DROPS: Final = "drops"
NOBODY: Final = "(past)"  # connections that have ended, and what was written without any
GAP: Final = "  "

Row: TypeAlias = tuple[str, ...]
Cells: TypeAlias = list[tuple[str, Column]]


# --- connections


def shown(snapshot: Snapshot, wide: bool) -> list[Flow]:
    """The connections of the table. That somebody writes while nobody listens is no trouble."""
    return [flow for flow in snapshot.flows.values() if wide or flow.target or flow.drops]


def row(flow: Flow) -> Row:
    """A connection, in all columns."""
    monitors = [
        f"{one}{_state(end)}" for end in (flow.sender, flow.receiver) if end for one in end.monitors
    ]
    return (
        flow.source,
        flow.target or NOBODY,
        parse_carrier(flow.carrier).base if flow.target else "",
        _number(flow.measured("messages"), 0),
        _number(flow.rate, 1),
        _number(flow.speed, 2, 1e-6),
        _number(flow.replaced, 0),
        _number(flow.drops, 0),
        _number(flow.missed, 0),
        _number(flow.sender.unconfirmed if flow.sender else None, 0),
        _number(flow.sender.unconnected if flow.sender else None, 0),
        _number(flow.measured("jitter"), 2, 1e3),
        _number(flow.measured("latency"), 2, 1e3),
        _pair(flow, _thread),
        _pair(flow, _packets),
        ", ".join(monitors),
    )


def connections_json(snapshot: Snapshot) -> list[dict[str, Any]]:
    """Return what is known of each connection, for programs."""
    return [
        {
            "source": flow.source,
            "target": flow.target,
            "carrier": flow.carrier,
            "messages_per_second": flow.rate,
            "bytes_per_second": flow.speed,
            "replaced": flow.replaced,
            "drops": flow.drops,
            "missed": flow.missed,
            "sender": flow.sender and asdict(flow.sender),
            "receiver": flow.receiver and asdict(flow.receiver),
        }
        for flow in snapshot.flows.values()
    ]


# --- ports


def port_rows(snapshot: Snapshot, ports: Iterable[PortState]) -> list[Row]:
    """Ports, in all columns."""
    into: dict[str, list[Flow]] = {}
    out: dict[str, list[Flow]] = {}
    for flow in snapshot.flows.values():
        if flow.target:
            out.setdefault(flow.source, []).append(flow)
            into.setdefault(flow.target, []).append(flow)
    return [_port_row(port, into.get(port.name, []), out.get(port.name, [])) for port in ports]


def _port_row(port: PortState, into: list[Flow], out: list[Flow]) -> Row:
    waiting = [flow.receiver.waiting for flow in into if flow.receiver is not None]
    drops = [flow.drops for flow in (*into, *out) if flow.drops is not None]
    answers = port.state == "answers"
    return (
        port.name,
        port.state,
        str(len(into)) if answers else "",
        str(len(out)) if answers else "",
        _sum(into),
        _sum(out),
        _number(max((one for one in waiting if one is not None), default=None), 0),
        _number(sum(drops) if drops else None, 0),
        _number(port.answer_time if answers else None, 1, 1e3),
        port.contact.host,
        str(port.pid or ""),
        port.program,
    )


def _sum(flows: list[Flow]) -> str:
    rates = [flow.rate for flow in flows if flow.rate is not None]
    return _number(sum(rates) if rates else None, 1)


def ports_json(snapshot: Snapshot) -> list[dict[str, Any]]:
    """Return what is known of each port, for programs."""
    return [{**asdict(port), "contact": str(port.contact)} for port in snapshot.ports.values()]


# --- laying out


def layout(
    rows: Sequence[Row], width: int | None, wide: bool, columns: Sequence[Column] = COLUMNS
) -> list[Cells]:
    """The title line and the rows, as cells padded to their columns.

    As many columns as `width` characters hold; all of them if it is None and `wide`.
    """
    rows = [tuple(map(readable, row)) for row in rows]
    cells = [tuple(column.title for column in columns), *rows]
    widths = [max(len(row[n]) for row in cells) for n in range(len(columns))]
    left = [n for n, column in enumerate(columns) if wide or not column.wide]
    if width is not None and not wide:
        for n in sorted(left, key=lambda n: -columns[n].rank):
            if sum(widths[m] + len(GAP) for m in left) - len(GAP) <= width or not columns[n].rank:
                break
            left.remove(n)
    return [
        [
            (row[n].rjust(widths[n]) if columns[n].numeric else row[n].ljust(widths[n]), columns[n])
            for n in left
        ]
        for row in cells
    ]


def line(cells: Cells) -> str:
    """Cells as a line of text."""
    return GAP.join(text for text, _ in cells).rstrip()


def _number(value: float | None, digits: int, scale: float = 1.0) -> str:
    return "" if value is None else f"{value * scale:.{digits}f}"


def _pair(flow: Flow, spell: Any) -> str:
    """Return what both ends have, once if they have the same."""
    ends = [spell(end) if end is not None else "" for end in (flow.sender, flow.receiver)]
    return ends[0] if ends[0] == ends[1] else " / ".join(one or "-" for one in ends)


def _thread(end: End) -> str:
    policy = end.qos.policy
    if policy is None:
        return ""
    short = policy.removeprefix("SCHED_")
    return f"{short} {end.qos.priority}" if short != "OTHER" else short


def _packets(end: End) -> str:
    return "" if end.qos.packets is None else str(end.qos.packets)


def _state(end: End) -> str:
    """The parameters of an end's monitors and how they are doing, in short."""
    values = {**end.parameters, **end.state}
    told = " ".join(f"{key}={_short(value)}" for key, value in values.items() if value != "")
    return f" ({told})" if told else ""


def _short(value: object) -> str:
    return f"{value:.3g}" if isinstance(value, float) else str(value)
