"""`yarpy new`: the project runs, and its own tests pass."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from support.wait import HANG


def test_a_project_is_tested_and_runs(cli, server) -> None:
    done = cli.run("new", "tracker")
    assert done.returncode == 0 and str(Path("tracker", "tests", "test_module.py")) in done.stdout
    place = cli.home / "tracker"
    tested = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-p", "yarpy.testing.plugin"],
        cwd=place,
        env={**os.environ, "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"},
        capture_output=True,
        text=True,
        timeout=2 * HANG,
    )
    assert "2 passed" in tested.stdout, tested.stdout + tested.stderr
    done = cli.run("new", "tracker")
    assert done.returncode == 1 and "is there already" in done.stderr


@pytest.mark.skipif(
    bool(sys.flags.isolated),
    reason="an isolated Python, as the embeddable one of Windows, has no modules of its own folder",
)
def test_its_application_runs(cli, server) -> None:
    assert cli.run("new", "runner").returncode == 0
    path = cli.home / "runner" / "runner.toml"
    text = path.read_text().replace('"runner.ini"', f"'{path.with_suffix('.ini')}'")
    path.write_text(
        text.replace("[programs.module]\n", f"[programs.module]\nworkdir = '{path.parent}'\n")
    )
    with cli.start("up", str(path)) as up:
        up.wait_line(r"sink \| 2\.0 4\.0 6\.0")
        up.signal(signal.SIGINT)
        assert up.wait() == 0
