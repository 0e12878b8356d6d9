"""The plug-in of pytest: what a stranger's tests get."""

import os
import subprocess
import sys
import tomllib
from pathlib import Path

from support.guest import guest
from support.wait import HANG

TESTS = """
import subprocess, sys
import yarpy

def test_programs_use_the_network_too(network):
    with yarpy.Port("/mine"):
        code = "import yarpy; print(yarpy.query('/mine') is not None)"
        words = [sys.executable, "-c", code]
        said = subprocess.run(words, capture_output=True, text=True, timeout=60)
        assert said.stdout == "True\\n", said.stderr

def test_each_has_its_own(network):
    assert yarpy.query("/mine") is None
"""
ROBOT = """
import yarpy

def test_a_robot(robot):
    with yarpy.RpcClient("/icubSim/head/rpc:i") as client:
        assert client.call(["get", "axes"])[2] == 6
"""


def test_its_fixtures(tmp_path: Path) -> None:
    passes(tmp_path, TESTS, "2 passed")


def test_its_robot(tmp_path: Path) -> None:
    guest("sim", ring="kits")
    passes(tmp_path, ROBOT, "1 passed")


def passes(tmp_path: Path, tests: str, said: str) -> None:
    (tmp_path / "test_it.py").write_text(tests)
    command = [sys.executable, "-m", "pytest", "-q", "-p", "yarpy.testing.plugin", "--rootdir", "."]
    done = subprocess.run(
        [*command, "-p", "no:cacheprovider", "test_it.py"],
        cwd=tmp_path,
        env={**os.environ, "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"},
        capture_output=True,
        text=True,
        timeout=2 * HANG,
    )
    assert done.returncode == 0 and said in done.stdout, done.stdout + done.stderr


def test_pytest_finds_it() -> None:
    said = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text())
    assert said["project"]["entry-points"]["pytest11"] == {"yarpy": "yarpy.testing.plugin"}
