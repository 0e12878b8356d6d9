"""Cores: how many processors this process may use at the same time.

Rules: not how many the computer has. A process may be bound to some of them, and the share of a
container (cgroup) may be less than one. The share is read once, the binding whenever a connection
begins: a program may bind itself at any time.
"""

from __future__ import annotations

import math
import os
from functools import cache
from pathlib import Path

ROOT = Path("/sys/fs/cgroup")
OWN = Path("/proc/self/cgroup")


def cores() -> int:
    """Processors for this process; at least 1."""
    if hasattr(os, "sched_getaffinity"):
        bound = len(os.sched_getaffinity(0))
    else:
        bound = os.cpu_count() or 1
    return max(1, math.ceil(min(bound, share(ROOT, OWN))))


@cache
def share(root: Path, own: Path) -> float:
    """The least of the limits of our group and those that it is in; infinite without one."""
    try:
        groups = own.read_text().splitlines()
    except OSError:
        return math.inf  # no Linux
    found = [math.inf]
    for line in groups:
        _, kinds, path = [*line.split(":", 2), "", ""][:3]
        if not kinds:
            for folder in _upwards(root, path):
                found.append(_second(folder / "cpu.max"))
        elif "cpu" in kinds.split(","):
            for folder in _upwards(root / "cpu", path):
                found.append(_first(folder))
    return min(found)


def _upwards(root: Path, path: str) -> list[Path]:
    """The folder of a group and those above it. In a container the group is often the root."""
    parts = [part for part in path.split("/") if part not in ("", "..")]
    return [root.joinpath(*parts[:count]) for count in range(len(parts) + 1)]


def _second(file: Path) -> float:
    """A limit in the second version of cgroup: `50000 100000`, or `max 100000`."""
    try:
        quota, period = file.read_text().split()
        return math.inf if quota == "max" else int(quota) / int(period)
    except (OSError, ValueError, ZeroDivisionError):
        return math.inf


def _first(folder: Path) -> float:
    """A limit in the first version."""
    try:
        quota = int((folder / "cpu.cfs_quota_us").read_text())
        period = int((folder / "cpu.cfs_period_us").read_text())
        return quota / period if quota > 0 else math.inf
    except (OSError, ValueError, ZeroDivisionError):
        return math.inf
