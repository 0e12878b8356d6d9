"""What rooms have done in a forked child, by a single hook of the system."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from yarpy import fork

SOURCE = Path(fork.__file__).parent

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="this system does not fork")

PROGRAM = """
import os, sys
from yarpy import fork

said = []
fork.after_in_child(lambda: said.append("one"))
fork.after_in_child(lambda: 1 / 0)
fork.after_in_child(lambda: said.append("two"))
child = os.fork()
if not child:
    os._exit(0 if said == ["one", "two"] else 1)
sys.exit(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) or len(said))
"""

LOCKS = """
import os, signal, sys, threading
from yarpy import fork

signal.alarm(30)
held, mine, over = fork.lock(), fork.lock(), threading.Event()
taken = threading.Event()

def hold():
    with held:
        taken.set()
        over.wait()

thread = threading.Thread(target=hold)
thread.start()
taken.wait()
with mine:
    child = os.fork()
    if not child:
        held.acquire()
        print("free", flush=True)
if not child:
    print("released" if mine.acquire(blocking=False) else "", flush=True)
    os._exit(0)
os.waitpid(child, 0)
print(held.acquire(blocking=False))
over.set()
"""

IMPORTS = """
import os, signal, sys, threading, time
from yarpy import fork

signal.alarm(30)
fork.after_in_child(int)
fork.IMPORTING = float(sys.argv[1])
sys.path.insert(0, sys.argv[2])
begun, go_on = threading.Event(), threading.Event()
sys.modules["events"] = threading
threading.begun, threading.go_on = begun, go_on
thread = threading.Thread(target=lambda: __import__("slow"))
thread.start()
begun.wait()
timer = threading.Timer(0.2, go_on.set)
if float(sys.argv[1]) > 1:
    timer.start()
for _ in range(2):
    child = os.fork()
    if not child:
        go_on.set()
        import slow
        print(slow.value, flush=True)
        os._exit(0)
    os.waitpid(child, 0)
go_on.set()
"""


@pytest.mark.parametrize(("limit", "imports"), [(60.0, 1), (0.1, 2)])
def test_a_fork_waits_for_an_import_of_another_thread_but_not_for_ever(tmp_path, limit, imports):
    """A child that comes earlier imports it anew, as the half of it is of no use there."""
    (tmp_path / "slow.py").write_text(
        "import events\nevents.times = value = getattr(events, 'times', 0) + 1\n"
        "events.begun.set()\nevents.go_on.wait()\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", IMPORTS, str(limit), str(tmp_path)],
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.stdout.split() == [str(imports)] * 2, done.stderr


def test_a_lock_of_the_process_is_free_in_a_child_whoever_held_it():
    done = subprocess.run([sys.executable, "-c", LOCKS], capture_output=True, text=True, timeout=60)
    assert done.stdout.split() == ["free", "released", "False"], done.stderr


def test_each_room_is_called_in_the_child_alone_also_where_another_one_fails():
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM], capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 0, done.stderr
    assert "ZeroDivisionError" in done.stderr


def test_nobody_else_hooks_into_fork():
    others = [
        path.relative_to(SOURCE)
        for path in SOURCE.rglob("*.py")
        if "register_at_fork" in path.read_text("utf-8") and path != Path(fork.__file__)
    ]
    assert not others
