"""Examination: all families of findings look at a case, one after the other.

Rules: each has a time limit; one that fails or hangs costs its own findings, and is named.
"""

from __future__ import annotations

import queue
import threading
from collections.abc import Iterator
from typing import Any, Final

from yarpy import registry
from yarpy.errors import YarpError
from yarpy.network.doctor.case import Case
from yarpy.network.doctor.finding import LEVELS, Finding

PATIENCE: Final = 10.0  # seconds for a family
MOST: Final = 200  # findings of one family


def examine(case: Case, patience: float = PATIENCE) -> list[Finding]:
    """Everything that is found, faults first."""
    found: list[Finding] = []
    for name in registry.findings.names():
        found += _of_family(name, case, patience)
    unique = dict.fromkeys(found)
    return sorted(unique, key=lambda finding: LEVELS.index(finding.level))


def _of_family(name: str, case: Case, patience: float) -> list[Finding]:
    found: list[Finding] = []
    end: queue.SimpleQueue[str] = queue.SimpleQueue()

    def look() -> None:
        try:
            family: Any = registry.findings.load(name)
            for finding in _some(family(case)):
                found.append(finding)
            end.put("")
        except YarpError as error:
            end.put(str(error))
        except Exception as error:  # a defect of theirs
            end.put(f"{type(error).__name__}: {error}")

    threading.Thread(target=look, name=f"yarpy doctor {name}", daemon=True).start()
    try:
        why = end.get(timeout=patience)
    except queue.Empty:
        why = f"it takes longer than {patience:g} s"
    if why:
        verdict = f"the findings of {name} are not complete: {why}"
        found.append(Finding("unfinished", name, verdict, "", "note"))
    return list(found)


def _some(findings: Iterator[Finding]) -> Iterator[Finding]:
    for _, finding in zip(range(MOST), findings, strict=False):
        yield finding
