"""Start a program, read what it says while it runs, and leave nothing of it behind.

Rules: output is read by threads of ours, so that a chatty program never blocks on a full pipe;
waiting always has an end, and its error shows what the program had said, and where its threads
were if it hangs; `stop` ends the program and everything it started, by process id, also when the
test failed or the interpreter exits.
"""

import atexit
import contextlib
import os
import re
import select
import signal
import subprocess
import sys
import threading
import time
import weakref
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Final, Literal, Self

from support.wait import HANG

KILL: Final = signal.SIGTERM if sys.platform == "win32" else signal.SIGKILL  # none refuses it

_running: weakref.WeakSet["Process"] = weakref.WeakSet()


class Process:
    """A running program with captured output. Use as a context manager, or call `stop`."""

    def __init__(
        self,
        args: Sequence[str | os.PathLike[str]],
        *,
        env: Mapping[str, str] | None = None,
        cwd: str | os.PathLike[str] | None = None,
        start: Callable[..., Any] = subprocess.Popen,
    ) -> None:
        self.args = [os.fspath(arg) for arg in args]
        self.lines: list[tuple[str, str]] = []  # ("out" | "err", text without line end)
        self._changed = threading.Condition()
        self._open_streams = 2
        self._popen = start(
            self.args,
            env={**(os.environ if env is None else env), "PYTHONFAULTHANDLER": "1"},
            cwd=cwd,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            # A session of its own: one signal reaches the children that did not leave it.
            start_new_session=True,
        )
        _running.add(self)
        for kind in ("out", "err"):
            threading.Thread(
                target=self._collect, args=(kind,), name=f"{kind} of {self.pid}", daemon=True
            ).start()

    @property
    def pid(self) -> int:
        return self._popen.pid

    @property
    def returncode(self) -> int | None:
        """Exit code, None while the program runs (negative: the signal that ended it)."""
        return self._popen.poll()

    @property
    def stdout(self) -> str:
        """What the program has written so far to its standard output."""
        return self._text("out")

    @property
    def stderr(self) -> str:
        return self._text("err")

    def write(self, text: str) -> None:
        """Put text on the program's standard input, as it is."""
        assert self._popen.stdin is not None
        self._popen.stdin.write(text.encode("utf-8", "surrogateescape"))
        self._popen.stdin.flush()

    def write_line(self, text: str = "") -> None:
        """Type a line on the program's standard input."""
        self.write(text + "\n")

    def end_input(self) -> None:
        """Close the program's standard input, as ^D does."""
        assert self._popen.stdin is not None
        with contextlib.suppress(BrokenPipeError):
            self._popen.stdin.close()

    def wait_line(
        self,
        pattern: str,
        *,
        timeout: float = HANG,
        count: int = 1,
        stream: Literal["out", "err", "any"] = "any",
    ) -> re.Match[str]:
        """The match of the `count`-th line that contains `pattern`, said before or from now on.

        AssertionError with everything the program said when it ends or `timeout` seconds pass.
        """
        deadline = time.monotonic() + timeout
        seen, found = 0, 0
        with self._changed:
            while True:
                for kind, line in self.lines[seen:]:
                    if stream in (kind, "any") and (match := re.search(pattern, line)):
                        found += 1
                        if found == count:
                            return match
                seen = len(self.lines)
                left = deadline - time.monotonic()
                if self._open_streams == 0:
                    raise AssertionError(f"{self} ended without saying {pattern!r}{self.said()}")
                if left <= 0:
                    break
                self._changed.wait(left)
        said = self._last_words(timeout)
        raise AssertionError(f"{self} did not say {pattern!r} in time{said}")

    def wait(self, timeout: float = HANG) -> int:
        """Wait for the end, and for the last words; the exit code."""
        deadline = time.monotonic() + timeout
        try:
            code = self._popen.wait(timeout)
        except subprocess.TimeoutExpired:
            said = self._last_words(timeout)
            raise AssertionError(f"{self} still runs after {timeout} s{said}") from None
        with self._changed:
            # A grandchild may hold the pipes open: what it says later is not waited for.
            while self._open_streams and (left := min(deadline - time.monotonic(), 1.0)) > 0:
                if not (self._changed.wait(left) or self._has_more()):
                    break
        return code

    def _has_more(self) -> bool:
        """Return whether output, or its end, waits to be read."""
        if sys.platform == "win32":
            return False
        waiting = select.poll()
        try:
            for pipe in (self._popen.stdout, self._popen.stderr):
                assert pipe is not None
                if not pipe.closed:
                    waiting.register(pipe, select.POLLIN)
        except ValueError:  # closed just now
            return True
        return bool(waiting.poll(0))

    def signal(self, number: int) -> None:
        """Send a signal to the program alone; where no program can, the test ends here."""
        if sys.platform == "win32":
            import pytest

            pytest.skip("Windows has no signals to other programs, and wine no Ctrl-Break to them")
        self._popen.send_signal(number)

    def kill(self) -> None:
        """End the program and all it started at once, as a crash would."""
        for pid in (*descendants(self.pid), self.pid):
            _send(pid, KILL)
        self._popen.wait(HANG)
        self.end_input()

    def stop(self, grace: float = 5.0) -> None:
        """End the program and all it started: ask, wait `grace` seconds, then kill."""
        # The children are listed first: when their parent is gone nobody knows whose they were.
        family = [*descendants(self.pid), self.pid]
        if self._popen.poll() is None:
            self._popen.terminate()
            with contextlib.suppress(subprocess.TimeoutExpired):
                self._popen.wait(grace)
        for pid in family:
            if pid != self.pid or self._popen.poll() is None:
                _send(pid, KILL)
        self._popen.wait(HANG)
        self.end_input()
        _running.discard(self)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def __repr__(self) -> str:
        return f"{Path(self.args[0]).name} {' '.join(self.args[1:])} (pid {self.pid})"

    def _collect(self, kind: str) -> None:
        pipe = self._popen.stdout if kind == "out" else self._popen.stderr
        assert pipe is not None
        with pipe:
            for raw in pipe:
                line = raw.decode("utf-8", "surrogateescape").rstrip("\r\n")
                with self._changed:
                    self.lines.append((kind, line))
                    self._changed.notify_all()
        with self._changed:
            self._open_streams -= 1
            self._changed.notify_all()

    def _text(self, wanted: str) -> str:
        with self._changed:
            return "".join(line + "\n" for kind, line in self.lines if kind == wanted)

    def _last_words(self, waited: float) -> str:
        """What it said; and if it hangs, which ends it, where the threads of its Pythons were."""
        if waited >= HANG and sys.platform != "win32":
            for pid in (*descendants(self.pid), self.pid):
                with contextlib.suppress(OSError):
                    if (
                        "python"
                        in Path(f"/proc/{pid}/cmdline").read_text(encoding="utf-8").split("\0")[0]
                    ):
                        _send(pid, signal.SIGABRT)
            with contextlib.suppress(subprocess.TimeoutExpired):
                self._popen.wait(5)
            with self._changed:
                self._changed.wait_for(lambda: self._open_streams == 0, 1)
        return self.said()

    def said(self) -> str:
        return "; it said:" + "".join(f"\n  {kind}| {line}" for kind, line in self.lines)


