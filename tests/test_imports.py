"""First looks at names of yarpy by several threads at once, which import what has them."""

from __future__ import annotations

import subprocess
import sys

import pytest

PROGRAM = """
import sys, threading, yarpy
sys.setswitchinterval(1e-6)
names = [name for name in yarpy.__all__ if name not in {"aio", "idl"}]
failed, start = [], threading.Barrier(len(names) + 2)

def look(act, name):
    start.wait()
    try:
        act()
    except Exception as error:
        failed.append(f"{name}: {error!r}")

def ask():
    from yarpy.network.asking import ask_server

acts = [(lambda name=name: getattr(yarpy, name), name) for name in names[NUMBER:] + names[:NUMBER]]
threads = [threading.Thread(target=look, args=act) for act in [*acts, (ask, "ask"), (ask, "ask")]]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
sys.exit("\\n".join(failed) or 0)
"""


@pytest.mark.parametrize("number", [0, 20, 40, 60])
def test_threads_may_need_what_others_import(number: int) -> None:
    """A package that imports its own parts hands others parts that are half done."""
    program = PROGRAM.replace("NUMBER", str(number))
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
