"""Losses: what a recorder could not keep, told once each, and kept with each file.

Rules: for the thread that writes.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import Any, TypeAlias

from yarpy.kits.record.capture.queue import Count

_Numbers: TypeAlias = tuple[int, int, int]  # lost, missed, left out


class Losses:
    """The losses of what is counted in `counts`, by ports."""

    def __init__(self, counts: Mapping[str, Count]) -> None:
        self._counts = counts
        self._told: dict[str, _Numbers] = {}  # that were noted
        self._kept: dict[str, _Numbers] = {}  # of finished files

    def tell(
        self,
        note: Callable[[Mapping[str, Any], int], object],
        tell: Callable[[str], object],
        now: int,
    ) -> None:
        """Note what was lost since the last time, and tell people of it."""
        for port, count in dict(self._counts).items():
            found = count.lost, count.missed, count.left_out
            before = self._told.get(port, (0, 0, 0))
            if found[:2] != before[:2]:
                self._told[port] = found
                lost, missed = found[0] - before[0], found[1] - before[1]
                note({"what": "lost", "port": port, "count": lost, "missed": missed}, now)
                if lost:
                    why = "the disk is too slow, the memory small, or the file gone"
                    tell(f"{lost} messages of {port} were lost: {why}")

    def of_file(self) -> dict[str, str]:
        """Return what was lost since the last file was finished, as JSON."""
        found: dict[str, dict[str, int]] = {"lost": {}, "missed": {}, "left out": {}}
        for port, count in dict(self._counts).items():
            now = count.lost, count.missed, count.left_out
            before = self._kept.get(port, (0, 0, 0))
            self._kept[port] = now
            for key, new, old in zip(found, now, before, strict=True):
                if new > old:
                    found[key][port] = new - old
        return {key: json.dumps(value) for key, value in found.items()}
