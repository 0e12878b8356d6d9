"""The screen of `yarpy top`: what of a Snapshot is shown, in which order, and what keys do.

Rules: pure; a terminal is written to elsewhere. A line is never longer than the screen is wide:
what does not fit is cut in the middle of the longest name, since both its ends tell ports apart.
"""

from __future__ import annotations

import fnmatch
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from yarpy.cli import overview
from yarpy.cli.overview import DROPS, GAP, Cells, Column, Row
from yarpy.log import readable
from yarpy.network.traffic import Flow, Snapshot

if TYPE_CHECKING:
    from rich.text import Text

SORTS: Final = ("rate", "speed", "drops", "missed", "latency", "jitter", "name")
KEYS: Final = "q quit  s sort  r reverse  p ports  / filter  space pause"
LEAST: Final = 8  # characters that are left of a name


@dataclass
class View:
    """The view that the user has chosen: order, filter, and what is shown."""

    sort: str = "rate"
    reverse: bool = False
    filter: str = ""
    ports: bool = False
    paused: bool = False
    typing: bool = False  # the filter is being typed
    over: bool = False

    def press(self, key: str) -> None:
        """Carry out what a key stands for."""
        if self.typing:
            self._type(key)
        elif key in ("q", "\x03", "\x04"):
            self.over = True
        elif key == "s":
            self.sort = SORTS[(SORTS.index(self.sort) + 1) % len(SORTS)]
        elif key == "r":
            self.reverse = not self.reverse
        elif key == "p":
            self.ports = not self.ports
        elif key == " ":
            self.paused = not self.paused
        elif key == "/":
            self.typing, self.filter = True, ""

    def _type(self, key: str) -> None:
        if key in ("\r", "\n"):
            self.typing = False
        elif key == "\x1b":
            self.typing, self.filter = False, ""
        elif key in ("\x7f", "\b"):
            self.filter = self.filter[:-1]
        elif key.isprintable() and len(self.filter) < 200:
            self.filter += key


def matches(pattern: str, *names: str) -> bool:
    """Return whether one of the names contains the pattern, or matches it where that has
    wildcards."""
    if any(letter in pattern for letter in "*?["):
        return any(fnmatch.fnmatchcase(name, pattern) for name in names)
    return any(pattern in name for name in names)


def ordered(flows: Sequence[Flow], sort: str, reverse: bool = False) -> list[Flow]:
    """The largest first, and what is not known last; names in their order."""
    if sort == "name":
        return sorted(flows, key=lambda flow: (flow.source, flow.target), reverse=reverse)

    def value(flow: Flow) -> float | None:
        known: Any = (
            getattr(flow, sort)
            if sort in ("rate", "speed", "drops", "missed")
            else flow.measured(sort)
        )
        return known if isinstance(known, int | float) else None

    known = [flow for flow in flows if value(flow) is not None]
    known.sort(key=lambda flow: value(flow) or 0.0, reverse=not reverse)
    return [*known, *(flow for flow in flows if value(flow) is None)]


def selected(snapshot: Snapshot, view: View) -> tuple[list[Row], Sequence[Column]]:
    """The rows of the table that is wanted, and its columns."""
    if view.ports:
        ports = [
            port
            for port in snapshot.ports.values()
            if matches(view.filter, port.name, port.contact.host, port.program)
        ]
        ports.sort(key=lambda port: port.name, reverse=view.reverse)
        return overview.port_rows(snapshot, ports), overview.PORTS
    flows = [
        flow
        for flow in overview.shown(snapshot, False)
        if matches(view.filter, flow.source, flow.target)
    ]
    return [overview.row(flow) for flow in ordered(flows, view.sort, view.reverse)], (
        overview.COLUMNS
    )


def head(snapshot: Snapshot, view: View, seconds: float) -> str:
    """The first line: how much there is, and what it costs to ask."""
    answering = sum(port.state == "answers" for port in snapshot.ports.values())
    flows = [flow for flow in snapshot.flows.values() if flow.target]
    rate = sum(flow.rate or 0.0 for flow in flows)
    speed = sum(flow.speed or 0.0 for flow in flows)
    sort = "name" if view.ports else view.sort
    noun = "connection" if len(flows) == 1 else "connections"
    words = [
        f"{answering} of {len(snapshot.ports)} ports answer, {len(flows)} {noun}",
        f"{rate:.0f} msg/s, {speed / 1e6:.1f} MB/s",
        f"by {sort}{' reversed' if view.reverse else ''}",
    ]
    if view.paused:
        words.append("paused")
    words.append(f"asked in {seconds * 1e3:.0f} ms")  # what a narrow screen may cut
    return readable(" | ".join(words))


def text(snapshot: Snapshot, view: View, width: int, height: int, seconds: float) -> Text:
    """The whole screen: drops stand out, and nothing is longer or higher than it is."""
    from rich.text import Text

    rows, columns = selected(snapshot, view)
    room = max(height - 3, 1)
    laid = fitted(overview.layout(rows[:room], width, False, columns), width)
    whole = Text(no_wrap=True, end="")
    whole.append(head(snapshot, view, seconds)[:width] + "\n", "dim")
    for number, cells in enumerate(laid):
        for place, (shown, column) in enumerate(cells):
            wrong = number and (
                (column.title in (DROPS, "missed") and shown.strip() not in ("", "0"))
                or (column.title == "state" and shown.strip() not in ("answers", "foreign"))
            )
            whole.append(GAP if place else "")
            whole.append(shown, "bold" if not number else "bold red" if wrong else "")
        whole.append("\n")
    left = len(rows) - room
    last = f"/{view.filter}_" if view.typing else KEYS
    if view.filter and not view.typing:
        last = f"/{view.filter}  {last}"
    if left > 0:
        last = f"{left} more  {last}"
    whole.append(readable(last)[:width], "dim")
    return whole


def fitted(laid: list[Cells], width: int) -> list[Cells]:
    """A table that is too wide, with its widest column of text cut."""
    while laid and (over := len(GAP.join(shown for shown, _ in laid[0])) - width) > 0:
        texts = [n for n, (_, column) in enumerate(laid[0]) if not column.numeric]
        widest = max(texts, key=lambda n: len(laid[0][n][0]), default=None)
        if widest is None or len(laid[0][widest][0]) <= LEAST:
            return [_cut_line(cells, width) for cells in laid]
        others = sorted((len(laid[0][n][0]) for n in texts if n != widest), reverse=True)
        size = len(laid[0][widest][0])
        goal = max(size - over, min(others[0] if others else 0, size - 1), LEAST)
        for cells in laid:
            shown, column = cells[widest]
            cells[widest] = shortened(shown.rstrip(), goal).ljust(goal), column
    return laid


def _cut_line(cells: Cells, width: int) -> Cells:
    """Cut a line that does not fit; on a screen where nothing fits, what comes first is shown."""
    left: Cells = []
    for shown, column in cells:
        room = width - sum(len(one) + len(GAP) for one, _ in left)
        if room <= 0:
            break
        left.append((shown[:room], column))
    return left


def shortened(name: str, size: int) -> str:
    """A name with its middle left out.

    >>> shortened("/icub/left_arm/state:o", 12)
    '/icub/…ate:o'
    """
    if len(name) <= size:
        return name
    head = size // 2
    return f"{name[:head]}…{name[len(name) - (size - head - 1) :]}" if size > 1 else name[:size]
