"""`yarpy VERB ...` as a person starts it, against a given name server.

Rules: nothing of this machine's configuration is read or changed. `run` takes no process of its
own, which is enough for what a command says and for its exit code. `start` makes one, which ends
with its `with` block, for signals, ends, and what runs beside the test; `run_alone` waits for its
end. Such a process is forked (`support/fork_server.py`); how the program starts has its own tests.
"""

import contextlib
import io
import logging
import os
import subprocess
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

from support import fork_server
from support.process import Process
from support.wait import HANG

from yarpy.names.default import DEFAULT

YARPY = [sys.executable, "-m", "yarpy"]
_LOGGER = logging.getLogger("yarpy")


class CommandLine:
    """The command and its environment: `home` for files, `variables` say where the server is."""

    def __init__(self, home: Path, variables: Mapping[str, str] | None = None) -> None:
        self.home = home
        self.environment = {
            name: value
            for name, value in os.environ.items()
            if not name.startswith(("YARP_", "YARPY_"))
        }
        self.environment["YARP_CONFIG_HOME"] = str(home / "config")
        self.environment["YARP_DATA_HOME"] = str(home / "data")
        self.environment.update(variables or {})

    def start(self, *words: str) -> Process:
        """Start `yarpy WORDS`; a context manager that ends it."""
        started = fork_server.start
        return Process([*YARPY, *words], env=self.environment, cwd=self.home, start=started)

    def run(self, *words: str, input: str = "") -> "subprocess.CompletedProcess[str]":
        """Run `yarpy WORDS` to its end in this process: output and exit code."""
        from yarpy.cli.main import run

        with (
            _environment(self.environment),
            contextlib.chdir(self.home),
            _streams(input) as (out, err),
            _no_names_of_ours(),
            _own_log(),
        ):
            code = run(words)
        return subprocess.CompletedProcess(["yarpy", *words], code, _text(out), _text(err))

    def run_alone(self, *words: str, input: str = "") -> "subprocess.CompletedProcess[str]":
        """Run `yarpy WORDS` to its end in a process of its own."""
        with self.start(*words) as process:
            with contextlib.suppress(BrokenPipeError):  # it may end without reading
                process.write(input)
            process.end_input()
            code = process.wait(HANG)
            return subprocess.CompletedProcess(process.args, code, process.stdout, process.stderr)


@contextlib.contextmanager
def _environment(wanted: Mapping[str, str]) -> Iterator[None]:
    """Only what differs is touched: threads of the test read variables meanwhile."""
    before = dict(os.environ)

    def change(now: Mapping[str, str], then: Mapping[str, str]) -> None:
        for name in now.keys() - then.keys():
            os.environ.pop(name, None)
        for name, value in then.items():
            if now.get(name) != value:
                os.environ[name] = value

    change(before, wanted)
    try:
        yield
    finally:
        change(dict(os.environ), before)


def _pipe(content: bytes = b"") -> io.TextIOWrapper:
    return io.TextIOWrapper(
        io.BytesIO(content), "utf-8", "surrogateescape", newline="", write_through=True
    )


@contextlib.contextmanager
def _streams(input: str) -> Iterator[tuple[io.TextIOWrapper, io.TextIOWrapper]]:
    before = sys.stdin, sys.stdout, sys.stderr
    out, err = _pipe(), _pipe()
    sys.stdin = _pipe(input.encode("utf-8", "surrogateescape"))
    sys.stdout, sys.stderr = out, err
    try:
        yield out, err
    finally:
        sys.stdin, sys.stdout, sys.stderr = before


def _text(stream: io.TextIOWrapper) -> str:
    stream.flush()
    assert isinstance(stream.buffer, io.BytesIO)
    return stream.buffer.getvalue().decode("utf-8", "surrogateescape")


@contextlib.contextmanager
def _no_names_of_ours() -> Iterator[None]:
    """The command asks the server that its environment tells, over a socket."""
    before, DEFAULT._stack = DEFAULT._stack, []
    try:
        yield
    finally:
        DEFAULT._stack = before


@contextlib.contextmanager
def _own_log() -> Iterator[None]:
    before = [*_LOGGER.handlers], _LOGGER.level, _LOGGER.propagate
    try:
        yield
    finally:
        _LOGGER.handlers, _LOGGER.propagate = before[0], before[2]
        _LOGGER.setLevel(before[1])
