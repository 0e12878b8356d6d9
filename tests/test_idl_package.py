"""The example of a package with an IDL: installed by pip, `yarpy.idl.load` knows its files."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from support.package import EXAMPLES, install

PACKAGE = EXAMPLES / "idl_package"
SOURCE = PACKAGE / "yarpy_fields.py"


def test_example_is_one_short_file() -> None:
    files = [path.name for path in PACKAGE.iterdir() if not path.name.startswith(("_", "."))]
    assert sorted(files) == ["pyproject.toml", "yarpy_fields.py"]
    assert len(SOURCE.read_text().splitlines()) < 60


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return install("idl_package", tmp_path_factory)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "pose.fields").write_text("x float\ny float\nlabel str\n")
    (tmp_path / "wrong.fields").write_text("x float\ny flaot\n")
    return tmp_path


USE = """
import yarpy
Pose = yarpy.idl.load("pose.fields")
print(sorted(yarpy.idl.fields.TYPES))
names = yarpy.LocalNames()
with yarpy.BufferedPort("/in", names=names) as in_, yarpy.Port("/out", names=names) as out:
    out.connect("/in")
    out.write(Pose(1.5, -2.0, "door"))
    print(in_.read(timeout=10).as_(Pose))
try:
    yarpy.idl.load("wrong.fields")
except yarpy.DecodeError as error:
    print(error)
"""


def run(folder: Path, installed: Path | None, *words: str) -> str:
    environment = {**os.environ, "PYTHONPATH": str(installed or "")}
    done = subprocess.run(
        [sys.executable, *words],
        capture_output=True,
        text=True,
        timeout=50,
        env=environment,
        cwd=folder,
    )
    return done.stdout + done.stderr


def test_its_files_are_loaded_by_their_ending(installed: Path, folder: Path) -> None:
    assert run(folder, installed, "-c", USE).splitlines() == [
        "['bool', 'bytes', 'float', 'int', 'str']",
        "Pose(x=1.5, y=-2.0, label='door')",
        "wrong.fields:2: a field is NAME TYPE, with a type of int, float, str, bool, bytes",
    ]


def test_the_command_line_knows_it(installed: Path, folder: Path) -> None:
    shown = run(folder, installed, "-m", "yarpy", "idl", "fields", "pose.fields")
    assert shown == "x: float\ny: float\nlabel: str\n"


def test_without_it_nobody_reads_them(folder: Path) -> None:
    shown = run(folder, None, "-c", 'import yarpy; yarpy.idl.load("pose.fields")')
    assert shown.splitlines()[-1] == (
        "yarpy.errors.UnknownType: no plug-in reads .fields files: known are .thrift, .msg, .srv; "
        "others come with a package that has the entry point group yarpy.idls"
    )
