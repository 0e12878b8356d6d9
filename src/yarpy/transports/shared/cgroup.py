"""Control groups: where Linux says what this program may use, and what of its memory is left.

Rules: groups lie in groups, and the limits of all count; in a container the group is often the
root. Both versions of cgroup. What cannot be read limits nothing.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Final

ROOT: Final = Path("/sys/fs/cgroup")
OWN: Final = Path("/proc/self/cgroup")
_INFO: Final = Path("/proc/meminfo")


def groups(kind: str, root: Path = ROOT, own: Path = OWN) -> Iterator[tuple[int, Path]]:
    """The folders of the groups that this process is in, for `cpu` or `memory`, with the version of
    cgroup that they are of."""
    try:
        lines = own.read_text(encoding="utf-8").splitlines()
    except OSError:
        return  # no Linux
    for line in lines:
        _, kinds, path = [*line.split(":", 2), "", ""][:3]
        parts = [part for part in path.split("/") if part not in ("", "..")]
        if not kinds:
            version, base = 2, root
        elif kind in kinds.split(","):
            version, base = 1, root / kind
        else:
            continue
        for count in range(len(parts) + 1):
            yield version, base.joinpath(*parts[:count])


def free_memory(root: Path = ROOT, own: Path = OWN, info: Path = _INFO) -> float:
    """Bytes that this process may still take before the system has to kill one; infinite if it does
    not say."""
    found = [_field(info, "MemAvailable:") * 1024]
    for version, folder in groups("memory", root, own):
        limit, used, cached = (
            ("memory.max", "memory.current", "inactive_file")
            if version == 2
            else ("memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file")
        )
        most = _number(folder / limit)
        if most < math.inf:
            given_back = _field(folder / "memory.stat", cached)
            found.append(
                most - _number(folder / used) + (given_back if given_back < math.inf else 0)
            )
    return min(found)


def _number(file: Path) -> float:
    try:
        return int(file.read_text(encoding="utf-8"))  # or "max"
    except (OSError, ValueError):
        return math.inf


def _field(file: Path, name: str) -> float:
    """The number behind a name, in a file of such lines."""
    try:
        for line in file.read_text(encoding="utf-8").splitlines():
            if line.startswith(name + " "):
                return int(line.split()[1])
    except (OSError, ValueError, IndexError):
        pass
    return math.inf
