"""Trace: the numbers that one port sends, with the times that they belong to.

Rules: nested lists are flattened, and every element counts, so that the index of a number depends
only on its position in the message. Other elements are skipped and listed. The last `HISTORY`
messages are kept; a page asks for those that it lacks.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import islice
from typing import Any, Final

import numpy as np

import yarpy
from yarpy.kits.views.label import Describe, Label

HISTORY: Final = 20_000  # messages
CURVES: Final = 12  # numbers of a message drawn by default
LEAVES: Final = 4096  # elements of a message that are examined
OTHERS: Final = 8  # elements listed as not being numbers
AT_ONCE: Final = 2000  # messages in an answer
MEMORY: Final = 3.0  # seconds over which the rate is measured
TRUST: Final = 0.5  # seconds that a sender's clock may drift


class Trace:
    """The recent messages of `name`. indices: of the numbers to keep; empty: the first `CURVES`."""

    def __init__(self, name: str, indices: Sequence[int] = ()) -> None:
        self.name = name
        self._columns = list(indices)
        self._chosen = bool(indices)
        self._labels: dict[int, str] = {}
        self._describe: Describe | None = None
        self._described: list[Label] = []  # one for each of
        self._leaves = -1  # so many elements
        self._rows: deque[tuple[float | None, ...]] = deque(maxlen=HISTORY)
        self._total = 0
        self._times: deque[float] = deque(maxlen=1000)
        self._others: dict[int, str] = {}  # index and spelling of what is no number
        self._more = 0
        self._empty = 0
        self._complaint = ""
        self._clock = Clock()

    def describe(self, describe: Describe) -> None:
        """Name curves by what the device behind the port says."""
        self._describe = describe
        self._leaves = -1

    def take(self, message: yarpy.Message, now: float) -> None:
        """Keep the numbers of a message that came at `now`, in seconds."""
        try:
            value = message.as_(object)
            found = list(islice(leaves_of(value), LEAVES))
        except yarpy.DecodeError as error:
            self.refuse(f"a message that cannot be read: {error}")
            return
        self._times.append(now)
        if self._describe is not None and len(found) != self._leaves:
            self._leaves = len(found)
            self._described = _labels(self._describe, value, len(found))
        leaves = [leaf for leaf, _ in found]
        numbers = [number_of(leaf) for leaf in leaves]
        self._look(leaves, numbers, {index for index, (_, time) in enumerate(found) if time})
        row = [numbers[i] if i < len(numbers) else None for i in self._columns]
        if all(value is None for value in row):
            self.refuse(_described(message, self._chosen))
            return
        stamp = message.stamp
        moment = self._clock.place(now, None if stamp is None else stamp.time)
        self._rows.append((round(moment, 6), *row))
        self._total += 1

    def refuse(self, complaint: str) -> None:
        """Count a message without numbers."""
        self._empty += 1
        self._complaint = complaint

    def _look(self, leaves: list[Any], numbers: list[float | None], times: set[int]) -> None:
        """Learn which curves there are and what they are called; `times` are none."""
        known = set(self._columns)
        self._more = 0
        for index, (leaf, number) in enumerate(zip(leaves, numbers, strict=True)):
            if number is None:
                if len(self._others) < OTHERS:
                    self._others[index] = _spelled(leaf)
                continue
            if index not in known:
                if self._chosen or index in times or len(self._columns) >= CURVES:
                    self._more += 1
                    continue
                self._columns.append(index)
                known.add(index)
            if index not in self._labels:
                self._others.pop(index, None)
                before = leaves[index - 1] if index else None
                self._labels[index] = before if isinstance(before, str) else ""

    def told(self, after: int, now: float) -> dict[str, Any]:
        """Plain data for a page that has the messages up to number `after`."""
        if not 0 <= after <= self._total:
            after = 0
        new = min(self._total - after, len(self._rows))
        start = len(self._rows) - new
        rows = list(islice(self._rows, start, start + AT_ONCE))
        times = [moment for moment in tuple(self._times) if now - moment < MEMORY]
        span = times[-1] - times[0] if len(times) > 1 else 0.0
        return {
            "name": self.name,
            "curves": [self._curve(index) for index in self._columns],
            "rows": rows,
            "next": self._total - new + len(rows),
            "total": self._total,
            "rate": (len(times) - 1) / span if span else 0.0,
            "more": self._more,
            "others": [f"{text} at {index}" for index, text in sorted(self._others.items())],
            "empty": self._empty,
            "complaint": self._complaint,
        }

    def _curve(self, index: int) -> dict[str, Any]:
        label, unit = self._described[index] if index < len(self._described) else ("", "")
        return {"index": index, "label": label or self._labels.get(index, ""), "unit": unit}


class Clock:
    """A sender's stamps on our time axis.

    The first stamp is placed where its message arrived, and the others keep their distance from it,
    however unevenly messages arrive. After a clock jumps or drifts, it is aligned again.
    """

    def __init__(self) -> None:
        self._ahead = math.inf  # of the sender's clock, what ours is to add
        self._last = -math.inf

    def place(self, arrived: float, stamp: float | None) -> float:
        """Return the time when a message happened that came at `arrived`; never before the one
        before it."""
        moment = arrived
        if stamp is not None and math.isfinite(stamp):
            if not abs(stamp + self._ahead - arrived) < TRUST:
                self._ahead = arrived - stamp
            moment = stamp + self._ahead
        self._last = max(self._last, moment)
        return self._last


def flat(value: Any) -> Iterator[Any]:
    """The elements of a value and of the lists in it, in order."""
    return (leaf for leaf, _ in leaves_of(value))


def leaves_of(value: Any, depth: int = 0, time: bool = False) -> Iterator[tuple[Any, bool]]:
    """The elements, each with whether it is the time of a measurement: `(((0.1 9.8) 1795.2) ...)`,
    as sensors send them, in a list for each kind of sensor."""
    if isinstance(value, (list, tuple, yarpy.Vector)):
        timed = (
            depth > 1
            and len(value) == 2
            and isinstance(value[0], (list, tuple, yarpy.Vector))
            and isinstance(value[1], float)
        )
        for place, item in enumerate(value):
            yield from leaves_of(item, depth + 1, timed and place == 1)
    elif isinstance(value, Mapping):
        for key, item in value.items():
            yield key, False
            yield from leaves_of(item, depth + 2)
    elif isinstance(value, np.ndarray):
        yield from ((item, False) for item in value.ravel()[:LEAVES].tolist())
    elif not isinstance(value, (yarpy.Image, yarpy.Sound)):
        yield value, time


def number_of(value: Any) -> float | None:
    """The number that an element is; None for others, and for what cannot be drawn."""
    if not isinstance(value, (int, float)) or not math.isfinite(value):
        return None
    return int(value) if isinstance(value, bool) else value


def parse_indices(text: str) -> list[int]:
    """Indices as typed by a user: `0,2,5`, `0-3`, or as for yarpscope `(0 1 2)`.

    Raises ValueError.

    >>> parse_indices("0, 4-6")
    [0, 4, 5, 6]
    """
    found: list[int] = []
    for word in text.strip(" ()").replace(",", " ").split():
        first, dash, last = word.partition("-")
        if not (first.isdigit() and (last.isdigit() or not dash)):
            raise ValueError(f'"{word}" is no index; indices are 0,2,5 or 0-3')
        found.extend(_range(int(first), int(last or first)))
    return list(dict.fromkeys(found))


def _labels(describe: Describe, value: Any, count: int) -> list[Label]:
    """The labels of the first `LEAVES` elements of a message; none if it is not as described."""
    try:
        found = describe(value)[:LEAVES]
    except (TypeError, ValueError, LookupError):
        return []
    return found if len(found) == count else []


def _range(first: int, last: int) -> Iterable[int]:
    if not first <= last < LEAVES:
        raise ValueError(f"indices go from 0 to {LEAVES - 1}, the smaller one first")
    return range(first, last + 1)


def _spelled(leaf: Any) -> str:
    if isinstance(leaf, bytes):
        return f"{len(leaf)} bytes"
    text = yarpy.Bottle([leaf]).to_text()
    return text if len(text) <= 30 else f"{text[:30]}..."


def _described(message: yarpy.Message, chosen: bool) -> str:
    """A message without numbers."""
    value = message.value
    if isinstance(value, yarpy.Image):
        return "an image, which `yarpy view` shows"
    if isinstance(value, yarpy.Sound):
        return "a sound, which `yarpy hear` plays"
    text = message.as_(yarpy.Bottle).to_text()
    return f"{'nothing at these indices' if chosen else 'no number'} in: {text[:80]}"
