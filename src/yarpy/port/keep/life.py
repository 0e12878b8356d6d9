"""Life: whether a port works, is interrupted or closed, and its calls that are under way.

Rules: signal handlers may ask and end, so nothing here takes a lock.
"""

from __future__ import annotations

from yarpy.scope import Calls


class Life:
    """The state of one port."""

    def __init__(self) -> None:
        self.closing = False
        self.inherited = False  # from the process that this one was forked from
        self.interrupted = False
        self.calls = Calls()  # of the program that are under way

    @property
    def over(self) -> bool:
        """Return whether reading and writing are at an end, for now or for good."""
        return self.closing or self.interrupted

    def inherit(self) -> None:
        """In a forked process: the port is the parent's."""
        self.closing = self.inherited = True
        self.calls = Calls()
