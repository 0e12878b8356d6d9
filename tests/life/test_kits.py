"""What kits leave that a program does not close, by whatever it ends: files are finished, programs
that end with their server have ended, names are given back.

Rules: each program is a process of its own, with a name server here; which end it takes is a line
of Python.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import textwrap
from collections.abc import Iterator
from pathlib import Path

import pytest
from support.wait import HANG, wait_until

import yarpy

pytestmark = pytest.mark.skipif(os.name != "posix", reason="the ends are those of Unix")

ENDS = {
    "the end of the file": "",
    "sys.exit": "sys.exit(3)",
    "an exception": "raise ZeroDivisionError",
    "Ctrl-C": "os.kill(os.getpid(), signal.SIGINT); time.sleep(60)",
    "SIGTERM": "os.kill(os.getpid(), signal.SIGTERM); time.sleep(60)",
    "a forked child that ends before": """
        child = os.fork()
        if child == 0:
            sys.exit(7)
        assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 7
    """,
    "a forked child that leaves `with`": """
        child = os.fork()
        if child == 0:
            with thing:
                sys.exit(7)
        assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 7
        assert_lives()
    """,
}
STATUS = {"sys.exit": 3, "an exception": 1, "Ctrl-C": -2, "SIGTERM": -15}
BEGIN = """
import os, signal, sys, time
import yarpy
signal.signal(signal.SIGINT, signal.default_int_handler)  # whatever the shell of the tests ignores
"""


@pytest.fixture(scope="module")
def server() -> Iterator[yarpy.NameServer]:
    with yarpy.NameServer() as server:
        yield server


def run(program: str, end: str, folder: Path, server: yarpy.NameServer) -> str:
    """Run a program that opens `thing`, to that end; what it has printed."""
    done = subprocess.run(
        [sys.executable, "-c", BEGIN + textwrap.dedent(program) + textwrap.dedent(ENDS[end])],
        env={**os.environ, **server.environment, "YARPY_LINGER": "20"},  # the machine may be busy
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=3 * HANG,
    )
    assert done.returncode == STATUS.get(end, 0), done.stderr
    assert done.stderr.count("Traceback") == (end in ("an exception", "Ctrl-C")), done.stderr
    return done.stdout


@pytest.mark.parametrize("end", ENDS)
def test_a_recording_is_finished(end: str, tmp_path: Path, server: yarpy.NameServer) -> None:
    pytest.importorskip("mcap", reason='recordings: pip install "yarpy[record]"')
    program = """
    port = yarpy.Port("/kits/out", timeout=60)
    thing = yarpy.record.Recorder("/kits/out", path="walk", name="/kits/record")
    def assert_lives(): assert port.write([100], wait=True, timeout=60) == 1
    assert port.wait_for_outputs(timeout=60)
    for number in range(100): port.write([number], wait=True)
    """
    run(program, end, tmp_path, server)
    count = 101 if "with" in end else 100
    with yarpy.record.open(tmp_path / "walk.mcap") as recording:
        assert [message.value for message in recording] == [[number] for number in range(count)]
        assert recording.complete
    assert server.client.query("/kits/record") is None


@pytest.mark.parametrize("end", ENDS)
def test_programs_end_with_their_server(end: str, tmp_path: Path, server: yarpy.NameServer) -> None:
    program = """
    from yarpy.kits.launch.run.client import RunClient
    from yarpy.kits.launch.run.server import RunServer
    thing = RunServer("/kits/node", ends=True, folder="books")
    def assert_lives(): assert client.is_running("nap")
    client = RunClient("/kits/node", timeout=60)
    print(client.start("nap", ["sleep", "600"]).pid)
    """
    pid = int(run(program, end, tmp_path, server))
    try:
        wait_until(lambda: not _runs(pid))
    finally:
        if _runs(pid):
            os.kill(pid, signal.SIGKILL)
    assert server.client.query("/kits/node") is None


def _runs(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True
