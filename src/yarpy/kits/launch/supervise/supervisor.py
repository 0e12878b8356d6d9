"""An application that runs: its units, its connections, and how all of it ends.

Rules: what starts programs is handed in, by computer. What was ended by hand is not over: it can be
started again. Stopping goes from the last that was started
to the first: what had to wait for others ends before them, the rest side by side.
"""

from __future__ import annotations

import itertools
import threading
import time
from collections.abc import Callable
from typing import Any, Final

from yarpy.errors import UnknownName
from yarpy.kits.launch.application.application import Application, Module
from yarpy.kits.launch.document.advice import advice
from yarpy.kits.launch.supervise import process
from yarpy.kits.launch.supervise.connections import Connections
from yarpy.kits.launch.supervise.difference import difference
from yarpy.kits.launch.supervise.local import GRACE, LocalRunner
from yarpy.kits.launch.supervise.runner import Runner
from yarpy.kits.launch.supervise.unit import FINAL, Unit
from yarpy.kits.launch.supervise.waiting import PORT_TIMEOUT, Waiting
from yarpy.names.base import NameClient

_KILLED: Final = 20.0  # seconds beyond the grace in which a program is gone, on a busy computer too
_SAMPLE: Final = 1.0  # seconds between looks at processors and memory


class Supervisor:
    """Runs an application from `start` to `stop`.

    `runners` gives what starts programs on another computer; `usual` is the policy of restarts
    where a program has none, `port_timeout` how many seconds a port is waited for, `grace` how many
    a program may take to end; `news` gets lines for people.
    """

    def __init__(
        self,
        application: Application,
        *,
        runners: Callable[[str], Runner] | None = None,
        usual: str = "on-failure",
        port_timeout: float = PORT_TIMEOUT,
        grace: float = GRACE,
        news: Callable[[str, str], None] = lambda label, text: None,
        said: Callable[[str, str], None] = lambda label, line: None,
        names: NameClient | None = None,
    ) -> None:
        self.application = application
        self.local = LocalRunner(grace=grace)
        self.grace = grace
        self.over = threading.Event()
        """Set once nothing runs and nothing will, or by whoever wants it to stop."""
        self._news = news
        self._said = said
        self._runners = runners
        self._lock = threading.Lock()  # of `_count` and the waves
        self._count = 0
        self._waves: dict[str, int] = {}
        self._sampled: tuple[float, dict[str, tuple[float, int]]] = (0.0, {})
        self._usage: dict[str, tuple[float, int]] = {}
        self.connections = Connections(application.connections, names)
        self.waiting = Waiting(self.find, port_timeout, names)
        self._off: set[str] = set()  # programs that were ended by hand
        self._usual = usual
        self._number = itertools.count(1).__next__
        self.units = {module.label: self._unit(module) for module in application.modules}

    def find(self, label: str) -> Unit:
        """Return a unit. Raises UnknownName, which names the nearest one."""
        if label not in self.units:
            raise UnknownName(f'no program is called "{label}"{advice(label, [*self.units])}')
        return self.units[label]

    def rest(self) -> None:
        """Begin without starting anything: programs and connections are off until somebody wants
        them."""
        self._off = set(self.units)
        for unit in self.units.values():
            unit.state, unit.detail = "stopped", "not started yet"
        self.connections.rest()
        self.connections.start()

    def start(self) -> str:
        """Start all. Return "", or why the application cannot: a port that it needs is missing."""
        never = threading.Event()
        for need in self.application.needs:
            if need.timeout:
                self._news("", f"waiting for {need.port}")
                if why := self.waiting.wait_for(need, never):
                    return f"{need.where}: {why}"
        self.connections.start()
        for unit in self.units.values():
            unit.start()
        return ""

    def restart(self, label: str) -> None:
        """End a program and start it again. Raises UnknownName."""
        self.find(label).restart()
        self._turn_on(label)

    def begin(self, label: str) -> None:
        """Start a program that has ended, or was taken off, also while it ends. Raises
        UnknownName."""
        unit = self.find(label)
        if unit.state in (*FINAL, "stopping"):
            unit.restart()
        self._turn_on(label)

    def _turn_on(self, label: str) -> None:
        """Let the end of a program count again, once nobody can take it for ended."""
        self._off.discard(label)
        self._look_whether_over()

    def take_off(self, label: str, at_once: bool = False) -> None:
        """End a program, until it is started again by hand; `at_once` with SIGKILL. Raises
        UnknownName."""
        unit = self.find(label)
        self._off.add(label)
        unit.stop()
        if at_once:
            unit.kill()

    def change(self, application: Application) -> list[str]:
        """Become another application: programs that are new are started, those that are not there
        any more end, those that are described otherwise end and start again; connections alike.
        Return what was done, for people."""
        done = difference(self.application, application)
        self.application = application
        for label in (*done.gone, *done.other):
            self._off.add(label)  # nothing is over while they end
            self.units[label].stop()
        for label in (*done.gone, *done.other):
            unit = self.units[label]
            unit.join(self.grace + _KILLED + unit.module.rest)
        modules = {module.label: module for module in application.modules}
        new = {label: self._unit(modules[label]) for label in (*done.new, *done.other)}
        self.units = {label: new.get(label) or self.units[label] for label in modules}
        self._off.difference_update(done.gone, done.other)
        self.connections.replace(application.connections)
        for unit in new.values():
            unit.start()
        return [*done.texts()]

    def stop(self) -> list[str]:
        """Stop all, in reverse; return what would not end."""
        left: list[str] = []
        self.connections.close()
        for unit in self.units.values():
            if not unit.running:
                unit.stop()  # it waits, or pauses
        for wave in sorted({*self._waves.values()}, reverse=True):
            units = [
                unit for unit in reversed(self.units.values())
                if self._waves.get(unit.label) == wave
            ]  # fmt: skip
            units.sort(key=lambda unit: -unit.order)
            for unit in units:
                unit.stop()
            until = time.monotonic() + self.grace + _KILLED
            for unit in units:
                if not unit.join(max(until + unit.module.rest - time.monotonic(), 0.0)):
                    left.append(unit.label)
        until = time.monotonic() + self.grace + _KILLED
        for unit in self.units.values():  # what was just being started is in no wave
            if unit.label not in left and not unit.join(max(until - time.monotonic(), 0.0)):
                left.append(unit.label)
        self.over.set()
        return left

    @property
    def failed(self) -> list[str]:
        """Programs that have failed, each with the reason."""
        units = self.units.values()
        return [f"{one.label}: {one.detail}" for one in units if one.state == "failed"]

    def kill(self) -> None:
        """End all at once."""
        for unit in self.units.values():
            unit.kill()

    def sessions(self) -> dict[int, str]:
        """Return the labels of the programs that run here, each by its session."""
        return {
            unit.handle.pid: unit.label
            for unit in self.units.values()
            if unit.running and unit.handle is not None and not unit.module.node
        }

    def lines(self, label: str = "", since: int = 0, most: int = 100) -> list[tuple[int, str, str]]:
        """Return the newest lines of one program, or of all: `most` of those with numbers above
        `since`, each with its number and the program's name. Raises UnknownName."""
        units = [self.find(label)] if label else [*self.units.values()]
        found = [
            (number, unit.label, line)
            for unit in units
            for number, line in unit.lines.copy()
            if number > since
        ]
        found.sort()
        return found[-most:] if most > 0 else []

    def status(self) -> dict[str, Any]:
        """Return how all of it is doing, as JSON has it; processors in per cent of one."""
        usage = self._sample()
        now = time.monotonic()
        programs = []
        for unit in self.units.values():
            handle = unit.handle if unit.running else None
            share, memory = usage.get(unit.label, (None, None))
            lost = _lost(unit)
            programs.append(
                {
                    "name": unit.label,
                    "state": unit.state if not lost else "unknown",
                    "detail": lost or unit.detail,
                    "host": unit.module.node or "here",
                    "pid": handle.pid if handle is not None else None,
                    "cpu": None if share is None else round(share, 1),
                    "memory": memory,
                    "seconds": round(now - unit.started, 1) if handle is not None else None,
                    "restarts": unit.restarts,
                    "line": unit.lines[-1][1] if unit.lines else "",
                }
            )
        connections = [
            {
                "from": link.wanted.source,
                "to": link.wanted.target,
                "carrier": link.wanted.carrier,
                "state": link.state,
                "detail": link.detail,
                "made": link.made,
            }
            for link in self.connections.links
        ]
        return {
            "application": self.application.name,
            "programs": programs,
            "connections": connections,
        }

    def _unit(self, module: Module) -> Unit:
        return Unit(
            module,
            self._runner(module.node),
            self.waiting,
            usual=self._usual,
            number=self._number,
            changed=self._changed,
            said=lambda unit, line: self._said(unit.label, line),
        )

    def _runner(self, node: str) -> Runner:
        if not node:
            return self.local
        if self._runners is None:
            raise UnknownName(f'there is nothing that starts programs at "{node}"')
        return self._runners(node)

    def _changed(self, unit: Unit) -> None:
        if unit.state == "running":
            self._place(unit)
        if unit.state in ("running", *FINAL, "pausing"):
            self.connections.touch()
        if unit.state == "running":
            text = f"running (pid {unit.handle.pid})" if unit.handle is not None else "running"
            self._news(unit.label, text)
        elif unit.state != "waiting":
            self._news(unit.label, f"{unit.state}: {unit.detail}" if unit.detail else unit.state)
        if unit.state in FINAL:
            self._look_whether_over()

    def _look_whether_over(self) -> None:
        if all(one.over and one.label not in self._off for one in self.units.values()):
            self.over.set()

    def _place(self, unit: Unit) -> None:
        """Say when a program is to be stopped: before those that it had to wait for."""
        with self._lock:
            self._count += 1
            unit.order = self._count
            if unit.module.needs or unit.module.after:
                others = (wave for label, wave in self._waves.items() if label != unit.label)
                self._waves[unit.label] = max(others, default=0) + 1
            else:
                self._waves.setdefault(unit.label, 0)

    def _sample(self) -> dict[str, tuple[float, int]]:
        """Return the per cent of a processor, since the last look or its start, and the bytes of
        memory of each that runs here."""
        now = time.monotonic()
        then, before = self._sampled
        if now - then < _SAMPLE:
            return self._usage
        found = process.usage(self.sessions())
        self._usage = {}
        for label, (seconds, memory) in found.items():
            started = self.units[label].started
            if started >= then:  # it was not there at the last look
                share = seconds / max(now - started, _SAMPLE)
            else:
                share = max(seconds - before.get(label, (seconds, 0))[0], 0.0) / (now - then)
            self._usage[label] = 100 * share, memory
        self._sampled = now, found
        return self._usage


def _lost(unit: Unit) -> str:
    """Return why nobody knows how a program is doing, "" if that is known."""
    if not unit.running or unit.handle is None or unit.handle.state != "unknown":
        return ""
    return unit.handle.detail
