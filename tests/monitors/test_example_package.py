"""The example of a monitor package: installed by pip it is used by name, with no other change."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from support.package import EXAMPLES, install

PACKAGE = EXAMPLES / "monitor_package"
SOURCE = PACKAGE / "yarpy_limit.py"


def test_example_is_one_short_file() -> None:
    files = [path.name for path in PACKAGE.iterdir() if not path.name.startswith(("_", "."))]
    assert sorted(files) == ["pyproject.toml", "yarpy_limit.py"]
    assert len(SOURCE.read_text().splitlines()) < 60


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return install("monitor_package", tmp_path_factory)


USE = """
import yarpy
names = yarpy.LocalNames()
with (
    yarpy.BufferedPort("/motor", strict=True, names=names) as motor,  # which holds up no writer
    yarpy.Port("/stick", names=names) as stick,
):
    stick.connect("/motor", "tcp+recv.limit+most.10")
    for value in ([5, -20.5], ["stop"], [1, 2]):
        stick.write(value)
    print(list(motor.read(timeout=10).value), list(motor.read(timeout=10).value))
    print(yarpy.admin("/motor", "set", "in", "/stick", ["most", 1.5], names=names).to_text())
    stick.write([2.5])
    print(list(motor.read(timeout=10).value))
    print(yarpy.admin("/motor", "get", "in", "/stick", names=names).to_text())
    print(yarpy.admin("/motor", "prop", "get", "/stick", names=names).group("state").to_text())
    print(yarpy.admin("/motor", "set", "in", "/stick", ["most", -1], names=names).to_text())
    print(motor.inputs[0].stats.drops)
    try:
        stick.connect("/motor", "tcp+send.limit+most.-1")
    except yarpy.YarpError as error:
        print(error)
"""


def test_installed_monitor_is_used_by_name(installed: Path) -> None:
    environment = {**os.environ, "PYTHONPATH": str(installed)}
    done = subprocess.run(
        [sys.executable, "-c", USE], capture_output=True, text=True, timeout=50, env=environment
    )
    assert done.returncode == 0, done.stderr
    *lines, refusal = done.stdout.splitlines()
    assert lines == [
        "[5, -10.0] [1, 2]",
        '0 "Configured connection from /stick\\r\\n"',
        "[1.5]",
        "((most 1.5))",
        "state ((cut 2))",
        '[fail] "\\"most\\" takes a number from 0, not \\"-1\\""',
        "1",
    ]
    assert '"most" takes a number from 0' in refusal
