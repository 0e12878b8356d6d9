"""A program and all that it has started: who of them lives, and signals to them.

Rules: a program is the leader of a session, and has a mark in its environment, which those inherit
whom it starts. So they are found when their parent is gone, and when they have left the session
(`supervise/process.py`). Where the system does not tell of all its processes, a program is its
first one and its group.
"""

from __future__ import annotations

import signal
from dataclasses import dataclass
from typing import Final

from yarpy.kits.launch.supervise import process
from yarpy.platform.process import go_on, in_group, lives, signal_group, signal_one

MARK: Final = process.MARK


@dataclass(frozen=True, slots=True)
class ProcessTree:
    """The processes of one program. `began`: when the first did, 0 if that is not known."""

    pid: int
    mark: str
    began: int = 0

    @property
    def leads(self) -> bool:
        """Return whether the first process lives."""
        if not process.known():
            return lives(self.pid)
        found = process.look(self.pid)
        return found is not None and found.alive and self.began in (0, found.start)

    def members(self) -> list[int]:
        """Return the numbers of all that live, the first one first."""
        leads = self.leads
        # The number of a session is given to nobody else while one of its processes lives.
        own = leads or process.look(self.pid) is None
        found = process.members({self.pid: self.mark} if own else {}, {self.mark})
        rest = sorted(pid for pid in found if pid != self.pid)
        return [self.pid, *rest] if leads else rest

    def signal(self, number: int) -> bool:
        """Send all of them a signal; return whether there was one."""
        sent = self.leads and signal_group(self.pid, number)
        for pid in self.members():
            if not sent or not in_group(pid, self.pid):  # those of its group have it
                sent = signal_one(pid, number) or sent
            if number == signal.SIGTERM:  # one that is stopped would not hear it
                go_on(pid)
        return sent


def leader(mark: str) -> int:
    """Return the first process of the program with that mark, 0 if none lives."""
    found = process.members({}, {mark})
    return next((pid for pid in found if (one := process.look(pid)) and one.session == pid), 0)


def began(pid: int) -> int:
    """Return when a process began, in ticks since the computer did; 0 if that is not known."""
    found = process.look(pid)
    return 0 if found is None else found.start
