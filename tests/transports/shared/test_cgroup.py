"""Control groups: whose limits count, and what is left of memory."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from yarpy.transports.shared.cgroup import free_memory, groups

PLENTY = "MemTotal: 9000 kB\nMemAvailable: 1000 kB\n"


def make(root: Path, files: dict[str, str]) -> None:
    for name, text in {"own": "", "info": PLENTY, **files}.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


def test_groups_in_groups(tmp_path: Path) -> None:
    make(tmp_path, {"own": "4:cpu,memory:/x/../y\n3:pids:/z\n0::/a\nnonsense\n"})
    own = tmp_path / "own"
    found = [(version, path.as_posix()) for version, path in groups("cpu", Path("/r"), own)]
    first = [(1, "/r/cpu"), (1, "/r/cpu/x"), (1, "/r/cpu/x/y")]
    assert found[:5] == [*first, (2, "/r"), (2, "/r/a")]
    assert [*groups("cpu", Path("/r"), tmp_path / "missing")] == []


@pytest.mark.parametrize(
    ("files", "wanted"),
    [
        ({}, 1_024_000),
        ({"info": ""}, math.inf),
        ({"info": "MemAvailable: lots kB\nMemAvailable:"}, math.inf),
        ({"own": "0::/a", "a/memory.max": "max\n"}, 1_024_000),
        ({"own": "0::/a", "a/memory.max": "5000\n", "a/memory.current": "3000\n"}, 2000),
        (
            {
                "own": "0::/a",
                "memory.max": "5000",
                "memory.current": "3000",
                "memory.stat": "anon 7\ninactive_file 100\n",
            },
            2100,
        ),
        (
            {
                "own": "4:memory:/x",
                "memory/x/memory.limit_in_bytes": "5000",
                "memory/x/memory.usage_in_bytes": "4000",
                "memory/x/memory.stat": "inactive_file 1\ntotal_inactive_file 10\n",
            },
            1010,
        ),
    ],
)
def test_what_is_left(tmp_path: Path, files: dict[str, str], wanted: float) -> None:
    make(tmp_path, files)
    assert free_memory(tmp_path, tmp_path / "own", tmp_path / "info") == wanted


def test_here() -> None:
    assert free_memory() > 0
