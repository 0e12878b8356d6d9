"""LogPage: shows the log of the network in a browser, filtered, as it comes.

GET /          the page
GET /lines     ?since=NUMBER&most=COUNT&level=LEVEL&program=NAME&text=WORDS: the newest lines behind
               that number which are shown so, and what programs there are, as JSON

Rules: pure but for a lock; whoever takes lines hands them to `add`. So many are kept at most; the
oldest are forgotten. Words are looked for as they are, whatever their capitals: a pattern of a
stranger could take forever.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final

import yarpy
from yarpy.kits.launch.log.filter import program_of
from yarpy.kits.views.asset import jsonpage, site
from yarpy.port.base import BasePort
from yarpy.port.keep.log_line import LEVELS

if TYPE_CHECKING:
    from yarpy.port.keep.log_line import LogLine

KEPT: Final = 20_000  # lines
MOST: Final = 2000  # lines of one answer
PROGRAMS: Final = 500  # that can be chosen
_LONGEST: Final = 4000  # characters of a line that a page gets


class LogPage:
    """Shows on `port` the lines that `add` was given, `kept` of them."""

    def __init__(self, port: BasePort, kept: int = KEPT) -> None:
        self._lines: deque[tuple[int, LogLine]] = deque(maxlen=kept)
        self._programs: dict[str, None] = {}
        self._count = 0
        self._lock = threading.Lock()  # of these three
        self.lost = 0
        """Lines that came faster than they were taken."""
        pages = site("log", "log.css", room="yarpy.kits.launch.page", shared=("dash.css",))
        pages["/lines"] = self._told
        port.on_page(pages)

    def add(self, lines: Sequence[LogLine]) -> None:
        """Show these lines, too."""
        with self._lock:
            for line in lines:
                self._count += 1
                self._lines.append((self._count, line))
                program = program_of(line.origin)
                if program not in self._programs and len(self._programs) < PROGRAMS:
                    self._programs[program] = None

    def _told(self, fields: Mapping[str, str]) -> yarpy.Page:
        since, most = (_number(fields.get(key, "")) for key in ("since", "most"))
        level = fields.get("level", "")
        worst = LEVELS.index(level) if level in LEVELS else 0
        program, text = fields.get("program", ""), fields.get("text", "").casefold()
        with self._lock:
            newest, programs = self._count, sorted(self._programs)
            fresh = min(max(newest - since, 0), len(self._lines))
            lines = [self._lines[at] for at in range(-fresh, 0)] if since else [*self._lines]
        found: list[list[Any]] = []
        for number, line in reversed(lines):
            if len(found) >= min(most, MOST):
                break
            if line.level and LEVELS.index(line.level) < worst:
                continue
            if program and program_of(line.origin) != program:
                continue
            if text and text not in f"{line.component} {line.text}".casefold():
                continue
            found.append([number, *_shown(line)])
        found.reverse()
        return jsonpage({"newest": newest, "lost": self.lost, "programs": programs, "lines": found})


def _shown(line: LogLine) -> list[Any]:
    text = line.text if len(line.text) <= _LONGEST else f"{line.text[:_LONGEST]} ..."
    return [line.time, program_of(line.origin), line.origin, line.level, line.component, text]


def _number(text: str) -> int:
    return int(text) if text.isascii() and text.isdigit() and len(text) < 16 else 0
