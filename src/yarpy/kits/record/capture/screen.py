"""The screen of `yarpy record`: what comes from each port, and what does not.

Rules: pure; a terminal is written to elsewhere. No line is wider than the screen, and no more ports
are shown than it has room for: those that lose come first, then those that are waited for.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final

from yarpy.kits.record.capture.disk_space import size_text
from yarpy.kits.record.capture.loss import WORDS, numbers_of
from yarpy.kits.record.capture.queue import Count
from yarpy.log import readable

if TYPE_CHECKING:
    from rich.text import Text

KEYS: Final = "space pause   s new file   m mark   q stop"
SNAPSHOT_KEYS: Final = "space pause   s write the last seconds   m mark   q stop"
TITLES: Final = ("msg/s", "messages", "size", "lost", "missed", "left out", "replaced")
_WIDTH: Final = 10  # of a column of numbers
_LINES: Final = 5  # around the table


@dataclass
class Status:
    """A recorder at one moment. `seconds`: since it began; `rates`: messages a second."""

    file: str
    seconds: float
    size: int
    held: int
    memory: int
    free: int
    paused: bool
    counts: Mapping[str, Count]
    rates: Mapping[str, float]
    connected: Collection[str] = field(default_factory=set)
    waiting: Sequence[str] = ()
    news: str = ""
    snapshots: bool = False


@dataclass
class Rates:
    """Messages a second of each port, from one look to the next."""

    _counts: dict[str, int] = field(default_factory=dict)
    _time: float = 0.0

    def take(self, counts: Mapping[str, Count], now: float) -> dict[str, float]:
        """Return the rates since the last look; `now` in seconds of any clock."""
        passed = now - self._time
        found = {
            name: (count.messages - self._counts.get(name, 0)) / passed if self._time else 0.0
            for name, count in counts.items()
            if passed > 0
        }
        self._counts = {name: count.messages for name, count in counts.items()}
        self._time = now
        return found


def clock(seconds: float) -> str:
    """Return a duration as people read it.

    >>> clock(3725.4)
    '1:02:05'
    """
    minutes, rest = divmod(int(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{rest:02}"


def cut(name: str, size: int) -> str:
    """Return a name that is not longer than `size`: both its ends tell ports apart."""
    if len(name) <= size:
        return name
    head = (size - 1) // 2
    return f"{name[:head]}…{name[len(name) - (size - head - 1) :]}"


def text(status: Status, width: int, height: int) -> Text:
    """Return the whole screen, `width` letters wide."""
    from rich.text import Text

    whole = Text(no_wrap=True, end="")
    state = "paused" if status.paused else "keeping" if status.snapshots else "recording"
    keys = SNAPSHOT_KEYS if status.snapshots else KEYS
    head = f"{state} {clock(status.seconds)}"[:width]
    whole.append(head, "bold yellow" if status.paused else "bold green")
    room = width - len(head)
    whole.append((cut(f"  {readable(status.file)}", room) if room > 10 else "") + "\n")
    whole.append(_totals(status)[:width] + "\n", "dim")
    columns = max(1, min(len(TITLES), (width - 16) // _WIDTH))
    name_width = max(8, width - columns * _WIDTH)  # a screen that is narrower cuts numbers off
    head = "port".ljust(name_width) + "".join(one.rjust(_WIDTH) for one in TITLES[:columns])
    whole.append(head[:width] + "\n", "bold")
    rows = ordered(status)
    room = max(1, height - _LINES)
    for name, style in rows[:room]:
        line = cut(readable(name), name_width - 1).ljust(name_width)
        cells = _cells(status, name)[:columns]
        whole.append(f"{line}{''.join(one.rjust(_WIDTH) for one in cells)}"[:width] + "\n", style)
    if status.news:
        whole.append(cut(readable(status.news), width) + "\n", "yellow")
    more = f"{len(rows) - room} more ports   " if len(rows) > room else ""
    whole.append(f"{more}{keys}"[:width], "dim")
    return whole


def ordered(status: Status) -> list[tuple[str, str]]:
    """Return the ports in their order, each with the colour of its line."""
    losing = sorted(name for name, count in status.counts.items() if count.lost)
    waiting = [name for name in status.waiting if name not in losing]
    rest = sorted({*status.counts, *status.connected} - {*losing, *waiting})
    return [
        *((name, "bold red") for name in losing),
        *((name, "yellow") for name in waiting),
        *((name, "" if name in status.connected else "dim") for name in rest),
    ]


def _cells(status: Status, name: str) -> list[str]:
    count = status.counts.get(name)
    if count is None:
        return ["not there" if name in status.waiting else "silent"]
    rate = status.rates.get(name, 0.0)
    shown = (
        "gone" if name not in status.connected else f"{rate:.1f}" if rate < 100 else f"{rate:.0f}"
    )
    numbers = numbers_of(count)
    return [shown, str(count.messages), size_text(count.bytes), *map(str, numbers)]


def _totals(status: Status) -> str:
    messages = sum(count.messages for count in status.counts.values())
    lost = sum(count.lost for count in status.counts.values())
    words = [
        f"{messages} messages, {size_text(status.size)}",
        f"{lost} lost",
        f"{size_text(status.free)} left on the disk",
        f"{100 * status.held // max(status.memory, 1)} % of the memory",
    ]
    return " | ".join(words)


def summary(status: Status) -> list[str]:
    """Return the lines that are printed at the end."""
    found = [f"{status.file}: {clock(status.seconds)}, {_totals(status).split(' | ')[0]}"]
    for name, count in sorted(status.counts.items()):
        odd = [
            f"{number} {word}"
            for number, word in zip(numbers_of(count), WORDS, strict=True)
            if number
        ]
        tail = f" ({', '.join(odd)})" if odd else ""
        found.append(f"  {readable(name)}: {count.messages}{tail}")
    return found
