"""Examination: all families of findings look at a case, one after the other.

Rules: each has a time limit; one that fails or hangs costs its own findings, and is named. Names
that a shell would take for more than a word are quoted in what is advised, which will be pasted.
"""

from __future__ import annotations

import queue
import re
import threading
from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import Any, Final

from yarpy import registry
from yarpy.errors import YarpError
from yarpy.kits.doctor.case import Case
from yarpy.kits.doctor.finding import LEVELS, Finding
from yarpy.platform.shell import quoted
from yarpy.platform.timed_queue import TimedQueue

TIMEOUT: Final = 10.0  # seconds for a family
MOST: Final = 200  # findings of one family


def examine(case: Case, timeout: float = TIMEOUT) -> list[Finding]:
    """Everything that is found, faults first."""
    found: list[Finding] = []
    for name in registry.findings.names():
        found += _of_family(name, case, timeout)
    names = {name for ends in case.now.flows for name in ends}.union(case.contacts, case.wanted)
    unique = dict.fromkeys(_pasteable(found, names))
    return sorted(unique, key=lambda finding: LEVELS.index(finding.level))


def _of_family(name: str, case: Case, timeout: float) -> list[Finding]:
    found: list[Finding] = []
    end: TimedQueue[str] = TimedQueue()

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
    said: list[str] = []
    try:
        end.take(said, timeout)
        (why,) = said
    except queue.Empty:
        why = f"it takes longer than {timeout:g} s"
    if why:
        verdict = f"the findings of {name} are not complete: {why}"
        found.append(Finding("unfinished", name, verdict, "", "note"))
    return list(found)


def _pasteable(findings: Iterable[Finding], names: Iterable[str]) -> Iterator[Finding]:
    """The findings, with each of the names in their advice as a shell wants it."""
    unsafe = sorted(
        {name for name in names if name[:1] == "/" and quoted(name) != name},
        key=len,
        reverse=True,
    )
    if not unsafe:
        yield from findings
        return
    any_name = re.compile("|".join(map(re.escape, unsafe)))
    for finding in findings:
        advice = any_name.sub(lambda found: quoted(found[0]), finding.advice)
        yield replace(finding, advice=advice)


def _some(findings: Iterator[Finding]) -> Iterator[Finding]:
    for _, finding in zip(range(MOST), findings, strict=False):
        yield finding
