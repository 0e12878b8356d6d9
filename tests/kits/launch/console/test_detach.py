"""Applications in the background."""

import json

import pytest

from yarpy.kits.launch.supervise import process

pytestmark = pytest.mark.skipif(not process.known(), reason="this system has no /proc to look at")


def test_it_runs_until_it_is_ended(cli) -> None:
    path = cli.home / "back.toml"
    path.write_text("[programs]\na = 'sleep 600'\n")
    done = cli.run_alone("up", "-d", str(path))
    try:
        assert done.returncode == 0 and "back runs in the background" in done.stdout
        told = json.loads(cli.run("status", "--json").stdout)
        assert told["application"] == "back"
        again = cli.run_alone("up", "-d", str(path))
        assert again.returncode == 1 and "is running already" in again.stderr
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
