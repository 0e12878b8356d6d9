"""`yarpy start` and `yarpy stop` at an application that is idle at first; see also test_stop.py."""

import json

import pytest
from support.wait import wait_until

from yarpy.kits.launch.supervise import process

pytestmark = pytest.mark.skipif(not process.known(), reason="this system has no /proc to look at")


def states(cli) -> list[str]:
    told = json.loads(cli.run("status", "--json").stdout)
    return [one["state"] for one in told["programs"]]


def test_idle_start_stop(cli) -> None:
    path = cli.home / "idle.toml"
    path.write_text("[programs]\na = 'sleep 600'\nb = 'sleep 600'\n")
    with cli.start("up", str(path), "--idle") as up:
        wait_until(lambda: cli.run("status").returncode == 0)
        wait_until(lambda: states(cli) == ["stopped", "stopped"])  # "waiting" at first
        assert cli.run("start", "a").returncode == 0
        up.wait_line(r"\* a running")
        assert cli.run("stop", "a").returncode == 0
        up.wait_line(r"\* a stopped")
        assert states(cli) == ["stopped", "stopped"]  # and it has not ended
        done = cli.run("start", "c")
        assert done.returncode == 1 and 'no program is called "c"' in done.stderr
        cli.run("down")
        assert up.wait() == 0
