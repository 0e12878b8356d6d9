"""The guard: a killed test leaves nobody, not even who hears no signal."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from support.guard import guarded
from support.wait import HANG, wait_until

linux = pytest.mark.skipif(
    not os.path.exists("/proc/self/environ"), reason="the guard needs /proc, so Linux"
)
DEAF = "trap '' TERM HUP INT; echo $$; while :; do sleep 0.05; done"
TEST = f"""
import subprocess, time
from support.guard import guarded
with guarded():
    subprocess.Popen(["sh", "-c", {DEAF!r}], start_new_session=True)
    time.sleep(600)
"""


def alive(pid: int) -> bool:
    try:
        state = Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()[0]
    except OSError:
        return False
    return state not in "ZX"


@linux
def test_a_killed_test_leaves_nobody() -> None:
    path = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[1])}
    with subprocess.Popen([sys.executable, "-c", TEST], stdout=subprocess.PIPE, env=path) as test:
        assert test.stdout is not None
        pid = int(test.stdout.readline())
        assert alive(pid)
        test.send_signal(signal.SIGKILL)
        test.wait()
        wait_until(lambda: not alive(pid))


@linux
def test_the_end_of_the_block_is_the_end_of_all() -> None:
    with guarded():
        deaf = subprocess.Popen(["sh", "-c", DEAF], stdout=subprocess.PIPE)
        assert deaf.stdout is not None and deaf.stdout.readline()
        other = subprocess.Popen(["sleep", "600"], env={"PATH": os.environ["PATH"]})
    assert deaf.wait(HANG) == -signal.SIGKILL
    assert other.poll() is None, "who has no mark is none of ours"
    other.kill()
    other.wait()
    deaf.stdout.close()
