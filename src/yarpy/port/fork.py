"""Fork: what a child process has of its parent's ports, which is nothing.

Rules: threads do not come along into a forked process (`multiprocessing` with "fork", `os.fork`),
and two processes that read one connection take each other's bytes away. So in the child the
parent's ports are closed without a word to anybody: no name is given back, no connection is shut
down; only the child's copies of their sockets go, so that others notice when the parent dies. A
child that wants ports opens its own.
"""

from __future__ import annotations

import os
from functools import cache

from yarpy.link import accept_loop, budget
from yarpy.link.inbound import Inbound
from yarpy.link.outbound import Outbound
from yarpy.names.default import DEFAULT
from yarpy.port.hub import Hub
from yarpy.port.reconnect import RECONNECTOR


@cache
def prepare() -> None:
    """Have every later fork of this process leave its ports behind. Once is enough."""
    if hasattr(os, "register_at_fork"):  # not on Windows, which does not fork
        os.register_at_fork(after_in_child=_leave_behind)


def _leave_behind() -> None:
    DEFAULT.start_over()
    budget.start_over()
    accept_loop.LOOP.start_over()
    for hub in RECONNECTOR.start_over():
        _abandon(hub)


def _abandon(hub: Hub) -> None:
    hub.closing = hub.inherited = True
    hub.mailbox.abandon("this port was opened before the process was forked; open one here")
    hub.reception.abandon()
    links: tuple[Inbound | Outbound, ...] = (*hub.inputs, *hub.leaving, *hub.outputs)
    for link in links:
        sock = getattr(link.driver.transport, "sock", None)
        if sock is not None:
            sock.close()
    hub.inputs = hub.leaving = hub.outputs = ()
