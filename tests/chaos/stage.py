"""Where it happens: a name server, the programs of `peers.py`, and what they have said.

with Stage() as stage:
    reader = stage.read("/chaos/in")
    writer = stage.write("/chaos/out", "/chaos/in", "tcp", 500)
    reader.process.kill()
"""

from __future__ import annotations

import json
import os
import sys
import threading
import time
from contextlib import ExitStack
from pathlib import Path
from subprocess import PIPE, Popen
from typing import Any, Self

import yarpy

PEERS = Path(__file__).with_name("peers.py")
PATIENCE = 60.0


class Program:
    """A running peer; `said` are its lines with the times when they came."""

    def __init__(
        self, environment: dict[str, str], *arguments: str, before: tuple[str, ...] = ()
    ) -> None:
        command = [*before, sys.executable, str(PEERS), *arguments]
        self.process: Popen[str] = Popen(
            command, stdin=PIPE, stdout=PIPE, env={**os.environ, **environment}, text=True
        )
        self.said: list[tuple[float, str]] = []
        self._thread = threading.Thread(target=self._listen, daemon=True)
        self._thread.start()
        self.ready_at = self.wait_for(lambda: self.said)[0]

    def _listen(self) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            self.said.append((time.monotonic(), line.strip()))

    def wait_for(self, what: Any) -> tuple[float, str]:
        """The last line once `what()` holds."""
        deadline = time.monotonic() + PATIENCE
        while not what():
            if time.monotonic() > deadline:
                raise AssertionError(f"{self.process.args}: nothing in {PATIENCE} s")
            time.sleep(0.001)
        return self.said[-1]

    @property
    def numbers(self) -> list[int]:
        return [int(line) for _, line in self.said[1:] if line.isdigit()]

    @property
    def times(self) -> list[float]:
        return [at for at, line in self.said[1:] if line.isdigit()]

    def kill(self) -> None:
        self.process.kill()
        self.process.wait()
        self._thread.join(PATIENCE)

    def end(self) -> dict[str, int]:
        """Let a writer end in good order; its counters."""
        assert self.process.stdin is not None
        self.process.stdin.close()
        self.process.wait(PATIENCE)
        self._thread.join(PATIENCE)
        found: dict[str, int] = json.loads(self.said[-1][1])
        return found


class Stage:
    """A name server at `host`, and programs; all end with it."""

    def __init__(self, host: str = "127.0.0.1") -> None:
        self._stack = ExitStack()
        self._host = host

    def __enter__(self) -> Self:
        self.server = self._stack.enter_context(yarpy.NameServer(host=self._host))
        return self

    def __exit__(self, *details: object) -> None:
        self._stack.close()

    def _start(self, *arguments: str, before: tuple[str, ...] = ()) -> Program:
        program = Program(dict(self.server.environment), *arguments, before=before)
        self._stack.callback(self._stop, program)
        return program

    def _stop(self, program: Program) -> None:
        if program.process.poll() is None:
            program.kill()
        for pipe in (program.process.stdin, program.process.stdout):
            if pipe is not None:
                pipe.close()

    def read(self, name: str, pause: float = 0.0, before: tuple[str, ...] = ()) -> Program:
        """`before`: words before the command, such as those that name another network."""
        return self._start("read", name, str(pause), before=before)

    def crowd(self, port: int, count: int, seconds: float, word: str) -> Program:
        return self._start("crowd", str(port), str(count), str(seconds), word)

    def write(
        self,
        out: str,
        target: str,
        carrier: str,
        hertz: float,
        *options: str,
        before: tuple[str, ...] = (),
    ) -> Program:
        return self._start("write", out, target, carrier, str(hertz), *options, before=before)
