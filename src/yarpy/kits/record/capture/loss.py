"""Losses: what a recorder could not keep, told once each, and kept with each file.

Rules: for the thread that writes.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import Any, Final, TypeAlias

from yarpy.kits.record.capture.queue import Count

_Numbers: TypeAlias = tuple[int, int, int, int]
KINDS: Final = ("lost", "missed", "left out", "replaced")
WORDS: Final = ("lost", "never arrived", "left out", "replaced")  # for people
_NOTHING: Final = (0, 0, 0, 0)


def numbers_of(count: Count) -> _Numbers:
    """Return the numbers of KINDS."""
    return count.lost, count.missed, count.left_out, count.replaced


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
            found = numbers_of(count)
            before = self._told.get(port, _NOTHING)
            lost, missed, _, replaced = (new - old for new, old in zip(found, before, strict=True))
            if lost or missed or replaced:
                self._told[port] = found
                said = {"what": "lost", "port": port, "count": lost, "missed": missed}
                note(said | ({"replaced": replaced} if replaced else {}), now)
                if lost:
                    why = "the disk is too slow, the memory small, or the file gone"
                    tell(f"{lost} messages of {port} were lost: {why}")

    def of_file(self) -> dict[str, str]:
        """Return what was lost since the last file was finished, as JSON."""
        found: dict[str, dict[str, int]] = {kind: {} for kind in KINDS}
        for port, count in dict(self._counts).items():
            now = numbers_of(count)
            before = self._kept.get(port, _NOTHING)
            self._kept[port] = now
            for key, new, old in zip(found, now, before, strict=True):
                if new > old:
                    found[key][port] = new - old
        return {key: json.dumps(value) for key, value in found.items()}
