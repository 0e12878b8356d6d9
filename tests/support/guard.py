"""A guard that ends what the tests have started, also when their process is killed (Linux).

    with guarded():
        ...             # every program started from now on

Rules: a mark in the environment says who belongs to the tests, as children inherit it. The guard is
a process of its own, at the other end of a pipe: the pipe ends with the tests, however they end,
and then everybody with the mark gets SIGKILL, until nobody has it.
"""

import os
import subprocess
import sys
import uuid
from collections.abc import Iterator
from contextlib import contextmanager

MARK = "YARPY_TEST_GUARD"
_CODE = """
import os, signal, sys, time
mark, spared = sys.argv[1].encode(), {os.getpid(), int(sys.argv[2])}
sys.stdin.buffer.read()
while True:
    found = []
    for name in os.listdir("/proc"):
        if name.isdigit() and int(name) not in spared:
            try:
                with open(f"/proc/{name}/environ", "rb") as file:
                    if mark in file.read().split(b"\\0"):
                        found.append(int(name))
            except OSError:
                continue
    if not found:
        break
    for pid in found:
        try:
            os.kill(pid, signal.SIGKILL)
        except OSError:
            pass
    time.sleep(0.02)
"""


@contextmanager
def guarded() -> Iterator[None]:
    """End whatever is started meanwhile, at the end of the block or of this process."""
    if not os.path.exists("/proc/self/environ"):
        yield
        return
    before = os.environ.get(MARK)
    mark = uuid.uuid4().hex
    guard = subprocess.Popen(
        [sys.executable, "-I", "-S", "-c", _CODE, f"{MARK}={mark}", str(os.getpid())],
        stdin=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        start_new_session=True,  # a signal for the tests is none for it
    )
    os.environ[MARK] = mark
    try:
        yield
    finally:
        if before is None:
            del os.environ[MARK]
        else:
            os.environ[MARK] = before
        assert guard.stdin is not None
        guard.stdin.close()
        guard.wait(30)
