"""The agent: looks at the network, lets the governor decide, makes its steps, and undoes them all.

Rules: one thread. Whatever ports do, the agent goes on: one that refuses or says nothing costs a
step. It touches only what its rules name. Before a change is made it stands in the journal; at the
end, and at the beginning for an agent that was killed, all that stands there is undone. `journal`
None: a dry run, which changes nothing at all.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from yarpy.errors import LocalProtocolError, NoNameServer, Timeout, YarpError
from yarpy.kits.autoqos.change import Change, Step
from yarpy.kits.autoqos.controls import Controls
from yarpy.kits.autoqos.governor import Governor
from yarpy.kits.autoqos.journal import Journal
from yarpy.kits.autoqos.rules import Rules
from yarpy.names.base import NameClient
from yarpy.network.sampling import Sampler

PERIOD: Final = 0.25  # seconds between looks
VISITOR: Final = "autoqos"  # what its questions to ports are known by
TIMEOUT: Final = 2.5  # seconds for an answer: over a full link it takes a while
AWAY: Final = 1.0  # seconds until a name server is asked again


@dataclass(frozen=True, slots=True)
class Event:
    """An action of the agent, or a finding: `time` in seconds since 1970, and the changes that
    ports `failed` to make."""

    time: float
    text: str
    changes: tuple[Change, ...] = ()
    failed: tuple[tuple[Change, str], ...] = ()


class Agent:
    """Steers until somebody interrupts it. `tell` gets an Event for each step."""

    def __init__(
        self,
        rules: Rules,
        tell: Callable[[Event], None],
        journal: Journal | None,
        names: NameClient | None = None,
        period: float = PERIOD,
        timeout: float = TIMEOUT,
    ) -> None:
        self._sampler = Sampler(names, timeout=timeout, urgent=VISITOR)
        self._controls = Controls(self._sampler.ask, names)
        self._governor = Governor(rules, trusting=journal is None)
        self._journal = journal
        self._tell = tell
        self._period = period
        self._away = False

    def run(self, going: Callable[[], bool] = lambda: True) -> None:
        """Look and act while `going`; then, or when interrupted, leave all as it was found."""
        try:
            self._undo("an agent that was killed left")
            due = time.monotonic()
            while going():
                self.look()
                due = max(due + self._period, time.monotonic())
                time.sleep(max(0.0, due - time.monotonic()))
        finally:
            try:
                self._undo("as it was found:")
            finally:
                self._sampler.close()

    def look(self) -> None:
        """Look once, and make a step if one is due."""
        try:
            snapshot = self._sampler.look()
        except NoNameServer as error:
            if not self._away:
                self._tell(Event(time.time(), f"no name server answers, waiting: {error}"))
            self._away = True
            time.sleep(AWAY)
            return
        self._away = False
        now = time.monotonic()
        step = self._governor.decide(snapshot, now)
        if step is not None:
            self._make(step)

    def _make(self, step: Step) -> None:
        failed: dict[Change, str] = {}
        if self._journal is not None:
            for change in step.changes:
                try:
                    self._journal.write(change)
                    self._controls.make(change)
                except (YarpError, OSError, ValueError) as error:
                    failed[change] = str(error)
        self._governor.done(step, failed, time.monotonic())
        self._tell(Event(time.time(), step.why, step.changes, tuple(failed.items())))

    def _undo(self, why: str) -> None:
        """Undo what stands in the journal. What a port does not answer to stays there."""
        if self._journal is None:
            return
        left = self._journal.left()
        if (damaged := self._journal.damaged) > 0:
            self._journal.damaged = 0
            text = f"{damaged} line{'s' if damaged > 1 else ''} of the journal cannot be read: "
            text += f"what they say was changed stays so; {self._journal.copy} has them"
            self._tell(Event(time.time(), text))
        failed: list[tuple[Change, str]] = []
        stays: list[Change] = []
        for change in left:
            try:
                if not self._controls.is_gone(change):
                    self._controls.make(change)
            except (Timeout, NoNameServer) as error:
                stays.append(change)
                failed.append((change, str(error)))
            except LocalProtocolError as error:
                failed.append((change, str(error)))
            except (YarpError, OSError, ValueError):
                pass  # the port has gone, and what was set too
        self._journal.clear()
        for change in reversed(stays):
            self._journal.write(change.undone)
        if left:
            number = f"{len(left)} setting{'s' if len(left) > 1 else ''}"
            self._tell(Event(time.time(), f"{why} {number} undone", tuple(left), tuple(failed)))
