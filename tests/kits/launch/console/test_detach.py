"""Applications in the background."""

import json
import os
import sys

import pytest
from support.wait import wait_until

from yarpy.cli.browser import has_display
from yarpy.platform.process import KILL, lives, signal_one

SLEEPS = f"[programs]\na = {json.dumps([sys.executable, '-c', 'import time; time.sleep(600)'])}\n"


def test_it_runs_until_it_is_ended(cli) -> None:
    path = cli.home / "back.toml"
    path.write_text(SLEEPS)
    done = cli.run_alone("up", "-d", str(path))
    try:
        assert done.returncode == 0 and "back runs in the background" in done.stdout
        told = json.loads(cli.run("status", "--json").stdout)
        assert told["application"] == "back"
        again = cli.run_alone("up", "-d", str(path))
        assert again.returncode == 1 and "is running already" in again.stderr
        if not has_display(sys.platform, os.environ):  # else a browser would come up
            url = cli.run("status", "--page").stdout
            assert url.startswith("back is shown at http://127.0.0.1:")
    finally:
        assert cli.run("down", "back").stdout == "back has stopped\n"


def test_what_ends_at_once_is_told(cli) -> None:
    path = cli.home / "wrong.toml"
    path.write_text("[programs]\na = '/no/such/program'\n")
    done = cli.run_alone("up", "-d", str(path))
    assert done.returncode == 1 or "runs in the background" in done.stdout
    if done.returncode:
        assert "it cannot be started" in done.stderr


@pytest.mark.skipif(sys.platform != "win32", reason="programs go on elsewhere: verbs/test_up.py")
def test_nothing_is_left_of_one_that_is_killed(cli) -> None:
    path = cli.home / "killed.toml"
    path.write_text(SLEEPS)
    done = cli.run_alone("up", "-d", str(path))
    assert done.returncode == 0, done.stderr
    told = json.loads(cli.run("status", "--json").stdout)
    (program,) = told["programs"]
    assert lives(program["pid"])
    assert signal_one(told["pid"], KILL)
    wait_until(lambda: not lives(program["pid"]))
    assert "no application" in cli.run("down", "killed").stderr
