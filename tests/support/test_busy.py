"""Busy loops run beside a command, and end with it."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from support.process import descendants
from support.wait import wait_until

BUSY = Path(__file__).parent / "busy.py"


def test_exit_code_is_that_of_the_command() -> None:
    command = [sys.executable, BUSY, sys.executable, "-c", "import sys; sys.exit(3)"]
    assert subprocess.run(command, timeout=60).returncode == 3


def test_loops_do_not_outlive_a_killed_run() -> None:
    command = [sys.executable, BUSY, sys.executable, "-c", "import time; time.sleep(600)"]
    run = subprocess.Popen(command)
    expected = 1 + len(os.sched_getaffinity(0))
    wait_until(lambda: len(descendants(run.pid)) == expected)
    family = descendants(run.pid)
    run.kill()
    run.wait()
    wait_until(lambda: sum(map(lives, family)) == 1)
    for pid in filter(lives, family):
        os.kill(pid, 9)  # the command, which nobody ends in such a case


def lives(pid: int) -> bool:
    """Whether a process runs; one that nobody has buried yet does not."""
    try:
        return bool(Path(f"/proc/{pid}/cmdline").read_bytes())
    except OSError:
        return False
