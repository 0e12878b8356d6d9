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
KINDS = pytest.mark.parametrize("kind", ["-m", "-c", "file"])
CODE = """
import atexit, os, sys
atexit.register(print, "over")
def later():
    return sys.argv[1:], os.path.basename(globals().get("__file__", "")), "runpy" in globals()
print(sys.path[0], [one for one in sys.path if "wanted" in one])
print(__name__, later(), os.getcwd(), os.environ.get("MINE"), os.getsid(0) == os.getpid())
print(sys.stdout.isatty(), sys.stdout.encoding, sys.stdout.line_buffering, sys.flags.dev_mode)
print(sorted(os.listdir("/proc/self/fd"))[:-1], file=sys.stderr)
for line in sys.stdin:
    print("read", line.strip(), flush=True)
    if line.startswith("exit"):
        sys.exit(int(line[4:]))
    if line.startswith("fail"):
        raise ValueError("it fails")
"""


def program(start, folder: Path, *words: str, kind: str = "-m", **variables: str) -> Process:
    script = folder / "prog.py"
    if not script.exists():  # another program may be reading it just now
        script.write_text(CODE, encoding="utf-8")
    how = {"-m": ["-m", "prog"], "-c": ["-c", CODE], "file": [str(script)]}[kind]
    args = [sys.executable, *how, *words]
    return Process(args, env={**os.environ, **variables}, cwd=folder, start=start)


@KINDS
@STARTS
def test_what_a_program_has(start, kind: str, tmp_path: Path) -> None:
    variables = {"MINE": "5", "PYTHONPATH": "/wanted/a:/wanted/b"}
    with program(start, tmp_path, "a", "b", kind=kind, **variables) as one:
        one.write_line("hello")
        one.write_line("exit 3")
        assert one.wait() == 3 == one.returncode
    name = "" if kind == "-c" else "prog.py"
    assert one.stdout.splitlines() == [
        f"{'' if kind == '-c' else tmp_path} ['/wanted/a', '/wanted/b']",
        f"__main__ (['a', 'b'], '{name}', False) {tmp_path} 5 True",
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
        one.wait_line("^ValueError: it fails$", stream="err")
        one.wait_line("^over$", stream="out")
        assert other.returncode is None
        other.write_line("x")
        other.wait_line("read x")
        other.signal(signal.SIGINT)
        assert other.wait() == -signal.SIGINT
        other.wait_line("^KeyboardInterrupt$", stream="err")
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