def descendants(pid: int) -> list[int]:
    """Process ids of the children, grandchildren ... of `pid`, the deepest first; also of those
    that lost their parent, if they stayed in its session. None where Linux' /proc is not ours."""
    children: dict[int, list[int]] = {}
    companions = []
    for child, parent, session in _processes():
        children.setdefault(parent, []).append(child)
        if session == pid != child:
            companions.append(child)

    def walk(parent: int) -> Iterator[int]:
        for child in children.get(parent, ()):
            yield from walk(child)
            yield child

    found = list(walk(pid))
    return [*found, *(one for one in companions if one not in found)]


def _processes() -> Iterator[tuple[int, int, int]]:
    """Each process, its parent, and its session."""
    if sys.platform == "win32":  # wine shows Linux' /proc, whose numbers mean other processes
        return
    for entry in Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(OSError):
            # The second field, the name in brackets, may itself hold blanks and brackets.
            fields = entry.read_text().rpartition(")")[2].split()
            yield int(entry.parent.name), int(fields[1]), int(fields[3])


def _send(pid: int, number: int) -> None:
    with contextlib.suppress(OSError):  # it has ended, or is another user's
        os.kill(pid, number)


@atexit.register
def _stop_all() -> None:
    for process in list(_running):
        process.stop(grace=0.5)
