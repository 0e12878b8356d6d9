"""`yarpy top`."""

import itertools
import json
import os
import signal
import subprocess
import sys
import time
from types import SimpleNamespace

import pytest
from support.wait import HANG, wait_until

import yarpy
from yarpy.cli.verbs import top


@pytest.fixture(scope="module")
def ports(names):
    with (
        yarpy.Port("/top/in", names=names) as in_,
        yarpy.BufferedPort("/top/[bold]out", names=names) as out,
    ):
        out.connect("/top/in")
        for number in range(5):
            wait_until(lambda number=number: out.write([number]))
            in_.read(timeout=HANG)
        yield out, in_


def test_json_for_each_look_until_a_signal(cli, ports):
    with cli.start("top", "--json", "/top/") as process:
        found = json.loads(process.wait_line(r"^\{", stream="out", count=2).string)
        assert [one["source"] for one in found["connections"]] == ["/top/[bold]out"]
        assert {one["name"] for one in found["ports"]} == {"/top/in", "/top/[bold]out"}
        assert found["connections"][0]["receiver"]["messages"] == 5
        process.signal(signal.SIGINT)
        assert process.wait() == 0


def test_tables_where_there_is_no_terminal(cli, ports):
    with cli.start("top", "--ports", "/top/in") as process:
        process.wait_line(r"^/top/in +answers +1 ", stream="out")
        process.signal(signal.SIGTERM)
        assert process.wait() == 0
    assert process.stdout.startswith("port ")


def test_no_server(lone):
    done = lone.run("top")
    assert (done.returncode, "yarpy server" in done.stderr) == (1, True)


def test_a_terminal(cli, ports):
    """Names are shown as they are; q ends it, and leaves the terminal as it was."""
    pty = pytest.importorskip("pty", reason="Windows has no pseudo terminals of files")
    primary, secondary = pty.openpty()
    process = subprocess.Popen(
        [sys.executable, "-m", "yarpy", "top", "/top"],
        env={**cli.environment, "TERM": "xterm", "COLUMNS": "80", "LINES": "24"},
        stdin=secondary, stdout=secondary, stderr=secondary, start_new_session=True,
    )  # fmt: skip
    try:
        os.close(secondary)
        seen = b""
        deadline = time.monotonic() + HANG
        while b"/top/[bold]out" not in seen and time.monotonic() < deadline:
            seen += os.read(primary, 65536)
        assert b"/top/[bold]out" in seen
        os.write(primary, b"pq")
        while time.monotonic() < deadline:
            try:
                data = os.read(primary, 65536)
            except OSError:  # the other side is closed
                break
            if not data:
                break
            seen += data
        assert process.wait(HANG) == 0
        assert b"answers" in seen
        assert seen.rstrip().endswith((b"\x1b[?25h", b"\x1b[?1049l"))
    finally:
        process.kill()
        process.wait()
        os.close(primary)


@pytest.mark.parametrize(("took", "waited"), [(0.02, 0.98), (0.6, 1.4)])
def test_asking_that_takes_long_is_done_less_often(monkeypatch, took, waited):
    class Sampler:
        def look(self):
            pass

    ticks = itertools.count(0.0, took)
    monkeypatch.setattr(top, "time", SimpleNamespace(monotonic=lambda: next(ticks)))
    waits = []
    found = top.looks(Sampler(), waits.append)
    for _ in range(2):
        next(found)
    assert waits == [pytest.approx(waited)]
