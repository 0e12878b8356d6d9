"""The screen of `yarpy up` and the lines of `yarpy status`.

Rules: pure; a terminal is written to elsewhere. No line is wider than the screen; what is wrong
stands out, and what does not fit is counted.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final

from yarpy.log import readable

if TYPE_CHECKING:
    from rich.text import Text

KEYS: Final = "^C stops all"
_STYLES: Final = {
    "running": "green",
    "connected": "green",
    "failed": "bold red",
    "refused": "bold red",
    "pausing": "yellow",
    "waiting": "yellow",
    "stopping": "yellow",
    "unknown": "bold red",
}
_TITLES: Final = ("name", "state", "host", "cpu", "memory", "last line")
_NAME: Final = 20  # letters of the longest name that is shown whole
_STATE: Final = 9
_HOST: Final = 10
_CPU: Final = 6
_MEMORY: Final = 8


def size(count: int | None) -> str:
    """Return bytes as people read them.

    >>> size(12_300_000)
    '12.3 MB'
    """
    if count is None:
        return ""
    for unit, step in (("GB", 1e9), ("MB", 1e6), ("kB", 1e3)):
        if count >= step:
            return f"{count / step:.1f} {unit}"
    return f"{count} B"


def lines(status: dict[str, Any], width: int, height: int) -> list[tuple[str, str]]:
    """Return what is shown, each line with its style, no more than `height` of them."""
    programs: Sequence[dict[str, Any]] = status["programs"]
    links: Sequence[dict[str, Any]] = status["connections"]
    up = sum(one["state"] == "running" for one in programs)
    joined = sum(one["state"] == "connected" for one in links)
    head = f"{readable(status['application'])}: {up} of {len(programs)} programs run"
    if links:
        head += f", {joined} of {len(links)} connections"
    found = [(head[:width], "bold")]
    widest = max((len(one["name"]) for one in programs), default=4)
    first = min(max(widest, 4), _NAME)
    hosts = any(one["host"] != "here" for one in programs)
    found.append((_row(_TITLES, first, hosts, width), "dim"))
    order = sorted(programs, key=lambda one: one["state"] not in ("failed", "pausing", "unknown"))
    odd = [one for one in links if one["state"] != "connected"]
    room = max(height - 3, 1)
    shown = order[: max(room - min(len(odd), room // 3), 1)]
    for one in shown:
        last = one["detail"] if one["state"] != "running" and one["detail"] else one["line"]
        cpu = "" if one["cpu"] is None else f"{one['cpu']:.0f} %"
        cells = (one["name"], one["state"], one["host"], cpu, size(one["memory"]), last)
        style = _STYLES.get(one["state"], "dim")
        found.append((_row(cells, first, hosts, width), "" if style == "green" else style))
    room -= len(shown)
    for one in odd[: max(room, 0)]:
        text = f"{one['from']} -> {one['to']}  {one['state']} {one['detail']}"
        found.append((readable(text)[:width], _STYLES.get(one["state"], "dim")))
    hidden = len(programs) - len(shown) + max(len(odd) - max(room, 0), 0)
    if hidden:
        found.append((f"{hidden} more"[:width], "dim"))
    return found


def _row(cells: Sequence[str], first: int, hosts: bool, width: int) -> str:
    name, state, host, cpu, memory, last = (readable(one) for one in cells)
    parts = [_cut(name, first).ljust(first), state.ljust(_STATE)]
    if hosts:
        parts.append(_cut(host, _HOST).ljust(_HOST))
    parts += [cpu.rjust(_CPU), memory.rjust(_MEMORY)]
    row = " ".join(parts)
    room = width - len(row) - 2
    return f"{row}  {last[:room]}".rstrip() if room > 4 else row[:width]


def text(
    status: dict[str, Any], news: Sequence[str], width: int, height: int, keys: str = KEYS
) -> Text:
    """Return the whole screen; `keys` is its last line."""
    from rich.text import Text

    whole = Text(no_wrap=True, end="")
    told = [readable(one)[:width] for one in news[-3:]] if height > 12 else []
    for line, style in lines(status, width, height - len(told) - 1):
        whole.append(line + "\n", style)
    for one in told:
        whole.append(one + "\n", "dim")
    whole.append(keys[:width], "dim")
    return whole


def _cut(name: str, room: int) -> str:
    """Return at most `room` letters of a name: both its ends tell programs apart."""
    if len(name) <= room:
        return name
    head = (room - 1) // 2
    return f"{name[:head]}…{name[len(name) - (room - head - 1) :]}"
