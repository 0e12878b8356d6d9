"""The numbers of a port over a stretch of time, as few as a screen can show, or all as CSV.

Rules: of many messages only some are decoded, at even distances, and that is said (`every`). Where
there are more rows than points, each stretch gives its lowest and its highest values, so that no
peak of what was decoded is lost. Numbers that are the time of day are no values.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator
from typing import Any, Final

import numpy as np

from yarpy.kits.record.envelope import SECOND
from yarpy.kits.record.recorded import Recorded
from yarpy.kits.record.recording import Recording
from yarpy.kits.record.view.labels import labels_of
from yarpy.kits.record.view.source import rows_of
from yarpy.kits.record.view.spelling import NUMBERS, numbers_of, text_of

DECODED: Final = 20_000  # messages of one question
SMALL: Final = 1024  # bytes of a message that is kept as it is
POINTS: Final = 4000  # of a curve
DAY: Final = 86_400.0  # seconds within which a number is the time of its message


def curves(
    recording: Recording, port: str, origin: int, begin: int, end: int, points: int
) -> dict[str, Any]:
    """Return the `times` in seconds from `origin`, `columns` of values, and the names that these
    have in the first message, if any; begin, end, origin in nanoseconds."""
    points = min(max(points, 10), POINTS)
    taken: list[tuple[int, Recorded | list[float]]] = []
    every, number = 1, -1
    names: list[str] = []
    for number, recorded in enumerate(rows_of(recording, port, begin, end)):
        if not number:
            names = labels_of(recorded, NUMBERS)
        if number % every == 0:
            taken.append((recorded.received_ns, _kept(recorded)))
            if len(taken) >= DECODED:
                taken, every = taken[::2], every * 2
    times = [(time - origin) / SECOND for time, _ in taken]
    rows = [numbers_of(one) if isinstance(one, Recorded) else one for _, one in taken]
    width = max(map(len, rows), default=0)
    table = np.full((len(rows), width), np.nan)
    for at, row in enumerate(rows):
        table[at, : len(row)] = row
    if taken:  # clocks among the numbers would make a line of all others
        table[abs(table - taken[0][0] / SECOND) < DAY] = np.nan
    found_times, table = _thinned(np.array(times), table, points)
    columns = [
        [None if value != value or abs(value) == np.inf else value for value in column]
        for column in table.T.tolist()
    ]
    return {
        "times": found_times.tolist(),
        "columns": columns,
        "names": names,
        "every": every,
        "of": number + 1,
    }


def _kept(recorded: Recorded) -> Recorded | list[float]:
    """Return what is kept of a message until it is known which ones are decoded: a few bytes, apart
    from those that were read together with them; of long messages the numbers."""
    if len(recorded.payload) > SMALL:
        return numbers_of(recorded)
    return Recorded(recorded.port, recorded.received_ns, 0, "", bytes(recorded.payload))


def _thinned(times: Any, table: Any, points: int) -> tuple[Any, Any]:
    """Return at most `points` rows, two for each stretch: its lowest and highest values."""
    count = len(times)
    if count <= points or not table.shape[1]:
        return times, table
    edges = np.linspace(0, count, points // 2 + 1).astype(int)[:-1]
    lowest = np.fmin.reduceat(table, edges)
    highest = np.fmax.reduceat(table, edges)
    ends = np.append(edges[1:], count) - 1
    merged = np.empty((2 * len(edges), table.shape[1]))
    merged[0::2], merged[1::2] = lowest, highest
    moments = np.empty(2 * len(edges))
    moments[0::2], moments[1::2] = times[edges], times[ends]
    return moments, merged


def as_csv(recording: Recording, port: str, begin: int, end: int) -> Iterator[bytes]:
    """Yield lines of all messages of a port: when it came, when it was sent, its numbers, or its
    text if it has none."""
    yield b"received,sent,values\n"
    for recorded in rows_of(recording, port, begin, end):
        line = io.StringIO()
        values: list[Any] = list(numbers_of(recorded)[:NUMBERS]) or [text_of(recorded)]
        times = _seconds(recorded.received_ns), _seconds(recorded.sent_ns)
        csv.writer(line, lineterminator="\n").writerow([*times, *values])
        yield line.getvalue().encode("utf-8", "surrogateescape")


def _seconds(time: int) -> str:
    return f"{time // SECOND}.{time % SECOND:09}"
