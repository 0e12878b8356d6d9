"""Programs on this computer, each in a session of its own, on Windows in a job.

Rules: what a program leaves behind ends with it: once its first process has ended, the others get
SIGTERM, and after `grace` seconds SIGKILL. A program that does not end when it is asked to gets
SIGKILL after the same time. On Windows Ctrl-Break asks, TerminateJobObject is SIGKILL, and the end
of this process, however it comes, is that of all programs. Its output is read to the end, however
much it is. Two threads serve one program and sleep while nothing happens: one for its output, one
for its end.
"""

from __future__ import annotations

import math
import os
import signal
import subprocess
import threading
import time
from collections.abc import Callable
from typing import Final

from yarpy.kits.launch.supervise import process
from yarpy.kits.launch.supervise.line import Lines
from yarpy.kits.launch.supervise.runner import Program
from yarpy.platform.group import START, Group
from yarpy.platform.process import KILL, signal_one

GRACE: Final = 5.0  # seconds from SIGTERM to SIGKILL
_HELD_OPEN: Final = 1.0  # seconds without a word in which somebody else holds the output open
_LONGEST: Final = 60.0  # seconds for whoever takes the last lines
_UNKILLABLE: Final = 2.0  # seconds after SIGKILL until a process is given up
_POLL: Final = 0.02  # seconds between looks at what is left of a program
_CHUNK: Final = 1 << 16  # bytes


class LocalRunner:
    """Starts programs here. `run` tells the programs of this runner from those of another one,
    `grace` is how long one may take to end."""

    def __init__(self, run: str = "", grace: float = GRACE) -> None:
        self.run = run or f"{os.getpid()}-{time.monotonic_ns()}"
        self.grace = grace
        self._scanner = process.Scanner()

    def mark(self, name: str) -> str:
        """Return what the processes of the program `name` have in their environment."""
        return f"{self.run}/{name}"

    def start(
        self, program: Program, on_line: Callable[[str], None], on_end: Callable[[int], None]
    ) -> LocalHandle:
        """Start a program. Raises OSError."""
        mark = self.mark(program.name)
        try:
            child = subprocess.Popen(
                [*program.command],
                cwd=program.workdir or None,
                env={
                    **os.environ,
                    "PYTHONUNBUFFERED": "1",  # lines are seen when they are written
                    **program.environment,
                    process.MARK: mark,
                },
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                bufsize=0,
                **START,
            )
            group = _grouped(child)
        except OSError as error:
            if error.filename is None:  # Windows does not tell of what it speaks
                error.filename = program.command[0]
            raise
        return LocalHandle(child, group, mark, self.grace, self._scanner, on_line, on_end)


class LocalHandle:
    """A program that runs here."""

    def __init__(
        self,
        child: subprocess.Popen[bytes],
        group: Group,
        mark: str,
        grace: float,
        scanner: process.Scanner,
        on_line: Callable[[str], None],
        on_end: Callable[[int], None],
    ) -> None:
        self._child = child
        self._group = group
        self._mark = mark
        self._grace = grace
        self._scanner = scanner
        self._on_line = on_line
        self._on_end = on_end
        self._code: int | None = None
        self._ended = threading.Event()
        self._told = threading.Lock()  # no line comes after the end
        self._over = False
        self._read_last = 0.0  # when it began to wait for output, inf while it hands some on
        self.detail = ""
        self.left_behind = 0
        """The number of its processes that were there when the first one had ended."""
        self.remaining: list[int] = []
        """Those that not even SIGKILL has ended."""
        self._timer: threading.Timer | None = None
        reader = threading.Thread(target=self._read, name=f"yarpy output {mark}", daemon=True)
        reader.start()
        threading.Thread(
            target=self._follow, args=(reader,), name=f"yarpy end {mark}", daemon=True
        ).start()

    @property
    def pid(self) -> int:
        """The number of its first process, which is that of its session, too."""
        return self._child.pid

    @property
    def state(self) -> str:
        """`running` or `ended`."""
        return "ended" if self._ended.is_set() else "running"

    @property
    def returncode(self) -> int | None:
        """The exit code, or minus the number of a signal; None until all of it has ended."""
        return self._code if self._ended.is_set() else None

    def terminate(self, number: int = signal.SIGTERM) -> None:
        """Send a signal to all that belongs to the program, and after a while SIGKILL if it asks
        to end; nothing if it has ended."""
        if self._ended.is_set():
            return
        self._group.signal(number)
        if number in (signal.SIGTERM, signal.SIGINT) and self._timer is None:
            timer = threading.Timer(self._grace, self._group.signal, (KILL,))
            timer.daemon = True
            timer.name = f"yarpy grace {self._mark}"
            self._timer = timer
            timer.start()

    def wait(self, timeout: float | None = None) -> int | None:
        """Return what it ended with, None if some of it still runs after `timeout` seconds."""
        self._ended.wait(timeout)
        return self.returncode

    def _read(self) -> None:
        out = self._child.stdout
        assert out is not None
        lines = Lines()
        with out:
            while True:
                self._read_last = time.monotonic()
                try:
                    data = out.read(_CHUNK)
                except OSError:
                    break
                self._read_last = math.inf
                if not data:
                    break
                for line in lines.feed(data):
                    self._tell(line)
        for line in lines.rest():
            self._tell(line)

    def _tell(self, line: str) -> None:
        with self._told:
            if not self._over:
                self._on_line(line)

    def _follow(self, reader: threading.Thread) -> None:
        self._code = self._child.wait()
        if self._timer is not None:
            self._timer.cancel()
        self._sweep()
        self._hear_out(reader)
        with self._told:
            self._over = True
        self._ended.set()
        self._on_end(self._code)

    def _hear_out(self, reader: threading.Thread) -> None:
        """Wait until what was written before the end is told, however slowly that is taken; not for
        somebody who has escaped and holds the output open."""
        swept = time.monotonic()
        while reader.is_alive():
            now = time.monotonic()
            if now - max(swept, self._read_last) > _HELD_OPEN or now - swept > _LONGEST:
                return
            reader.join(_POLL)

    def _sweep(self) -> None:
        """End what the first process has left behind."""
        left = self._others()
        self.left_behind = len(left)
        until = time.monotonic() + self._grace
        number = int(signal.SIGTERM)
        while left:
            if number:
                self._send(left, number)
            passed = time.monotonic() - until
            if passed > _UNKILLABLE:
                break  # another user's by now, or asleep in the system
            number = KILL if passed > 0 else 0
            time.sleep(_POLL)
            left = self._others()
        self.remaining = left

    def _others(self) -> list[int]:
        if process.known():
            sessions = {self.pid: self._mark}
            return [*process.members(sessions, {self._mark}, self._scanner.scan)]
        return self._group.members()

    def _send(self, pids: list[int], number: int) -> None:
        if process.known():
            for pid in pids:
                signal_one(pid, number)
        else:
            self._group.signal(number)


def _grouped(child: subprocess.Popen[bytes]) -> Group:
    """Return the group of a program that has just been started. Raises OSError."""
    try:
        return Group(child.pid)
    except OSError:
        child.kill()  # it has done nothing yet
        with child:
            raise
