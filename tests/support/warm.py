"""Compile the tests once, on all processors, before many workers would each do it.

    python tests/support/warm.py [STAGE]

pytest rewrites the assertions of a test file when it first imports it, and keeps the result. In a
fresh checkout that takes as long as a quarter of all tests, in every worker at the same time.
Rules: pytest itself does it, by collecting; what is up to date is left alone; what goes wrong here
is told by the tests themselves.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))

from support.stage import TESTS, stage_of

FEW = 50  # files that workers may as well compile themselves


def stale(folder: Path) -> list[Path]:
    """Return the test files below a folder that are not compiled as they are now."""
    ending = f".{sys.implementation.cache_tag}-pytest-{pytest.__version__}.pyc"

    def is_stale(path: Path) -> bool:
        compiled = path.parent / "__pycache__" / f"{path.stem}{ending}"
        return not compiled.exists() or compiled.stat().st_mtime < path.stat().st_mtime

    return [path for path in sorted(folder.rglob("test_*.py")) if is_stale(path)]


def compile_all(files: list[Path], processes: int) -> None:
    """Let as many processes collect them."""
    command = [sys.executable, "-m", "pytest", "--collect-only", "-qq", "-p", "no:cacheprovider"]
    running = [
        subprocess.Popen([*command, *part], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for part in (files[number::processes] for number in range(processes))
        if part
    ]
    for process in running:
        process.wait()


if __name__ == "__main__":
    stage = sys.argv[1] if len(sys.argv) > 1 else ""
    found = [] if sys.dont_write_bytecode else stale(TESTS)
    found = [path for path in found if not stage or stage_of(path) == stage]
    if len(found) > FEW:
        compile_all(found, os.cpu_count() or 1)
