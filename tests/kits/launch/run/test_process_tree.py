"""A program and all that it has started."""

import os
import signal
import subprocess
import sys

import pytest
from support.wait import wait_until

from yarpy.kits.launch.run import process_tree
from yarpy.kits.launch.run.process_tree import ProcessTree
from yarpy.kits.launch.supervise import process

pytestmark = pytest.mark.skipif(not process.known(), reason="this system has no /proc to look at")

# A child in a session of its own, and one whose parent goes at once.
LEAVES = """
import os, sys, time
if os.fork() == 0:
    os.setsid()
    if os.fork() == 0:
        time.sleep(600)
    os._exit(0)
os.wait()
print("ready", flush=True)
if sys.argv[1] == "stay":
    time.sleep(600)
"""


@pytest.mark.parametrize("first", ["stay", "go"])
def test_who_left_the_session_is_found_and_ended(first: str) -> None:
    mark = f"test-{first}-{os.getpid()}"
    with subprocess.Popen(
        [sys.executable, "-c", LEAVES, first],
        env={process_tree.MARK: mark},
        stdout=subprocess.PIPE,
        start_new_session=True,
    ) as child:
        assert child.stdout is not None
        assert child.stdout.readline() == b"ready\n"
        found = ProcessTree(child.pid, mark, process_tree.began(child.pid))
        if first == "go":
            child.wait()
            assert not found.leads
        assert len(found.members()) == (2 if first == "stay" else 1)
        assert (process_tree.leader(mark) == child.pid) == (first == "stay")
        assert found.signal(signal.SIGKILL)
        child.wait()
        wait_until(lambda: not found.members())
        assert not found.signal(signal.SIGKILL)


def test_a_number_that_was_given_to_another_one_is_not_it() -> None:
    with subprocess.Popen(["sleep", "600"], start_new_session=True) as child:
        now = process_tree.began(child.pid)
        assert ProcessTree(child.pid, "m", now).leads
        other = ProcessTree(child.pid, "m", now - 1)
        assert not other.leads and other.members() == [] and not other.signal(signal.SIGKILL)
        assert child.poll() is None
        child.kill()
