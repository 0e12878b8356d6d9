"""The time line of a recording: how much came from each port when, and where nothing came.

Rules: memory does not grow with the recording: counts of BINS stretches of time for each port, and
the longest silences. A silence is one of more than a second and ten times what is usual there.
"""

from __future__ import annotations

from bisect import insort
from typing import Any, Final

BINS: Final = 600
SILENCES: Final = 50  # of a port that are kept
SECOND: Final = 1_000_000_000  # nanoseconds
_USUAL: Final = 10.0  # times the mean interval of messages
_LEAST: Final = 1.0  # seconds


class Row:
    """A port in the overview: `bins`, how many messages came in each; `silences`, the longest."""

    def __init__(self) -> None:
        self.bins = [0] * BINS
        self.messages = 0
        self.silences: list[tuple[int, int, int]] = []  # length, begin, end; the longest last
        self._first = 0
        self._last = 0

    def add(self, place: int, time: int) -> None:
        """A message came then, in that bin."""
        self.bins[place] += 1
        if self.messages:
            self._note(self._last, time)
        else:
            self._first = time
        self.messages += 1
        self._last = time

    def _note(self, begin: int, end: int) -> None:
        length = end - begin
        if length < _LEAST * SECOND:
            return
        if len(self.silences) < SILENCES or length > self.silences[0][0]:
            insort(self.silences, (length, begin, end))
            del self.silences[: max(0, len(self.silences) - SILENCES)]

    def told(self, origin: int) -> list[list[float]]:
        """Return the begins and ends of silences, in seconds from `origin`."""
        if self.messages < 2:
            return []
        usual = (self._last - self._first) / (self.messages - 1)
        return [
            [(begin - origin) / SECOND, (end - origin) / SECOND]
            for length, begin, end in self.silences
            if length > _USUAL * usual
        ]


class Overview:
    """The rows of a stretch of time, in nanoseconds."""

    def __init__(self, begin: int, end: int) -> None:
        self.begin = begin
        self.end = max(end, begin + 1)
        self.rows: dict[str, Row] = {}

    def place(self, time: int) -> int:
        """Return the bin of a moment."""
        share = (time - self.begin) * BINS // (self.end - self.begin)
        return min(max(share, 0), BINS - 1)

    def start(self, place: int) -> int:
        """Return when a bin begins; a moment earlier, so that nothing of it is left out."""
        return self.begin + place * (self.end - self.begin) // BINS - 1

    def add(self, port: str, time: int) -> None:
        """A message of a port came."""
        row = self.rows.get(port)
        if row is None:
            row = self.rows[port] = Row()
        row.add(self.place(time), time)

    def filled(self, port: str, time: int) -> list[int]:
        """Return the bins until then in which something came from a port, the latest first; at
        most two."""
        row = self.rows.get(port)
        found: list[int] = []
        for place in range(self.place(time), -1, -1):
            if row is not None and row.bins[place]:
                found.append(place)
                if len(found) == 2:
                    break
        return found

    def told(self, port: str) -> dict[str, Any]:
        """Return what a page is told of a port."""
        row = self.rows.get(port) or Row()
        return {"bins": row.bins, "gaps": row.told(self.begin)}
