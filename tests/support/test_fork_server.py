"""Forked programs are like started ones."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from support import fork_server
from support.process import Process

pytestmark = pytest.mark.skipif(not hasattr(os, "pidfd_open"), reason="Linux alone has pidfd_open")
STARTS = pytest.mark.parametrize("start", [subprocess.Popen, fork_server.start])
# A module that a program finds where it is started, as with `python -m`.
CODE = """
import atexit, os, sys
atexit.register(print, "over")
print(__name__, sys.argv[1:], os.getcwd(), os.environ.get("MINE"), os.getsid(0) == os.getpid())
print(sys.stdout.isatty(), sys.stdout.encoding, sys.stdout.line_buffering, sys.flags.dev_mode)
print(sorted(os.listdir("/proc/self/fd"))[:-1], file=sys.stderr)
for line in sys.stdin:
    print("read", line.strip(), flush=True)
    if line.startswith("exit"):
        sys.exit(int(line[4:]))
    if line.startswith("fail"):
        raise ValueError("it fails")
"""


def program(start, folder: Path, *words: str, **variables: str) -> Process:
    (folder / "prog.py").write_text(CODE, encoding="utf-8")
    args = [sys.executable, "-m", "prog", *words]
    return Process(args, env={**os.environ, **variables}, cwd=folder, start=start)


@STARTS
def test_what_a_program_has(start, tmp_path: Path) -> None:
    with program(start, tmp_path, "a", "b", MINE="5") as one:
        one.write_line("hello")
        one.write_line("exit 3")
        assert one.wait() == 3 == one.returncode
    assert one.stdout.splitlines() == [
        f"__main__ ['a', 'b'] {tmp_path} 5 True",
        "False utf-8 False False",
        "read hello",
        "read exit 3",
        "over",
    ]
    assert one.stderr == "['0', '1', '2']\n"


@STARTS
def test_an_error_and_a_signal(start, tmp_path: Path) -> None:
    with program(start, tmp_path) as one, program(start, tmp_path) as other:
        one.write_line("fail")
        assert one.wait() == 1
        assert one.stderr.endswith("ValueError: it fails\n") and one.stdout.endswith("over\n")
        assert other.returncode is None
        other.write_line("x")
        other.wait_line("read x")
        other.signal(signal.SIGINT)
        assert other.wait() in (-signal.SIGINT, 1) and "KeyboardInterrupt" in other.stderr
    with program(start, tmp_path) as last:
        last.write_line("x")
        last.wait_line("read x")
        last.kill()
        assert last.wait() == -signal.SIGKILL


def test_what_python_reads_when_it_starts_needs_a_start(tmp_path: Path) -> None:
    with program(fork_server.start, tmp_path, PYTHONDEVMODE="1") as one:
        one.end_input()
        assert one.wait() == 0
    assert "False utf-8 False True" in one.stdout
