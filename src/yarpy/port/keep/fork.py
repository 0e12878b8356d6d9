"""Fork: what a child process has of its parent's ports, which is nothing.

Rules: threads do not come along into a forked process (`multiprocessing` with "fork", `os.fork`),
and two processes that read one connection take each other's bytes away. So in the child the
parent's ports are closed without a word to anybody: no name is given back, no connection is shut
down; only the child's copies of their sockets go, so that others notice when the parent dies. A
child that wants ports opens its own.
"""

from __future__ import annotations

from functools import cache

from yarpy import fork
from yarpy.link.begin import accept_loop
from yarpy.link.receive import budget
from yarpy.port.connect.reconnect import RECONNECTOR


@cache
def prepare() -> None:
    """Have every later fork of this process leave its ports behind. Once is enough."""
    fork.after_in_child(_leave_behind)


def _leave_behind() -> None:
    budget.start_over()
    accept_loop.LOOP.start_over()
    for hub in RECONNECTOR.start_over():
        hub.abandon("this port was opened before the process was forked; open one here")
