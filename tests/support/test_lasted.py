"""`support.lasted`."""

import subprocess
import sys
import time

from support.lasted import lasted

STOPPED = """
import os, signal, subprocess, sys, time
from support.lasted import lasted
wakes = f"sleep 1; kill -CONT {os.getpid()}"
helper = subprocess.Popen(["sh", "-c", wakes], start_new_session=True)
begun = time.monotonic()
os.kill(os.getpid(), signal.SIGSTOP)
print(time.monotonic() - begun, lasted(begun))
helper.wait()
"""


def test_what_waits_itself_is_counted() -> None:
    begun = time.monotonic()
    time.sleep(0.3)
    assert 0.1 < lasted(begun) <= time.monotonic() - begun


def test_a_process_that_was_stopped_has_not_waited() -> None:
    support = [path for path in sys.path if path.endswith("tests")]
    program = f"import sys; sys.path[:0] = {support!r}\n{STOPPED}"
    found = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=60, check=True
    )
    whole, own = map(float, found.stdout.split())
    assert whole > 0.9 and own < whole / 2
