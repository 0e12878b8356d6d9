"""Cores: how many processors this process and its peers have at the same time.

Rules: a container's share (cgroup) counts, which may be less than one: to poll there eats the time
that would be needed afterwards. What the process is bound to does not: a control loop that has a
processor for itself polls to advantage, since its peers have others.
"""

from __future__ import annotations

import math
import os
from functools import cache
from pathlib import Path

from yarpy.transports.shared.cgroup import OWN, ROOT, groups


def cores() -> int:
    """Processors that there are, or as many as our share of them comes to; at least 1."""
    return max(1, math.ceil(min(os.cpu_count() or 1, share(ROOT, OWN))))


@cache
def share(root: Path, own: Path) -> float:
    """The least of the limits of our group and those that it is in; infinite without one."""
    found = [
        _second(folder / "cpu.max") if version == 2 else _first(folder)
        for version, folder in groups("cpu", root, own)
    ]
    return min(found, default=math.inf)


def _second(file: Path) -> float:
    """A limit in the second version of cgroup: `50000 100000`, or `max 100000`."""
    try:
        quota, period = file.read_text(encoding="utf-8").split()
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
