"""The two distributions: yarpy brings no `yarp`, compat brings it and the classical commands."""

from __future__ import annotations

import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from support.wait import HANG

ROOT = Path(__file__).parents[2]
COMMANDS = {
    *("yarp", "yarpserver", "yarpview", "yarpscope", "yarphear", "yarpdev", "yarpidl_thrift"),
    *("yarplogger", "yarprun", "yarpidl_rosmsg", "yarp-config", "yarprobotinterface"),
    *("yarpmanager", "yarpmanager-console"),
    *("yarpdatadumper", "yarpdataplayer", "yarpdataplayer-console"),
}


def wheel(project: Path, target: Path) -> zipfile.ZipFile:
    """Build it; nothing is fetched."""
    pytest.importorskip("hatchling", reason="the build backend comes with yarpy[test]")
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "wheel", "--quiet"]
    options = ["--no-deps", "--no-build-isolation", "--wheel-dir", str(target), str(project)]
    subprocess.run([*pip, *options], check=True, timeout=2 * HANG)
    return zipfile.ZipFile(next(target.glob("*.whl")))


def test_yarpy_alone_hides_nobodys_yarp(tmp_path: Path) -> None:
    names = wheel(ROOT, tmp_path).namelist()
    assert not [name for name in names if name.startswith("yarp/")]
    assert [name for name in names if name.startswith("yarpy/")]


def test_compat_is_complete(tmp_path: Path) -> None:
    built = wheel(ROOT / "compat", tmp_path)
    names = set(built.namelist())
    assert {"yarp/__init__.py", "yarp/__init__.pyi", "yarp/py.typed"} <= names
    assert not [name for name in names if not name.startswith(("yarp/", "yarpy_compat-"))]
    entries = next(name for name in names if name.endswith("entry_points.txt"))
    lines = built.read(entries).decode().splitlines()[1:]
    assert {line.partition(" = ")[0] for line in lines if line} == COMMANDS
    for line in filter(None, lines):
        module, _, function = line.partition(" = ")[2].partition(":")
        __import__(module)
        assert callable(getattr(sys.modules[module], function))
