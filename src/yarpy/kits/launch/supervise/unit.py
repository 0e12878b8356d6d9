"""One program of an application, from its first wait to its last end.

Rules: a thread of its own takes it through its states: waiting (for others, for ports), running,
pausing (until it is started again), and one of ended, failed, stopped. It sleeps while nothing
happens. What a program does is the only thing that changes a unit, besides `restart` and `stop`.
"""

from __future__ import annotations

import itertools
import signal
import threading
import time
from collections import deque
from collections.abc import Callable
from typing import Final, Protocol

from yarpy.errors import LinkClosed, Timeout, YarpError
from yarpy.kits.launch.application.application import Module
from yarpy.kits.launch.supervise.runner import Handle, Program, Runner
from yarpy.limit import OUTPUT_LINES
from yarpy.platform.process import KILL

FIRST_PAUSE: Final = 0.1  # seconds before a program is started again; twice that the next time
LONGEST_PAUSE: Final = 30.0
WELL: Final = 10.0  # seconds after which a program is said to run well
TRIES: Final = 10  # starts in a row that did not run so long, until it is given up
FINAL: Final = ("ended", "failed", "stopped")
_COUNT: Final = itertools.count(1)  # the lines of units that are told of no other count


class Waiter(Protocol):
    """Knows when others and ports are there."""

    def wait(self, unit: Unit, stop: threading.Event) -> str:
        """Return as soon as all is there that a unit needs, with "", or why it will not be."""


