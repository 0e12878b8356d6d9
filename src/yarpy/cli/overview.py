"""The table behind `yarpy stats`: every connection of the network, once or again and again.

Rules: rates between two looks are counted, not smoothed, so the first look takes them from the
ports. Names are never cut or folded: on a narrow terminal the least important columns are left out
instead, and `--wide` shows them all wherever they go. With `--json` there is no table.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from dataclasses import asdict
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from yarpy.cli.output import print_json, print_line
from yarpy.cli.signals import Interrupted
from yarpy.log import readable
from yarpy.network.sampling import Sampler
from yarpy.network.traffic import End, Flow
from yarpy.route import parse_carrier

if TYPE_CHECKING:
    from rich.text import Text

PERIOD: Final = 1.0  # seconds between looks


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
DROPS: Final = "drops"
NOBODY: Final = "(past)"  # connections that have ended, and what was written without any
GAP: Final = "  "


class Overview:
    """The connections at the last look."""

    def __init__(self) -> None:
        self.flows: list[Flow] = []
        self._sampler = Sampler()

    def look(self) -> None:
        """Ask all ports."""
        self.flows = list(self._sampler.look().flows.values())

    def close(self) -> None:
        """Hang up."""
        self._sampler.close()

    def rows(self, wide: bool) -> list[tuple[str, ...]]:
        """What the table shows. That somebody writes while nobody listens is no trouble."""
        return [self._row(flow) for flow in self.flows if wide or flow.target or flow.drops]

    def _row(self, flow: Flow) -> tuple[str, ...]:
        monitors = [
            f"{one}{_state(end)}"
            for end in (flow.sender, flow.receiver)
            if end
            for one in end.monitors
        ]
        return (
            flow.source,
            flow.target or NOBODY,
            parse_carrier(flow.carrier).base if flow.target else "",
            _number(flow.measured("messages"), 0),
            _number(flow.rate, 1),
            _number(flow.speed, 2, 1e-6),
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

    def as_json(self) -> list[dict[str, Any]]:
        """All that is known, for programs."""
        found = []
        for flow in self.flows:
            found.append(
                {
                    "source": flow.source,
                    "target": flow.target,
                    "carrier": flow.carrier,
                    "messages_per_second": flow.rate,
                    "bytes_per_second": flow.speed,
                    "drops": flow.drops,
                    "missed": flow.missed,
                    "sender": flow.sender and asdict(flow.sender),
                    "receiver": flow.receiver and asdict(flow.receiver),
                }
            )
        return found


def show(watch: bool, as_json: bool, wide: bool) -> int:
    """The command without PORT."""
    overview = Overview()
    try:
        return _show(overview, watch, as_json, wide)
    finally:
        overview.close()


def _show(overview: Overview, watch: bool, as_json: bool, wide: bool) -> int:
    overview.look()
    if as_json:
        return _repeat(overview, watch, lambda: print_json(overview.as_json()))
    if not sys.stdout.isatty():
        return _repeat(overview, watch, lambda: _print_lines(overview, wide))
    from rich.console import Console
    from rich.live import Live

    console = Console()
    if not watch:
        console.print(_text(overview, console.width, wide), soft_wrap=True)
        return 0
    with Live(console=console, auto_refresh=False, screen=True) as live:
        return _repeat(
            overview, True, lambda: live.update(_text(overview, console.width, wide), refresh=True)
        )


def _repeat(overview: Overview, watch: bool, tell: Callable[[], None]) -> int:
    try:
        tell()
        while watch:
            time.sleep(PERIOD)
            overview.look()
            tell()
    except Interrupted:
        pass  # how watching ends
    return 0


def _print_lines(overview: Overview, wide: bool) -> None:
    for cells in layout(overview.rows(wide), None, wide):
        print_line(GAP.join(text for text, _ in cells).rstrip())


def layout(
    rows: list[tuple[str, ...]], width: int | None, wide: bool
) -> list[list[tuple[str, Column]]]:
    """The title line and the rows, as cells padded to their columns.

    As many columns as `width` characters hold; all of them if it is None and `wide`.
    """
    rows = [tuple(map(readable, row)) for row in rows]
    cells = [tuple(column.title for column in COLUMNS), *rows]
    widths = [max(len(row[n]) for row in cells) for n in range(len(COLUMNS))]
    shown = [n for n, column in enumerate(COLUMNS) if wide or not column.wide]
    if width is not None and not wide:
        for n in sorted(shown, key=lambda n: -COLUMNS[n].rank):
            if sum(widths[m] + len(GAP) for m in shown) - len(GAP) <= width or not COLUMNS[n].rank:
                break
            shown.remove(n)
    return [
        [
            (row[n].rjust(widths[n]) if COLUMNS[n].numeric else row[n].ljust(widths[n]), COLUMNS[n])
            for n in shown
        ]
        for row in cells
    ]


def _text(overview: Overview, width: int, wide: bool) -> Text:
    """The table for a terminal: drops stand out."""
    from rich.text import Text

    whole = Text(no_wrap=True)
    for number, cells in enumerate(layout(overview.rows(wide), width, wide)):
        for text, column in cells:
            dropped = number and column.title == DROPS and text.strip() not in ("", "0")
            whole.append(text, "bold" if not number else "bold red" if dropped else "")
            whole.append(GAP)
        whole.append("\n")
    if not overview.rows(wide):
        whole.append("no connections\n")
    whole.rstrip()
    return whole


def _number(value: float | None, digits: int, scale: float = 1.0) -> str:
    return "" if value is None else f"{value * scale:.{digits}f}"


def _pair(flow: Flow, spell: Any) -> str:
    """What both ends have, once if they have the same."""
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
