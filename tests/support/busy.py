"""Run a command beside busy loops, one for each processor, as on a loaded machine:

    python tests/support/busy.py make test

Rules: the loops end with the command, also when it is interrupted; its exit code is ours.
"""

import os
import subprocess
import sys
from collections.abc import Sequence

LOOP = "import os, sys\nwhile os.getppid() == int(sys.argv[1]):\n    sum(range(100000))"


def run(command: Sequence[str], loops: int) -> int:
    """The exit code of `command`."""
    busy = [subprocess.Popen([sys.executable, "-c", LOOP, str(os.getpid())]) for _ in range(loops)]
    try:
        return subprocess.run(command).returncode
    finally:
        for loop in busy:
            loop.kill()
            loop.wait()


if __name__ == "__main__":
    sys.exit(run(sys.argv[1:], len(os.sched_getaffinity(0))))