class Unit:
    """A program, its state, and the last lines of its output.

    `usual` is the policy of restarts where the module says none; `changed` is called after each
    change with the unit, `said` with each line; `number` counts the lines of all.
    """

    def __init__(
        self,
        module: Module,
        runner: Runner,
        waiter: Waiter,
        *,
        usual: str = "on-failure",
        number: Callable[[], int] = _COUNT.__next__,
        changed: Callable[[Unit], None] = lambda unit: None,
        said: Callable[[Unit, str], None] = lambda unit, line: None,
    ) -> None:
        self.module = module
        self.policy = module.restart or usual
        self.state = "waiting"
        self.detail = ""
        """The reason of its state, or the name of the one that it waits for."""
        self.handle: Handle | None = None
        self.code: int | None = None
        self.restarts = 0
        self.started = 0.0  # by the clock of `time.monotonic`
        self.order = 0
        """The number of its first start among all, which are stopped in reverse."""
        self.lines: deque[tuple[int, str]] = deque(maxlen=OUTPUT_LINES)
        """The last ones of its output, each with its number among those of all units."""
        self._number = number
        self._runner = runner
        self._waiter = waiter
        self._changed = changed
        self._said = said
        self._stop = threading.Event()
        self._again = False
        self._silent = ""  # why it was not started, by a server that may be there again soon
        self._ended = threading.Event()
        self._lock = threading.Lock()  # of whether the thread goes on, and begins once more
        self._lives = False
        self._thread: threading.Thread | None = None

    @property
    def label(self) -> str:
        """Its name in the application."""
        return self.module.label

    @property
    def running(self) -> bool:
        """Return whether its process is there."""
        return self.state in ("running", "stopping")

    @property
    def over(self) -> bool:
        """Return whether it has ended, and nobody has asked for it again."""
        with self._lock:
            return self.state in FINAL and not self._again

    def start(self) -> None:
        """Begin. Nothing if it has begun."""
        with self._lock:
            if not self._lives:
                self._lives = True
                self._renew()
                self._thread = threading.Thread(
                    target=self._run, name=f"yarpy unit {self.label}", daemon=True
                )
                self._thread.start()

    def restart(self) -> None:
        """End it, if it runs, and start it at once, whatever its policy is."""
        with self._lock:
            self._again = True
            self._stop.set()  # cuts short what it waits for
            handle = self.handle if self.state == "running" else None
        if handle is not None:
            handle.terminate()
        self.start()  # unless its thread finds `_again`

    def stop(self) -> None:
        """Ask it to end, without waiting for it."""
        with self._lock:
            self._again = False
            self._stop.set()
        if self.state in ("running", "stopping") and self.handle is not None:
            self._enter("stopping")
            self.handle.terminate()

    def kill(self) -> None:
        """End it at once: it had its time."""
        self._stop.set()
        if self.running and self.handle is not None:
            self.handle.terminate(KILL)

    def join(self, timeout: float) -> bool:
        """Wait until it has ended; return whether it has."""
        with self._lock:
            thread = self._thread
        if thread is not None:
            thread.join(timeout)
        return thread is None or not thread.is_alive()

    def _run(self) -> None:
        while True:
            self._live()
            with self._lock:
                if not self._again:
                    self._lives = False  # whoever wants it from now on starts it anew
                    return
                self._renew()

    def _renew(self) -> None:
        """Begin a life; the lock is held."""
        self.state = "waiting"
        self._again = False
        self._stop.clear()

    def _live(self) -> None:
        quick, pause = 0, FIRST_PAUSE
        while True:
            if not self._begin():
                if self._take_again():
                    continue
                return
            if not self._silent:
                self._ended.wait()
            why = self._silent or ending(self.code)
            ran = 0.0 if self._silent else time.monotonic() - self.started
            if self._take_again():
                self.restarts += 1
                continue
            if self._stop.is_set():
                self._rest()
                self._enter("stopped")
                return
            wrong = bool(self._silent) or self.code != 0
            quick = 0 if ran > WELL else quick + 1
            pause = FIRST_PAUSE if ran > WELL else pause
            if self.policy == "no" or (self.policy == "on-failure" and not wrong):
                self._enter("failed" if wrong else "ended", why)
                return
            if quick >= TRIES:
                self._enter("failed", f"given up after {TRIES} starts: {why}")
                return
            self._enter("pausing", f"{why}; again in {pause:g} s")
            if self._stop.wait(pause) and not self._take_again():
                self._enter("stopped")
                return
            pause = min(2 * pause, LONGEST_PAUSE)
            self.restarts += 1

    def _take_again(self) -> bool:
        with self._lock:
            if self._again:
                self._renew()
                return True
            return False

    def _begin(self) -> bool:
        """Wait, and start; return whether it runs, or could not be tried."""
        self._enter("waiting")
        why = self._waiter.wait(self, self._stop)
        if not why and self.module.delay:
            self.detail = f"for {self.module.delay:g} s"
            self._stop.wait(self.module.delay)
        if self._stop.is_set():
            self._enter("stopped")
            return False
        if why:
            self._enter("failed", why)
            return False
        self._ended.clear()
        self.code, self._silent = None, ""
        module = self.module
        program = Program(
            name=self.label,
            command=module.command,
            workdir=module.workdir,
            environment=module.environment,
            stdio=module.stdio,
            host=module.node,
        )
        self.started = time.monotonic()
        try:
            handle = self._runner.start(program, self._line, self._end)
        except (Timeout, LinkClosed) as error:  # its computer is silent, perhaps only just now
            self._silent = f"it cannot be started: {error}"
            return True
        except (OSError, YarpError) as error:
            self._enter("failed", f"it cannot be started: {_said(error)}")
            return False
        self.handle = handle
        self._enter("running")
        if self._stop.is_set() and self.state == "running":  # while it was being started
            if not self._again:
                self._enter("stopping")
            handle.terminate()
        return True

    def _rest(self) -> None:
        if self.module.rest:
            time.sleep(min(self.module.rest, 60.0))

    def _line(self, line: str) -> None:
        self.lines.append((self._number(), line))
        self._said(self, line)

    def _end(self, code: int | None) -> None:
        self.code = code
        self._ended.set()

    def _enter(self, state: str, detail: str = "") -> None:
        self.state, self.detail = state, detail
        self._changed(self)


def ending(code: int | None) -> str:
    """Return how a program has ended, in words.

    >>> ending(-9)
    'killed by SIGKILL'
    """
    if code is None:
        return "ended, and nobody knows how"
    if code >= 0:
        return f"ended with {code}"
    try:
        return f"killed by {signal.Signals(-code).name}"
    except ValueError:
        return f"killed by signal {-code}"


def _said(error: OSError | YarpError) -> str:
    """Return an error without the number that the system has for it."""
    if isinstance(error, OSError) and error.strerror and error.filename is not None:
        return f'"{error.filename}": {error.strerror}'
    return str(error)
